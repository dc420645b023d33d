"""Tests of optional capabilities: a component has one if it has all its members."""

from __future__ import annotations

import inspect
from typing import Any, Protocol

import numpy as np
import pytest
import toy_capabilities as caps
import toys

import evoframe
from evoframe.contract import optional
from evoframe.contract.optional import (
    SupportsExport,
    SupportsGeometry,
    SupportsProvenance,
    SupportsPublished,
    SupportsRandomControllers,
    SupportsReading,
    SupportsSettings,
    SupportsUnit,
    SupportsVariants,
    SupportsWholeDesigns,
    SupportsWindow,
    Variant,
    array_types_of,
    batch_size_of,
    bit_generation_of,
    measures_of_designs,
    measures_of_simulations,
    unit_of,
    wanted_by,
    whole_of,
    window_of,
)

CAPABILITIES = {
    name: value
    for name, value in vars(optional).items()
    if name.startswith("Supports") and name in optional.__all__
}


def members_of(protocol: type[Any]) -> set[str]:
    classes = [
        each for each in protocol.__mro__ if each not in (object, Protocol) and each.__name__ != "Generic"
    ]
    return {name for each in classes for name in vars(each) if not name.startswith("_")}


def having(members: set[str]) -> object:
    """Return an object with exactly these *members*."""
    return type("Component", (), dict.fromkeys(members, 1))()


@pytest.mark.parametrize("name", CAPABILITIES)
def test_a_component_has_a_capability_if_it_has_all_its_members(name: str) -> None:
    members = members_of(CAPABILITIES[name])
    assert isinstance(having(members), CAPABILITIES[name])
    for missing in members:
        assert not isinstance(having(members - {missing}), CAPABILITIES[name])


@pytest.mark.parametrize("name", CAPABILITIES)
def test_a_capability_is_documented_and_public(name: str) -> None:
    capability = CAPABILITIES[name]
    assert getattr(evoframe, name) is capability
    own = [member for member in vars(capability) if not member.startswith("_")]
    assert own
    for member in own:
        assert inspect.getdoc(vars(capability)[member]), f"{name}.{member}"


@pytest.mark.parametrize(
    ("component", "capabilities"),
    [
        (toys.Product(), set()),
        (toys.Varied(), {SupportsReading, SupportsSettings, SupportsExport, SupportsVariants}),
        (
            toys.Steered(),
            {
                SupportsReading,
                SupportsSettings,
                SupportsExport,
                SupportsVariants,
                SupportsRandomControllers,
                SupportsPublished,
            },
        ),
    ],
    ids=lambda value: type(value).__name__,
)
def test_capabilities_are_independent(component: Any, capabilities: set[Any]) -> None:
    offered = {each for each in CAPABILITIES.values() if isinstance(component, each)}
    assert offered == capabilities


def test_a_capability_requires_the_protocol_of_its_kind() -> None:
    """A method called ``geometry`` alone does not make a simulator."""
    assert not isinstance(having({"geometry"}), SupportsGeometry)
    assert isinstance(having({"provenance"}), SupportsProvenance)


def test_an_objective_may_have_a_unit() -> None:
    assert isinstance(toys.Late(), SupportsUnit)
    assert (unit_of(toys.Late()), unit_of(toys.Value())) == ("m", "")


def test_a_component_that_states_no_generation_gives_its_first_results() -> None:
    class Changed(toys.Value):
        bit_generation = 3

    assert (bit_generation_of(toys.Value()), bit_generation_of(Changed())) == (1, 3)


def test_the_window_of_an_objective_is_the_whole_record_unless_it_says_otherwise() -> None:
    class AtTheEnd(toys.Value):
        def window(self, times: Any) -> Any:
            return times[-1], times[-1]

    times = np.array([0.5, 1.0, 1.5])
    assert window_of(toys.Value(), times) == (0.5, 1.5)
    assert isinstance(AtTheEnd(), SupportsWindow)
    assert window_of(AtTheEnd(), times) == (1.5, 1.5)
    assert window_of(toys.Value(), times[:0]) is None


def test_simulators_simulate_whole_designs_if_they_can() -> None:
    assert isinstance(toys.Shortsighted(), SupportsWholeDesigns)
    assert whole_of(toys.Shortsighted()) == toys.Shortsighted(whole=True)
    varied = toys.Varied()
    assert whole_of(varied) is varied


def test_variants_are_compared_by_identity() -> None:
    """Comparing arrays of their designs has no single truth value."""
    design = evoframe.Design({"a": np.ones(2)})
    first, second = (Variant("a", toys.Product(), design, toys.Value.record) for _ in range(2))
    assert first != second


def test_measures_are_those_that_components_declare() -> None:
    assert wanted_by(toys.Drift()) == ()
    assert wanted_by(caps.Wanting(wants=("age", "energy"))) == ("age", "energy")
    assert measures_of_designs(toys.Number()) == ()
    assert measures_of_designs(caps.Typed("a")) == ("size-of-a",)
    assert measures_of_simulations(toys.Product(), toys.Value()) == ()
    assert measures_of_simulations(caps.Measuring(), caps.Second()) == ("energy", "smallness")


def test_array_types_and_batch_sizes_are_optional() -> None:
    assert array_types_of(toys.Number()) == {}
    one = evoframe.ArrayType("float64", (1,))
    assert array_types_of(caps.Typed("a", needs=("b",))) == {"a": one, "b": one}
    assert batch_size_of(toys.Product(), 12) == 12
    assert batch_size_of(caps.Measuring(), 12) == 2


def test_the_toys_have_the_capabilities_that_their_tests_are_about() -> None:
    assert isinstance(caps.Archiving(), evoframe.SupportsMemory)
    assert isinstance(caps.Loyal(), evoframe.SupportsEach)
    assert isinstance(caps.Alternating(), evoframe.SupportsSizes)
    assert isinstance(caps.WantingRun(0.1, 2, np.random.default_rng(0)), evoframe.SupportsSeeds)
    assert not isinstance(toys.DriftRun(0.1, 2, np.random.default_rng(0)), evoframe.SupportsLoad)
