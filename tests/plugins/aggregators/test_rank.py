import math
from fractions import Fraction

import pytest
from crediting import credited, crossed, games, turn
from hypothesis import given, strategies as st

from evoframe import ScoredMeetings
from evoframe.testing import CreditContract
from evoframe_aggregators import Rank


class TestRank(CreditContract):
    component = Rank()


def by_definition(meetings: ScoredMeetings, population: int) -> list[float]:
    """Return the fitness by counting, pair by pair of individuals, in fractions."""
    scores: dict[tuple[int, ...], dict[int, float]] = {}
    for row, score in zip(meetings.meetings.tolist(), meetings.scores.tolist(), strict=True):
        judged = row.pop(population)
        if not math.isnan(score):
            scores.setdefault(tuple(row), {})[judged] = score
    values = []
    for member in range(meetings.present[population]):
        shares = []
        for met in scores.values():
            others = [other for judged, other in met.items() if judged != member]
            if member in met and others:
                wins = sum(2 * (met[member] > other) + (met[member] == other) for other in others)
                shares.append(Fraction(wins, 2 * len(others)))
        values.append(float(sum(shares, Fraction()) / len(shares)) if shares else 0.5)
    return values


@given(games((1, 2, 3), diverged=True), st.integers(0, 2))
def test_it_is_the_share_of_comparisons_won(meetings: ScoredMeetings, population: int) -> None:
    population %= len(meetings.populations)
    expected = by_definition(meetings, population)
    assert credited(Rank(), meetings, population) == pytest.approx(expected, rel=1e-12)


@given(games(), st.integers(0, 2))
def test_it_is_a_share(meetings: ScoredMeetings, population: int) -> None:
    population %= len(meetings.populations)
    assert all(0 <= value <= 1 for value in credited(Rank(), meetings, population))


@given(
    st.integers(1, 4).flatmap(
        lambda n: st.lists(st.lists(st.integers(-9, 9), min_size=n, max_size=n), min_size=1)
    )
)
def test_if_everyone_meets_everyone_the_mean_is_one_half(scores: list[list[float]]) -> None:
    values = credited(Rank(), crossed(scores))
    assert math.fsum(values) / len(values) == pytest.approx(0.5)


@given(games((2,)))
def test_only_the_order_of_scores_with_a_collaborator_matters(meetings: ScoredMeetings) -> None:
    stretched = 1e6 * meetings.scores**3 + meetings.meetings[:, 1]
    other = turn(meetings.meetings.tolist(), stretched.tolist(), sizes=meetings.present)
    assert credited(Rank(), other) == credited(Rank(), meetings)


def test_each_collaborator_has_the_same_say() -> None:
    """With one collaborator, scores are a thousand times larger; the mean would follow it alone."""
    assert credited(Rank(), crossed([[3000, 1, 1], [2000, 2, 2], [1000, 3, 3]])) == [1 / 3, 0.5, 2 / 3]


def test_ties_count_half_and_diverged_meetings_do_not_count() -> None:
    assert credited(Rank(), crossed([[7], [7], [5], [9]])) == [0.5, 0.5, 0, 1]
    assert credited(Rank(), crossed([[7], [math.nan], [5], [9]])) == [0.5, 0.5, 0, 1]


def test_an_individual_without_comparison_has_one_half() -> None:
    assert credited(Rank(), turn([(0, 0), (1, 1), (1, 2), (2, 2)], [5, 1, 9, 4])) == [0.5, 1, 0]
