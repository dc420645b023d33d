"""The benchmark functions, at the points that their papers name, and everywhere else."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import pytest
from hypothesis import given, strategies as st

from evoframe_simulators.functions import (
    Booth,
    Function,
    Griewangk,
    MaximumOfQuadratics,
    OneRidge,
    Quadratic,
    Rastrigin,
    Rosenbrock,
)

OPTIMA: list[tuple[Function, tuple[float, ...], float]] = [
    (MaximumOfQuadratics(), (0.25, 0.25), 150.0),
    (OneRidge(), (1.0, 1.0), 2.0),
    (OneRidge(), (1.0, 1.0, 1.0), 2.0),
    (Griewangk(), (0.0, 0.0), 0.0),
    (Griewangk((-600.0, 600.0)), (0.0,) * 10, 0.0),
    (Booth(), (1.0, 3.0), 0.0),
    (Rosenbrock(), (1.0, 1.0), 0.0),
    (Rosenbrock(), (1.0, 1.0, 1.0, 1.0), 0.0),
    (Rastrigin(), (0.0, 0.0), 0.0),
]

units = st.floats(0.0, 1.0)


def scaled(function: Function, units: Sequence[float]) -> list[float]:
    low, high = function.domain
    return [low + (high - low) * unit for unit in units]


@pytest.mark.parametrize(("function", "place", "value"), OPTIMA)
def test_the_optimum_has_its_published_value_and_place(
    function: Function, place: tuple[float, ...], value: float
) -> None:
    function.check(len(place))
    assert function.value(place) == value
    assert all(function.domain[0] <= x <= function.domain[1] for x in place)


@pytest.mark.parametrize(("function", "place", "value"), OPTIMA)
@given(data=st.data())
def test_no_point_exceeds_the_optimum(
    function: Function, place: tuple[float, ...], value: float, data: st.DataObject
) -> None:
    point = scaled(function, data.draw(st.tuples(*[units] * len(place))))
    found = function.value(point)
    assert math.isfinite(found)
    assert found <= value + 1e-12


@pytest.mark.parametrize(("function", "place", "value"), OPTIMA)
def test_no_other_point_of_a_grid_reaches_the_optimum(
    function: Function, place: tuple[float, ...], value: float
) -> None:
    if len(place) > 2:
        return
    for point in itertools.product(scaled(function, np.linspace(0.0, 1.0, 41).tolist()), repeat=2):
        if math.dist(point, place) > 1e-9:
            assert function.value(point) < value


# Values computed by hand from the formulas of the papers.
@pytest.mark.parametrize(
    ("function", "point", "value"),
    [
        (MaximumOfQuadratics(), (0.75, 0.75), 50.0),
        (MaximumOfQuadratics(), (0.75, 0.65), 50.0 * (1 - 0.1)),
        (MaximumOfQuadratics(), (0.25, 0.27), 150.0 * (1 - 512 * 0.0004)),
        (OneRidge(), (0.0, 0.0), 1.0),
        (OneRidge(), (0.25, 0.75), 0.75),
        (OneRidge(), (0.0, 1.0), 0.0),
        (OneRidge(), (0.5, 0.75, 0.25), 0.75),
        (Griewangk(), (math.pi, 0.0), -2.0 - math.pi**2 / 4000),
        (Griewangk(), (0.0, math.sqrt(2) * math.pi), -2.0 - 2 * math.pi**2 / 4000),
        (Booth(), (0.0, 0.0), -74.0),
        (Booth(), (1.0, 1.0), -20.0),
        (Rosenbrock(), (0.0, 0.0), -1.0),
        (Rosenbrock(), (-1.0, 1.0), -4.0),
        (Rosenbrock(), (2.0, 3.0), -101.0),
        (Rastrigin(), (0.5, 0.0), -6.25),
        (Rastrigin(amplitude=10.0), (1.0, -0.5), -1.0 - 20.25),
    ],
)
def test_a_known_point_has_its_value(function: Function, point: tuple[float, ...], value: float) -> None:
    assert function.value(point) == pytest.approx(value, rel=1e-12)


def test_mtq_has_a_local_optimum_that_traps_changes_of_one_variable() -> None:
    mtq = MaximumOfQuadratics()
    top = (0.75, 0.75)
    for x in np.linspace(0.0, 1.0, 201).tolist():
        for point in ((x, 0.75), (0.75, x)):
            assert point == top or mtq.value(point) < mtq.value(top)


def test_the_broad_peak_of_mtq_attracts_more_of_the_square_than_the_narrow_one() -> None:
    mtq = MaximumOfQuadratics()
    grid = list(itertools.product(np.linspace(0.0, 1.0, 101).tolist(), repeat=2))
    above = [[peak.value(point) > 0 for point in grid] for peak in mtq.peaks]
    broad, narrow = (np.mean(each) for each in above)
    assert broad == pytest.approx(math.pi * 0.1, abs=0.06)  # a disk of radius sqrt(1.6) / 4, cut by the edges
    assert narrow == pytest.approx(math.pi / 512, abs=0.002)


@given(heights=st.tuples(units, units), place=st.tuples(units, units), point=st.tuples(units, units))
def test_the_maximum_of_quadratics_is_that_of_its_peaks(
    heights: tuple[float, ...], place: tuple[float, float], point: tuple[float, float]
) -> None:
    peaks = tuple(
        Quadratic(height=height, place=at, spread=0.5)
        for height, at in zip(heights, (place, place[::-1]), strict=True)
    )
    value = MaximumOfQuadratics(peaks).value(point)
    assert value in [peak.value(point) for peak in peaks]
    assert all(peak.value(point) <= value for peak in peaks)


@given(x=units, y=units)
def test_on_one_ridge_the_best_response_is_the_same_number(x: float, y: float) -> None:
    ridge = OneRidge()
    assert ridge.value((x, y)) <= ridge.value((y, y))
    assert ridge.value((x, y)) == ridge.value((y, x))


@given(x=st.floats(-5.12, 5.12), y=st.floats(-5.12, 5.12), other=st.floats(-5.12, 5.12))
def test_rastrigin_is_separable(x: float, y: float, other: float) -> None:
    value = Rastrigin().value
    assert value((x, y)) - value((other, y)) == pytest.approx(
        value((x, other)) - value((other, other)), abs=1e-9
    )


@pytest.mark.parametrize("function", [Griewangk(), Booth(), Rosenbrock(), OneRidge(), MaximumOfQuadratics()])
def test_the_other_functions_are_not_separable(function: Function) -> None:
    a, b = scaled(function, (0.25, 0.8))
    value = function.value
    assert abs(value((a, a)) - value((b, a)) - value((a, b)) + value((b, b))) > 1e-3


@pytest.mark.parametrize(
    ("function", "accepted"),
    [
        (MaximumOfQuadratics(), {2}),
        (MaximumOfQuadratics((Quadratic(height=1.0, place=(0.5,) * 3, spread=1.0),)), {3}),
        (OneRidge(), {2, 3, 4}),
        (Griewangk(), {1, 2, 3, 4}),
        (Booth(), {2}),
        (Rosenbrock(), {2, 3, 4}),
        (Rastrigin(), {1, 2, 3, 4}),
    ],
)
def test_other_numbers_of_variables_are_refused(function: Function, accepted: set[int]) -> None:
    for variables in range(5):
        if variables in accepted:
            function.check(variables)
        else:
            with pytest.raises(ValueError, match=rf"found {variables} \("):
                function.check(variables)


@pytest.mark.parametrize("function", [Griewangk, Booth, Rosenbrock, Rastrigin])
@pytest.mark.parametrize("domain", [(1.0, 1.0), (2.0, 1.0), (math.nan, 1.0), (0.0, math.inf), (-1e10, 0.0)])
def test_an_impossible_domain_is_refused(function: Callable[..., Any], domain: tuple[float, float]) -> None:
    with pytest.raises(ValueError, match="domain"):
        function(domain=domain)


@pytest.mark.parametrize(
    "parameters",
    [{"spread": 0.0}, {"spread": math.nan}, {"height": math.inf}, {"place": (0.5, math.nan)}],
)
def test_an_impossible_peak_is_refused(parameters: dict[str, Any]) -> None:
    with pytest.raises(ValueError, match=next(iter(parameters))):
        Quadratic(**{"height": 1.0, "place": (0.5, 0.5), "spread": 1.0, **parameters})


def test_a_maximum_of_no_quadratics_is_refused() -> None:
    with pytest.raises(ValueError, match="peaks"):
        MaximumOfQuadratics(())


@pytest.mark.parametrize("amplitude", [-1.0, math.nan])
def test_an_impossible_amplitude_is_refused(amplitude: float) -> None:
    with pytest.raises(ValueError, match="amplitude"):
        Rastrigin(amplitude=amplitude)
