import itertools
import math
from collections.abc import Iterable, Sequence
from fractions import Fraction

import attrs
import numpy as np
import pytest
from crediting import credited, crossed, games, shuffled, turn
from hypothesis import assume, given, strategies as st

from evoframe import ScoredMeetings
from evoframe.testing import CreditContract
from evoframe_aggregators import ArithmeticMean, Difference, Shapley


class TestDifference(CreditContract):
    component = Difference()


class TestDifferenceOfFourRoles(CreditContract):
    component = Difference()
    populations = range(4, 5)
    counts = range(3)


class TestShapley(CreditContract):
    component = Shapley()


class TestShapleyBySamples(CreditContract):
    component = Shapley(samples=3, seed=7)
    populations = range(3, 5)
    counts = range(3)


def value(meetings: ScoredMeetings, index: int, roles: Iterable[int]) -> Fraction:
    """Return the mean score of all meetings that agree with one in some roles, by comparing all."""
    rows = meetings.meetings.tolist()
    scores = [
        Fraction(score)
        for row, score in zip(rows, meetings.scores.tolist(), strict=True)
        if not math.isnan(score) and all(row[role] == rows[index][role] for role in roles)
    ]
    return sum(scores, Fraction()) / len(scores)


def shapley_value(
    meetings: ScoredMeetings, index: int, role: int, orders: Sequence[Sequence[int]]
) -> Fraction:
    """Return what a role of a meeting adds, mean over orders."""
    gains = [
        value(meetings, index, order[: order.index(role) + 1])
        - value(meetings, index, order[: order.index(role)])
        for order in map(list, orders)
    ]
    return sum(gains, Fraction()) / len(gains)


def mean_over_meetings(meetings: ScoredMeetings, population: int, of: dict[int, Fraction]) -> list[float]:
    values = []
    for own in meetings.of(population):
        known = [of[index] for index in own.tolist() if index in of]
        values.append(float(sum(known, Fraction()) / len(known)) if known else math.nan)
    return values


def clean(meetings: ScoredMeetings) -> list[int]:
    return [index for index, score in enumerate(meetings.scores.tolist()) if not math.isnan(score)]


@given(games((1, 2, 3), diverged=True))
def test_difference_is_its_definition(meetings: ScoredMeetings) -> None:
    everyone = range(len(meetings.populations))
    for population in everyone:
        others = set(everyone) - {population}
        lost = {
            index: value(meetings, index, everyone) - value(meetings, index, others)
            for index in clean(meetings)
        }
        expected = mean_over_meetings(meetings, population, lost)
        assert credited(Difference(), meetings, population) == pytest.approx(expected, abs=1e-12, nan_ok=True)


@given(games((1, 2, 3), diverged=True))
def test_shapley_is_its_definition(meetings: ScoredMeetings) -> None:
    orders = list(itertools.permutations(range(len(meetings.populations))))
    for population in range(len(meetings.populations)):
        values = {index: shapley_value(meetings, index, population, orders) for index in clean(meetings)}
        expected = mean_over_meetings(meetings, population, values)
        assert credited(Shapley(), meetings, population) == pytest.approx(expected, abs=1e-12, nan_ok=True)


@given(games((1, 2, 3), diverged=True), st.integers(1, 8))
def test_the_values_of_all_roles_sum_to_the_score_above_the_mean(
    meetings: ScoredMeetings, samples: int
) -> None:
    """Efficiency: also with samples, since all roles share their orders."""
    assume(clean(meetings))
    component = Shapley(samples=samples)
    total = sum(component.values(meetings, population) for population in range(len(meetings.populations)))
    expected = meetings.scores - np.nanmean(meetings.scores)
    assert total == pytest.approx(expected, abs=1e-12, nan_ok=True)


tables = st.tuples(st.integers(1, 4), st.integers(1, 4)).flatmap(
    lambda shape: st.lists(
        st.lists(st.integers(-9, 9).map(float), min_size=shape[1], max_size=shape[1]),
        min_size=shape[0],
        max_size=shape[0],
    )
)


@given(tables)
def test_if_everyone_meets_everyone_both_are_the_effect_of_the_row(scores: list[list[float]]) -> None:
    effects = np.mean(scores, axis=1) - np.mean(scores)
    for component in (Difference(), Shapley()):
        assert credited(component, crossed(scores)) == pytest.approx(effects.tolist(), abs=1e-12)


@given(tables)
def test_with_the_same_collaborators_difference_ranks_as_am(scores: list[list[float]]) -> None:
    values = credited(Difference(), crossed(scores))
    means = [ArithmeticMean().aggregate(np.array(row)) for row in scores]
    for (one, its_mean), (other, other_mean) in itertools.pairwise(zip(values, means, strict=True)):
        assert one - other == pytest.approx(its_mean - other_mean, abs=1e-12)


def test_a_good_collaborator_makes_nobody_fit() -> None:
    """The mean prefers individual 0, who met the good collaborator; difference and Shapley see through it."""
    meetings = turn([(0, 0), (1, 0), (1, 1), (2, 1)], [10, 11, 1, 0])
    assert credited(Difference(), meetings) == [-0.5, 0.5, -0.5]
    assert credited(Shapley(), meetings)[1] > 0


@given(tables, st.integers(1, 3))
def test_individuals_that_change_no_score_have_no_value(scores: list[list[float]], size: int) -> None:
    """Null players: scores depend on the other two populations only."""
    meetings = crossed([scores] * size)
    for component in (Difference(), Shapley(), Shapley(samples=1)):
        assert credited(component, meetings) == pytest.approx([0.0] * size, abs=1e-12)


@given(games((2, 3)), st.integers(-5, 5), st.integers(1, 5))
def test_values_are_linear_in_the_scores(meetings: ScoredMeetings, shift: int, factor: int) -> None:
    moved = attrs.evolve(meetings, scores=meetings.scores * factor + shift)
    for component in (Difference(), Shapley(), Shapley(samples=1)):
        expected = [factor * each for each in credited(component, meetings)]
        assert credited(component, moved) == pytest.approx(expected, abs=1e-10)


@given(games((3,), diverged=True), st.integers(1, 5), st.integers(0, 99))
def test_samples_are_the_mean_of_some_orders(meetings: ScoredMeetings, samples: int, seed: int) -> None:
    rng = np.random.default_rng([seed, meetings.turn])
    orders = [rng.permutation(3).tolist() for _ in range(samples)]
    values = {index: shapley_value(meetings, index, 1, orders) for index in clean(meetings)}
    expected = mean_over_meetings(meetings, 1, values)
    found = credited(Shapley(samples=samples, seed=seed), meetings, 1)
    assert found == pytest.approx(expected, abs=1e-12, nan_ok=True)


@given(games((3,)), st.integers(1, 5), st.integers(0, 99))
def test_samples_do_not_depend_on_the_order_of_the_meetings(
    meetings: ScoredMeetings, samples: int, seed: int
) -> None:
    component = Shapley(samples=samples)
    assert credited(component, shuffled(meetings, seed)) == credited(component, meetings)


def incomplete() -> ScoredMeetings:
    """Return a turn of four roles in which half of the meetings diverged.

    If all had a score, the mean over an individual's meetings would not depend on the order of the roles.
    """
    rng = np.random.default_rng(1)
    scores = rng.normal(size=(3, 3, 3, 3))
    return crossed(np.where(rng.random(scores.shape) < 0.5, scores, np.nan))


def test_samples_depend_on_seed_and_turn() -> None:
    fitness = {
        round(credited(Shapley(samples=5, seed=seed), attrs.evolve(incomplete(), turn=index))[0], 9)
        for seed in (0, 1)
        for index in (0, 1)
    }
    assert len(fitness) == 4


def test_samples_approach_the_exact_value_which_depends_on_no_seed() -> None:
    exact = credited(Shapley(samples=24), incomplete())
    assert exact == credited(Shapley(samples=25, seed=5), attrs.evolve(incomplete(), turn=9))
    one, few, many = (
        np.mean([_error(Shapley(samples=n, seed=seed), exact) for seed in range(20)]) for n in (1, 5, 23)
    )
    assert many < few < one
    assert many < one / 3


def _error(component: Shapley, exact: list[float]) -> float:
    """Return the largest deviation from the exact values."""
    return float(np.abs(np.subtract(credited(component, incomplete()), exact)).max())


@pytest.mark.parametrize("option", [{"samples": 0}, {"seed": -1}], ids=str)
def test_invalid_options_are_refused(option: dict[str, int]) -> None:
    with pytest.raises(ValueError, match=f"'{next(iter(option))}'"):
        Shapley(**option)
