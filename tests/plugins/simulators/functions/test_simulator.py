"""The simulator ``functions``: parts of points in, values out."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import pytest
from hypothesis import given, strategies as st

from evoframe import ConfigurationError, Design, InputError, Record, structure
from evoframe.testing import SimulatorContract
from evoframe_simulators import Functions
from evoframe_simulators.functions import Griewangk, MaximumOfQuadratics, Quadratic

RECORD = Record(("value",))


def at(*parts: float | Sequence[float], roles: Sequence[str] = ("x", "y")) -> Design:
    """Return the design with these parts of a point, from 0 to 1."""
    arrays = (np.atleast_1d(np.array(part, np.float64)) for part in parts)
    return Design(dict(zip(roles, arrays, strict=True)))


class FunctionsContract(SimulatorContract):
    def record(self) -> Record:
        return RECORD

    def designs(self) -> Sequence[Design]:
        # The last two differ, but have equal keys.
        return [at(0.25, 0.25), at(0.75, 0.7), at(1.0, 0.0), at(1.0, -0.0)]


class TestMtq(FunctionsContract):
    component = Functions()


class TestRastrigin(FunctionsContract):
    component = Functions(function="rastrigin")


class TestOnlyTheStateAfterTheStep(FunctionsContract):
    component = Functions(function="booth")

    def record(self) -> Record:
        return Record(("value",), samples=(0,))


class TestThreeRolesOfTwoVariables(FunctionsContract):
    component = Functions(function="griewangk", roles=("a", "b", "c"), dimension=2)

    def designs(self) -> Sequence[Design]:
        rng = np.random.default_rng(1)
        return [at(*rng.uniform(size=(3, 2)), roles="abc") for _ in range(4)]


def value(simulator: Functions, design: Design) -> float:
    [outcome] = simulator.simulate([design], RECORD)
    assert outcome.diverged_at is None
    [[found]] = outcome.tracks["value"].tolist()
    return float(found)


@pytest.mark.parametrize(
    ("function", "point", "expected"),
    [
        ("mtq", (0.25, 0.25), 150.0),
        ("mtq", (0.75, 0.75), 50.0),
        ("one-ridge", (1.0, 1.0), 2.0),
        ("griewangk", (0.5, 0.5), 0.0),
        ("booth", (6.12 / 10.24, 8.12 / 10.24), 0.0),
        ("rosenbrock", (3.048 / 4.096, 3.048 / 4.096), 0.0),
        ("rastrigin", (0.5, 0.5), 0.0),
    ],
)
def test_the_unit_square_is_scaled_to_the_domain(
    function: Any, point: tuple[float, float], expected: float
) -> None:
    assert value(Functions(function=function), at(*point)) == pytest.approx(expected, abs=1e-12)


@given(x=st.floats(0.0, 1.0), y=st.floats(0.0, 1.0))
def test_a_larger_domain_scales_the_same_point_further(x: float, y: float) -> None:
    small, large = (Functions(function="griewangk", griewangk=Griewangk((-w, w))) for w in (1.0, 2.0))
    inner = at(0.5 + (x - 0.5) / 2, 0.5 + (y - 0.5) / 2)
    assert value(large, inner) == pytest.approx(value(small, at(x, y)), abs=1e-12)


def test_parts_are_joined_in_the_order_of_the_roles() -> None:
    design = at(0.1, 0.9)
    forth = Functions(function="booth")
    back = Functions(function="booth", roles=("y", "x"))
    assert value(forth, design) == value(back, at(0.9, 0.1)) != value(back, design)


def test_the_dimension_splits_the_same_point_differently() -> None:
    split = Functions(function="rosenbrock", roles=("a", "b", "c", "d"))
    pairs = Functions(function="rosenbrock", dimension=2)
    assert value(split, at(0.1, 0.2, 0.3, 0.4, roles="abcd")) == value(pairs, at([0.1, 0.2], [0.3, 0.4]))


def test_other_roles_of_a_design_do_not_matter() -> None:
    simulator, design = Functions(), at(0.2, 0.3)
    more = design.with_role("z", np.ones(1))
    assert simulator.key(more, RECORD) == simulator.key(design, RECORD)
    assert value(simulator, more) == value(simulator, design)


@given(x=st.floats(0.0, 1.0), y=st.floats(0.0, 1.0))
def test_points_with_one_key_are_the_same(x: float, y: float) -> None:
    simulator = Functions()
    same = simulator.key(at(x, y), RECORD) == simulator.key(at(y, x), RECORD)
    assert same == (x == y)


@pytest.mark.parametrize(
    ("design", "message"),
    [
        (Design({"x": np.zeros(1)}), "no role 'y'"),
        (at(0.5, [0.5, 0.5]), r"role 'y': expected float64\[1\], found float64\[2\]"),
        (Design({"x": np.zeros(1, np.float32), "y": np.zeros(1)}), "role 'x'.*float32"),
        (at(1.5, 0.5), "role 'x': expected numbers from 0 to 1, found"),
        (at(0.5, -1e-9), "role 'y': expected numbers from 0 to 1, found"),
        (at(0.5, float("nan")), "role 'y': expected numbers from 0 to 1, found"),
    ],
)
def test_a_design_that_is_not_a_point_is_refused(design: Design, message: str) -> None:
    with pytest.raises(InputError, match=message):
        Functions().simulate([design], RECORD)
    with pytest.raises(InputError, match=message):
        Functions().key(design, RECORD)


@pytest.mark.parametrize(
    ("record", "message"),
    [
        (Record(("value", "tip")), "'tip'"),
        (Record(("value",), samples=(0, 1)), "sample 1"),
        (Record(("value",), until=1.5), r"1\.5 s"),
    ],
)
def test_a_record_of_more_than_the_only_step_is_refused(record: Record, message: str) -> None:
    with pytest.raises(ConfigurationError, match=message):
        Functions().check(record)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"roles": ("x",)}, "roles"),
        ({"roles": ("x", "x")}, "different"),
        ({"dimension": 0}, "dimension"),
        ({"dimension": 2}, "mtq.peaks.*found 4"),
        ({"function": "booth", "roles": ("x", "y", "z")}, "expected 2 variables, found 3"),
    ],
)
def test_impossible_options_are_refused(options: dict[str, Any], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        Functions(**options)


def test_parameters_are_a_table_of_the_function_with_that_name() -> None:
    table = {
        "function": "mtq",
        "roles": ["a", "b"],
        "mtq": {"peaks": [{"height": 2.0, "place": [0.5, 0.5], "spread": 1.0}]},
    }
    peak = Quadratic(height=2.0, place=(0.5, 0.5), spread=1.0)
    expected = Functions(roles=("a", "b"), mtq=MaximumOfQuadratics((peak,)))
    assert structure(table, Functions, ("simulator",)) == expected
    assert value(expected, at(0.5, 0.5, roles="ab")) == 2.0
