import math
import re
import statistics
import sys
from collections.abc import Iterable
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings, strategies as st

from evoframe import ConfigurationError
from evoframe.testing import AggregatorContract
from evoframe_aggregators import (
    PAPER_WEIGHTS,
    ArithmeticMean,
    GeometricMean,
    HarmonicMean,
    WeightedMean,
    evoframe_aggregators,
)

WEIGHTS = st.lists(st.integers(0, 1000), min_size=1, max_size=12).filter(any)
POSITIVE = st.floats(1e-5, 1e100)
ANY = st.floats(-1e100, 1e100)


def scores_of(score: st.SearchStrategy[float], counts: Iterable[int] = range(1, 31)) -> Any:
    return st.sampled_from(list(counts)).flatmap(lambda n: st.lists(score, min_size=n, max_size=n))


def aggregate(component: Any, scores: Any) -> float:
    fitness: float = component.aggregate(np.array(scores, dtype=np.float64))
    return fitness


class TestArithmeticMean(AggregatorContract):
    component = ArithmeticMean()


class TestWeightedMean(AggregatorContract):
    component = WeightedMean()


class TestWeightedMeanWithWeights(AggregatorContract):
    component = WeightedMean(weights=(0.1, 0.2, 0.0, 0.7))


class TestWeightedMeanWithOneWeight(AggregatorContract):
    component = WeightedMean(weights=(1.0,))


class TestWeightedMeanThatFolds(AggregatorContract):
    component = WeightedMean(fold=True)


class TestGeometricMean(AggregatorContract):
    component = GeometricMean()


class TestGeometricMeanThatClips(AggregatorContract):
    component = GeometricMean(clip=True)


class TestGeometricMeanWithASubnormalFloor(AggregatorContract):
    component = GeometricMean(floor=5e-324)


class TestHarmonicMean(AggregatorContract):
    component = HarmonicMean()


class TestHarmonicMeanThatClips(AggregatorContract):
    component = HarmonicMean(clip=True)


class TestHarmonicMeanWithASubnormalFloor(AggregatorContract):
    component = HarmonicMean(floor=5e-324)


def test_the_names_are_those_of_the_paper() -> None:
    assert dict(evoframe_aggregators()) == {
        "am": ArithmeticMean,
        "wm": WeightedMean,
        "gm": GeometricMean,
        "hm": HarmonicMean,
    }


@given(scores_of(ANY))
def test_am_is_the_mean_of_the_standard_library(scores: list[float]) -> None:
    assert aggregate(ArithmeticMean(), scores) == statistics.fmean(scores)


@given(scores_of(POSITIVE))
def test_gm_is_the_geometric_mean_of_the_standard_library(scores: list[float]) -> None:
    assert aggregate(GeometricMean(), scores) == pytest.approx(statistics.geometric_mean(scores), rel=1e-12)


@given(scores_of(POSITIVE))
def test_hm_is_the_harmonic_mean_of_the_standard_library(scores: list[float]) -> None:
    assert aggregate(HarmonicMean(), scores) == pytest.approx(statistics.harmonic_mean(scores), rel=1e-12)


@pytest.mark.parametrize("n", PAPER_WEIGHTS)
def test_wm_is_the_dot_product_of_the_paper(n: int) -> None:
    scores = np.random.default_rng(n).normal(0.004, 0.002, size=n)
    expected = np.sort(scores)[::-1] @ np.array(PAPER_WEIGHTS[n])
    assert aggregate(WeightedMean(), scores) == pytest.approx(expected, rel=1e-12)


def test_the_table_is_that_of_the_paper() -> None:
    assert dict(PAPER_WEIGHTS) == {
        2: (0.6, 0.4),
        3: (0.5, 0.3, 0.2),
        5: (0.4, 0.3, 0.15, 0.1, 0.05),
        7: (0.35, 0.25, 0.15, 0.12, 0.07, 0.04, 0.02),
        10: (0.3, 0.2, 0.15, 0.12, 0.08, 0.05, 0.04, 0.03, 0.02, 0.01),
    }


@pytest.mark.parametrize("weights", PAPER_WEIGHTS.values())
def test_the_papers_weights_can_be_given_explicitly(weights: tuple[float, ...]) -> None:
    scores = np.random.default_rng(0).normal(size=len(weights))
    assert aggregate(WeightedMean(weights=weights), scores) == aggregate(WeightedMean(), scores)


@given(scores_of(POSITIVE, PAPER_WEIGHTS))
def test_the_averages_are_ordered(scores: list[float]) -> None:
    wm, am, gm, hm = (
        aggregate(component, scores)
        for component in (WeightedMean(), ArithmeticMean(), GeometricMean(), HarmonicMean())
    )
    for greater, smaller in ((wm, am), (am, gm), (gm, hm)):
        assert greater >= smaller * (1 - 1e-12)


@given(st.floats(-1e100, 1e100))
def test_one_score_is_its_own_average(score: float) -> None:
    assert aggregate(ArithmeticMean(), [score]) == score
    assert aggregate(WeightedMean(weights=(1.0,)), [score]) == score
    effective = score if score > 0 else 1e-5
    assert aggregate(GeometricMean(), [score]) == effective
    assert aggregate(HarmonicMean(), [score]) == effective


@given(WEIGHTS)
def test_any_shares_of_a_whole_are_weights(parts: list[int]) -> None:
    weights = tuple(part / sum(parts) for part in parts)
    component = WeightedMean(weights=weights)
    component.check(len(weights))
    assert aggregate(component, [3.0] * len(weights)) == 3.0


@pytest.mark.parametrize(
    ("scores", "folded"),
    [
        ([1, 2, 3, 4], [3.5, 1.5]),
        ([6, 1, 5, 2, 4, 3], [5.5, 3.5, 1.5]),
        (range(20), [18.5, 16.5, 14.5, 12.5, 10.5, 8.5, 6.5, 4.5, 2.5, 0.5]),
    ],
)
def test_fold_averages_neighbors_of_the_sorted_scores(scores: list[float], folded: list[float]) -> None:
    assert aggregate(WeightedMean(fold=True), list(scores)) == aggregate(WeightedMean(), folded)


@given(scores_of(ANY, PAPER_WEIGHTS))
def test_fold_changes_nothing_for_the_numbers_of_the_table(scores: list[float]) -> None:
    assert aggregate(WeightedMean(fold=True), scores) == aggregate(WeightedMean(), scores)


@pytest.mark.parametrize("class_", [GeometricMean, HarmonicMean])
class TestFloor:
    def test_replaces_scores_that_are_not_positive(self, class_: type[Any]) -> None:
        assert aggregate(class_(), [-0.01, 0.0, 0.004]) == aggregate(class_(), [1e-5, 1e-5, 0.004])

    def test_does_not_change_small_positive_scores(self, class_: type[Any]) -> None:
        assert aggregate(class_(), [1e-6, 0.004]) < aggregate(class_(), [-1.0, 0.004])

    def test_raises_small_positive_scores_if_clip_is_set(self, class_: type[Any]) -> None:
        assert aggregate(class_(clip=True), [1e-6, 0.004]) == aggregate(class_(clip=True), [-1.0, 0.004])

    @given(scores=scores_of(st.floats(-1, 1)), grown=st.floats(-1, 1))
    def test_with_clip_a_greater_score_never_counts_less(
        self, class_: type[Any], scores: list[float], grown: float
    ) -> None:
        component = class_(clip=True)
        before = aggregate(component, scores)
        assert aggregate(component, [max(grown, scores[0]), *scores[1:]]) >= before * (1 - 1e-12)

    def test_can_be_chosen(self, class_: type[Any]) -> None:
        assert class_(floor=1e-3).domain == (1e-3, 1e100)
        assert aggregate(class_(floor=1e-3), [-1.0, -2.0]) == 1e-3

    @pytest.mark.parametrize("floor", [0.0, -1e-5, math.inf, math.nan, 1e101])
    def test_is_a_positive_number(self, class_: type[Any], floor: float) -> None:
        with pytest.raises(ValueError, match="'floor'"):
            class_(floor=floor)


@settings(max_examples=300)
@given(scores_of(st.floats(-1e100, 1e100) | st.floats(0, sys.float_info.min)))
def test_effective_scores_enclose_gm_and_hm(scores: list[float]) -> None:
    effective = [score if score > 0 else 1e-5 for score in scores]
    for component in (GeometricMean(), HarmonicMean()):
        assert min(effective) <= aggregate(component, scores) <= max(effective)


@pytest.mark.parametrize(
    "component", [ArithmeticMean(), WeightedMean(), GeometricMean(), HarmonicMean()], ids=str
)
class TestInvalidScores:
    def test_no_scores_are_refused(self, component: Any) -> None:
        with pytest.raises(ValueError, match="found none"):
            aggregate(component, [])

    @pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf])
    @pytest.mark.parametrize("index", [0, 1])
    def test_infinity_and_nan_are_refused(self, component: Any, value: float, index: int) -> None:
        scores = [0.004, 0.004]
        scores[index] = value
        with pytest.raises(ValueError, match=f"found {value}$"):
            aggregate(component, scores)


def refusal(component: Any, n: int) -> str:
    with pytest.raises(ConfigurationError) as refused:
        component.check(n)
    return refused.value.problem


def numbers(message: str) -> list[int]:
    return [int(number) for number in re.findall(r"\d+", message)]


@pytest.mark.parametrize(("name", "class_"), evoframe_aggregators().items())
def test_no_collaborators_are_refused(name: str, class_: type[Any]) -> None:
    message = refusal(class_(), 0)
    assert message.startswith(f"{name} ")
    assert numbers(message) == [1, 0]


@pytest.mark.parametrize("n", [4, 6, 20])
def test_wm_without_weights_names_the_paper_s_numbers_and_the_options_to_set(n: int) -> None:
    message = refusal(WeightedMean(), n)
    assert numbers(message) == [n, *PAPER_WEIGHTS]
    assert "aggregator.weights" in message
    assert "aggregator.fold = true" in message


@pytest.mark.parametrize("component", [WeightedMean(), WeightedMean(fold=True)])
@pytest.mark.parametrize("n", [1, 8])
def test_fold_is_suggested_only_where_it_helps(component: Any, n: int) -> None:
    message = refusal(component, n)
    assert numbers(message) == [n, *PAPER_WEIGHTS]
    assert "aggregator.weights" in message
    assert "fold" not in message


def test_wm_names_both_numbers_if_there_are_too_few_weights() -> None:
    message = refusal(WeightedMean(weights=(0.7, 0.3)), 5)
    assert numbers(message) == [2, 5]
    assert "aggregator.weights" in message


@pytest.mark.parametrize(
    ("weights", "problem"),
    [
        ((), "found none"),
        ((0.5, 0.4), "sum 0.9"),
        ((0.5, 0.5 + 1e-11), "sum 1.00000000001"),
        ((1.5, -0.5), "non-negative .* -0.5"),
        ((math.nan, 1.0), "non-negative .* nan"),
        ((math.inf, 0.0), "sum inf"),
    ],
)
def test_wm_refuses_invalid_weights(weights: tuple[float, ...], problem: str) -> None:
    with pytest.raises(ValueError, match=f"{problem}$"):
        WeightedMean(weights=weights)


def test_fold_and_weights_exclude_each_other() -> None:
    with pytest.raises(ValueError, match=r"aggregator\.weights or aggregator\.fold$"):
        WeightedMean(weights=(0.6, 0.4), fold=True)
