import math

import pytest
from crediting import ANY, aggregate, credited, crossed, scores_of, turn
from hypothesis import given, strategies as st

from evoframe.testing import CreditContract
from evoframe_aggregators import ArithmeticMean, Lenient, Maximum

SHARES = st.floats(0, 1)


class TestLenient(CreditContract):
    component = Lenient()


class TestLenientThatBecomesStricter(CreditContract):
    component = Lenient(start=0.9, end=0.2, turns=37)


def fitness(component: Lenient, scores: list[float], *, index: int = 0) -> float:
    [value] = credited(component, crossed([scores], index=index))
    return value


@given(scores_of(ANY), st.integers(0, 1000))
def test_with_all_scores_it_is_am_and_with_the_best_alone_it_is_max(scores: list[float], index: int) -> None:
    assert fitness(Lenient(start=1.0, end=1.0), scores, index=index) == aggregate(ArithmeticMean(), scores)
    assert fitness(Lenient(start=0.0, end=0.0), scores, index=index) == aggregate(Maximum(), scores)


@given(scores_of(ANY), st.integers(1, 300))
def test_by_default_it_begins_as_max_and_ends_as_am(scores: list[float], turns: int) -> None:
    component = Lenient(turns=turns)
    assert fitness(component, scores, index=0) == aggregate(Maximum(), scores)
    for index in (turns, turns + 1, 10 * turns):
        assert fitness(component, scores, index=index) == aggregate(ArithmeticMean(), scores)


@pytest.mark.parametrize(
    ("index", "best"), [(0, [9]), (1, [9]), (3, [9, 8]), (5, [9, 8, 4]), (10, [9, 8, 4, 2, 1])]
)
def test_the_number_of_scores_that_count_grows_from_turn_to_turn(index: int, best: list[float]) -> None:
    expected = sum(best) / len(best)
    assert fitness(Lenient(turns=10), [2, 9, 1, 8, 4], index=index) == expected


@given(scores_of(st.integers(-99, 99).map(float)), SHARES, SHARES, st.integers(1, 20), st.data())
def test_fitness_is_the_mean_of_as_many_best_scores_as_the_share_says(
    scores: list[float], start: float, end: float, turns: int, data: st.DataObject
) -> None:
    index = data.draw(st.integers(0, 2 * turns))
    share = start + (end - start) * min(index / turns, 1)
    exact = share * (len(scores) - 1)
    means = {
        k: math.fsum(sorted(scores)[-1 - k :]) / (k + 1)
        for k in range(len(scores))
        if abs(k - exact) <= 0.5 + 1e-9
    }
    assert fitness(Lenient(start=start, end=end, turns=turns), scores, index=index) in means.values()


@given(scores_of(ANY), SHARES, SHARES)
def test_the_fewer_scores_count_the_higher_is_the_fitness(
    scores: list[float], one: float, other: float
) -> None:
    fewer, more = (fitness(Lenient(start=share), scores) for share in sorted((one, other)))
    assert fewer >= more - 1e-12 * abs(more)


def test_diverged_meetings_are_left_out() -> None:
    meetings = turn([(0, 0), (0, 1), (0, 2), (1, 0), (2, 0)], [1, math.nan, 3, 5, math.nan])
    values = credited(Lenient(start=1.0), meetings)
    assert values == pytest.approx([2, 5, math.nan], nan_ok=True)


def test_individuals_can_have_different_numbers_of_meetings() -> None:
    meetings = turn([(0, 0), (0, 1), (0, 2), (1, 0)], [1, 2, 3, 5])
    assert credited(Lenient(start=0.5, end=0.5), meetings) == [2.5, 5]
    assert credited(Lenient(start=0.5, end=0.5), meetings, 1) == [3, 2, 3]


@pytest.mark.parametrize(
    "option", [{"start": -0.1}, {"start": 1.1}, {"end": math.nan}, {"turns": 0}], ids=str
)
def test_invalid_options_are_refused(option: dict[str, float]) -> None:
    with pytest.raises(ValueError, match=f"'{next(iter(option))}'"):
        Lenient(**option)  # type: ignore[arg-type]
