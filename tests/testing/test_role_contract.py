import random
from collections.abc import Callable
from typing import Any

import attrs
import numpy as np
import pytest
import toys
from contracts import name_of
from toy_capabilities import Constant, Random

from evoframe import Design, Simulator
from evoframe.testing import RoleProviderContract

DECLARED = "test_roles_are_declared"
EXAMPLE = "test_the_example_has_the_required_roles"
STARTS = "test_it_starts_a_run"
ADDED = "test_the_declared_roles_are_added"
UNCHANGED = "test_the_given_design_is_not_changed"
SAME = "test_the_same_random_state_gives_the_same_roles"
AGAIN = "test_another_start_gives_the_same_roles"
JSON = "test_the_state_is_json"
REFUSED = "test_another_state_is_refused"


class Contract(RoleProviderContract):
    """The contract with a simulator and a design of toys."""

    simulator = toys.Product()

    def design(self) -> Design:
        return Design({"a": np.array([3.0])})


class TestConstant(Contract):
    component = Constant(needs=("a",))


class TestRandom(Contract):
    component = Random()


class AList(Constant):
    provides = ["r"]  # type: ignore[assignment]  # noqa: RUF012


class Numbers(Constant):
    requires = (1,)  # type: ignore[assignment]


class NoRole(Constant):
    provides = ()


class Both(Constant):
    requires = provides = ("r",)


class RequiresAnother(Constant):
    requires = ("z",)


class StartsNothing(Constant):
    def start(self, simulator: Simulator) -> Any:
        return None


class ProvidesNothing(Constant):
    def fill(self, design: Design, rng: np.random.Generator) -> Design:
        return design


class ProvidesMore(Constant):
    def fill(self, design: Design, rng: np.random.Generator) -> Design:
        return super().fill(design, rng).with_role("more", np.ones(1))


class Forgets(Constant):
    def fill(self, design: Design, rng: np.random.Generator) -> Design:
        return Design({"r": np.ones(1)})


class ChangesOthers(Constant):
    def fill(self, design: Design, rng: np.random.Generator) -> Design:
        return super().fill(design, rng).with_role("a", np.zeros(1))


class ChangesTheGiven(Constant):
    def fill(self, design: Design, rng: np.random.Generator) -> Design:
        array = design.roles["a"]
        array.setflags(write=True)
        array[0] += 1
        return super().fill(design, rng)


class PythonsRandom(Constant):
    def fill(self, design: Design, rng: np.random.Generator) -> Design:
        return design.with_role("r", np.array([random.random()]))  # noqa: S311 - a generator that it must not use


class FreshRandom(Constant):
    def fill(self, design: Design, rng: np.random.Generator) -> Design:
        return design.with_role("r", np.random.default_rng().random(1))


@attrs.frozen
class Counting(Constant):
    calls: list[int] = attrs.field(factory=list, init=False, eq=False)

    def start(self, simulator: Simulator) -> Any:
        return Counted()


@attrs.define
class Counted:
    calls: int = 0

    def fill(self, design: Design, rng: np.random.Generator) -> Design:
        self.calls += 1
        return design.with_role("r", np.array([float(self.calls)]))

    def state(self) -> Any:
        return self.calls

    def restore(self, state: Any) -> None:
        raise ValueError(state)


@attrs.frozen
class DrawsAtTheStart(Constant):
    def start(self, simulator: Simulator) -> Any:
        return Constant(value=np.random.default_rng().random())


class StateOfBytes(Constant):
    def state(self) -> Any:
        return b"checksum"


class StateOfNan(Constant):
    def state(self) -> Any:
        return float("nan")


class RefusesItself(Constant):
    def restore(self, state: Any) -> None:
        raise ValueError("something changed")


class AcceptsAll(Constant):
    def restore(self, state: Any) -> None:
        pass


@pytest.mark.parametrize(
    ("component", "law"),
    [
        (AList(), DECLARED),
        (Numbers(), DECLARED),
        (NoRole(), DECLARED),
        (Both(), DECLARED),
        (RequiresAnother(), EXAMPLE),
        (StartsNothing(), STARTS),
        (ProvidesNothing(), ADDED),
        (ProvidesMore(), ADDED),
        (Forgets(), ADDED),
        (ChangesOthers(), UNCHANGED),
        (ChangesTheGiven(), UNCHANGED),
        (PythonsRandom(), SAME),
        (FreshRandom(), SAME),
        (Counting(), SAME),
        (DrawsAtTheStart(), AGAIN),
        (StateOfBytes(), JSON),
        (StateOfNan(), JSON),
        (Counting(), JSON),
        (AcceptsAll(), REFUSED),
    ],
    ids=name_of,
)
def test_a_broken_provider_is_caught(component: Any, law: str, breaks: Callable[..., None]) -> None:
    breaks(Contract, component, law)


def test_a_provider_that_refuses_its_own_state_is_caught(breaks: Callable[..., None]) -> None:
    breaks(Contract, RefusesItself(), JSON, error=ValueError)
