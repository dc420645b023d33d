from collections.abc import Callable
from typing import Any, ClassVar

import attrs
import numpy as np
import pytest
from contracts import name_of
from numpy.typing import NDArray

from evoframe import ArrayType, Design, Network
from evoframe.testing import EncoderContract

DECLARED = "test_roles_are_declared"
ROLES = "test_every_network_gives_the_declared_roles"
SHAPES = "test_shapes_and_types_are_the_same_for_every_network"
FINITE = "test_every_network_gives_finite_numbers"
SAME = "test_the_same_network_gives_the_same_design"
NAMES = "test_every_input_and_output_has_a_name"
TYPES = "test_arrays_have_the_declared_types"
MEASURES = "test_all_declared_measures_are_finite"
NOT_CHANGED = "test_the_given_design_is_not_changed"
POINTS = np.arange(8.0).reshape(4, 2)


@attrs.frozen
class Stripe:
    """A valid encoder of four colors on a given body, and the base of the broken ones."""

    inputs: ClassVar[int] = 2
    outputs: ClassVar[int] = 1
    requires: ClassVar[Any] = ("body",)
    provides: ClassVar[Any] = ("color",)

    def decode(self, network: Network, design: Design) -> Design:
        return design.with_role("color", self.colors(network))

    def colors(self, network: Network) -> NDArray[Any]:
        return np.clip(network(POINTS)[:, 0], -1, 1)


class OnABody(EncoderContract):
    def design(self) -> Design:
        return Design({"body": np.ones(4)})


class TestStripe(OnABody):
    component = Stripe()


class Named(Stripe):
    input_names: ClassVar[Any] = ("u", "v")
    output_names: ClassVar[Any] = ("color",)


class TestNamedStripe(OnABody):
    component = Named()


class OneColor(Stripe):
    inputs = 0
    input_names: ClassVar[Any] = ()

    def colors(self, network: Network) -> NDArray[Any]:
        return np.clip(network(np.empty((1, 0)))[:, 0], -1, 1)


class TestAnEncoderWithoutInputs(OnABody):
    component = OneColor()


class OneNameTooMany(Named):
    input_names = ("u", "v", "w")


class ListOfNames(Named):
    input_names = ["u", "v"]  # noqa: RUF012 - the fault under test


class OneNameForAll(Named):
    input_names = ("u", "u")


class NoName(Named):
    output_names = (" ",)


class NumberForAName(Named):
    output_names = (1,)


class Declaring(Stripe):
    measures: ClassVar[Any] = ("brightness",)

    @property
    def array_types(self) -> dict[str, ArrayType]:
        return {"color": ArrayType("float64", (4,)), "body": ArrayType("float64", (None,))}

    def measure(self, design: Design) -> dict[str, float]:
        return {"brightness": float(design.roles["color"].mean())}


class TestDeclaringStripe(OnABody):
    component = Declaring()


class DeclaresAnotherShape(Declaring):
    @property
    def array_types(self) -> dict[str, ArrayType]:
        return {"color": ArrayType("float64", (5,))}


class DeclaresAnotherRole(Declaring):
    @property
    def array_types(self) -> dict[str, ArrayType]:
        return {"shade": ArrayType("float64", (4,))}


class MeasuresMore(Declaring):
    def measure(self, design: Design) -> dict[str, float]:
        return {**super().measure(design), "contrast": 1.0}


class MeasuresNaN(Declaring):
    def measure(self, design: Design) -> dict[str, float]:
        return {"brightness": float("nan")}


class NoRole(Stripe):
    provides = ()


class ListOfRoles(Stripe):
    provides = ["color"]  # noqa: RUF012 - the fault under test


class RequiredAndProvided(Stripe):
    requires = ("body", "color")


class OneRoleMore(Stripe):
    def decode(self, network: Network, design: Design) -> Design:
        return super().decode(network, design).with_role("shade", np.ones(4))


class OneRoleLess(Stripe):
    def decode(self, network: Network, design: Design) -> Design:
        return design


class OnlyItsRole(Stripe):
    def decode(self, network: Network, design: Design) -> Design:
        return Design({"color": self.colors(network)})


class ShapeByNetwork(Stripe):
    def colors(self, network: Network) -> NDArray[Any]:
        colors = super().colors(network)
        return colors[colors >= 0]


class TypeByNetwork(Stripe):
    def colors(self, network: Network) -> NDArray[Any]:
        colors = super().colors(network)
        return colors if colors.any() else colors.astype(np.int64)


class Unclamped(Stripe):
    def colors(self, network: Network) -> NDArray[Any]:
        with np.errstate(over="ignore"):
            colors: NDArray[Any] = np.exp(network(POINTS)[:, 0])
            return colors


class Remembers(Stripe):
    calls: ClassVar[list[int]] = []

    def colors(self, network: Network) -> NDArray[Any]:
        self.calls.append(1)
        return super().colors(network) + len(self.calls)


class ChangesTheBody(Stripe):
    def decode(self, network: Network, design: Design) -> Design:
        return super().decode(network, design).with_role("body", np.zeros(4))


class SinglePrecision(Stripe):
    def colors(self, network: Network) -> NDArray[Any]:
        return network(POINTS.astype(np.float32))[:, 0]


class PointByPoint(Stripe):
    def colors(self, network: Network) -> NDArray[Any]:
        return np.array([network(point) for point in POINTS])


class ThreeInputs(Stripe):
    def colors(self, network: Network) -> NDArray[Any]:
        return np.clip(network(np.ones((4, 3)))[:, 0], -1, 1)


class InfinitePoints(Stripe):
    def colors(self, network: Network) -> NDArray[Any]:
        return np.clip(network(POINTS / np.zeros(1) if POINTS.all() else POINTS + np.inf)[:, 0], -1, 1)


class FewerThanNoInputs(Stripe):
    inputs = -1


class NoOutputs(Stripe):
    outputs = 0


@pytest.mark.parametrize(
    ("component", "law"),
    [
        (NoRole(), DECLARED),
        (ListOfRoles(), DECLARED),
        (RequiredAndProvided(), DECLARED),
        (FewerThanNoInputs(), "test_a_network_has_inputs_and_outputs"),
        (NoOutputs(), "test_a_network_has_inputs_and_outputs"),
        (OneNameTooMany(), NAMES),
        (ListOfNames(), NAMES),
        (OneNameForAll(), NAMES),
        (NoName(), NAMES),
        (NumberForAName(), NAMES),
        (OneRoleMore(), ROLES),
        (OneRoleLess(), ROLES),
        (OnlyItsRole(), ROLES),
        (ShapeByNetwork(), SHAPES),
        (TypeByNetwork(), SHAPES),
        (Unclamped(), FINITE),
        (SinglePrecision(), FINITE),
        (PointByPoint(), FINITE),
        (ThreeInputs(), FINITE),
        (InfinitePoints(), FINITE),
        (Remembers(), SAME),
        (ChangesTheBody(), NOT_CHANGED),
        (DeclaresAnotherShape(), TYPES),
        (DeclaresAnotherRole(), TYPES),
        (MeasuresMore(), MEASURES),
        (MeasuresNaN(), MEASURES),
    ],
    ids=name_of,
)
def test_a_broken_encoder_is_caught(component: Any, law: str, breaks: Callable[..., None]) -> None:
    breaks(OnABody, component, law)


def test_an_example_without_the_required_roles_is_caught(breaks: Callable[..., None]) -> None:
    breaks(EncoderContract, Stripe(), "test_the_example_has_the_required_roles")
