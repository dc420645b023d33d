"""Main effects and interactions."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from evoframe.analysis.statistics.factorial import Effect, factorial_effects

NAMES = ("aggregator", "n")


def cells(
    rows: tuple[float, ...], columns: tuple[float, ...], interaction: float = 0.0, n: int = 20
) -> dict[tuple[str, str], list[float]]:
    """Return skewed values around the sum of two effects, and an interaction in the first cell."""
    rng = np.random.default_rng(5)
    found = {}
    for (i, row), (j, column) in itertools.product(enumerate(rows), enumerate(columns)):
        center = row + column + (interaction if (i, j) == (0, 0) else 0.0)
        found[f"a{i}", f"b{j}"] = (center + rng.exponential(1.0, n)).tolist()
    return found


def by_factors(effects: list[Effect]) -> dict[tuple[str, ...], Effect]:
    return {effect.factors: effect for effect in effects}


@pytest.mark.parametrize(
    ("values", "present"),
    [
        (cells((0, 0, 0), (0, 0)), set()),
        (cells((0, 2, 4), (0, 0)), {("aggregator",)}),
        (cells((0, 0, 0), (0, 2)), {("n",)}),
        (cells((0, 2, 4), (0, 2)), {("aggregator",), ("n",)}),
    ],
)
def test_the_effects_that_are_present_are_found(
    values: dict[tuple[str, str], list[float]], present: set[tuple[str, ...]]
) -> None:
    effects = factorial_effects(values, NAMES)
    assert {effect.factors for effect in effects if effect.p < 0.001} == present


def test_an_interaction_is_found() -> None:
    effects = by_factors(factorial_effects(cells((0, 0), (0, 0), interaction=5.0), NAMES))
    assert effects["aggregator", "n"].p < 0.001
    assert effects["aggregator", "n"].partial_eta_squared > 0.3


def test_degrees_of_freedom_are_those_of_the_design() -> None:
    effects = factorial_effects(cells((0, 0, 0), (0, 0), n=7), NAMES)
    assert [(effect.df, effect.df_residual) for effect in effects] == [(2, 36), (1, 36), (2, 36)]


def test_a_shift_of_all_values_changes_nothing() -> None:
    values = cells((0, 1, 2), (0, 1))
    shifted = {key: [value + 100.0 for value in cell] for key, cell in values.items()}
    for one, other in zip(factorial_effects(values, NAMES), factorial_effects(shifted, NAMES), strict=True):
        assert other.f == pytest.approx(one.f, rel=1e-6)


def test_the_order_of_the_factors_does_not_matter() -> None:
    values = cells((0, 1, 2), (0, 1))
    turned = {(second, first): cell for (first, second), cell in values.items()}
    one = by_factors(factorial_effects(values, NAMES))
    other = by_factors(factorial_effects(turned, ("n", "aggregator")))
    assert other["aggregator",].f == pytest.approx(one["aggregator",].f)
    assert other["n", "aggregator"].p == pytest.approx(one["aggregator", "n"].p)


def test_it_agrees_with_the_steps_of_the_article() -> None:
    """A 2 x 2 design worked out by hand: the effect of the first factor is aligned, ranked and tested."""
    values = {
        ("x", "u"): [1.0, 3.0],
        ("x", "v"): [2.0, 6.0],
        ("y", "u"): [9.0, 13.0],
        ("y", "v"): [10.0, 20.0],
    }
    # residuals -1 1 -2 2 -2 2 -5 5, effects of the first factor -5 and +5
    # aligned -6 -4 -7 -3 3 7 0 10, ranks 2 3 1 4 6 7 5 8
    effect = by_factors(factorial_effects(values, NAMES))["aggregator",]
    between = 8 * 2.0**2  # mean ranks 2.5 and 6.5
    within = 0.5 + 4.5 + 0.5 + 4.5
    assert effect.f == pytest.approx(between / (within / 4))
    assert effect.partial_eta_squared == pytest.approx(between / (between + within))


@pytest.mark.parametrize(
    "values",
    [
        {("x", "u"): [1.0, 2.0], ("x", "v"): [1.0, 2.0]},
        {("x", "u"): [1.0, 2.0], ("y", "v"): [1.0, 2.0]},
        {("x", "u"): [1.0, 2.0], ("x", "v"): [1.0], ("y", "u"): [1.0, 2.0], ("y", "v"): [1.0, 2.0]},
    ],
)
def test_an_incomplete_design_is_refused(values: dict[tuple[str, str], list[float]]) -> None:
    with pytest.raises(ValueError, match="expected"):
        factorial_effects(values, NAMES)
