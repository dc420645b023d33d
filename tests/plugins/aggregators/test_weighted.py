import math
import re
from typing import Any

import numpy as np
import pytest
from crediting import ANY, aggregate, scores_of
from hypothesis import given, strategies as st

from evoframe import ConfigurationError
from evoframe.testing import AggregatorContract
from evoframe_aggregators import (
    PAPER_WEIGHTS,
    ArithmeticMean,
    Maximum,
    Minimum,
    OrderedWeightedAverage,
    WeightedMean,
)
from evoframe_aggregators.weights import GENERATORS, generated_weights

WEIGHTS = st.lists(st.integers(0, 1000), min_size=1, max_size=12).filter(any)
NAMES = list(GENERATORS)


class TestWeightedMean(AggregatorContract):
    component = WeightedMean()


class TestWeightedMeanWithWeights(AggregatorContract):
    component = WeightedMean(weights=(0.1, 0.2, 0.0, 0.7))


class TestWeightedMeanWithOneWeight(AggregatorContract):
    component = WeightedMean(weights=(1.0,))


class TestWeightedMeanWithGeneratedWeights(AggregatorContract):
    component = WeightedMean(weights="geometric")


class TestWeightedMeanThatFolds(AggregatorContract):
    component = WeightedMean(fold=True)


class TestOrderedWeightedAverage(AggregatorContract):
    component = OrderedWeightedAverage()


class TestOrderedWeightedAverageWithWeights(AggregatorContract):
    component = OrderedWeightedAverage(weights=(0.2, 0.5, 0.3))


class TestOrderedWeightedAverageThatPrefersBadScores(AggregatorContract):
    component = OrderedWeightedAverage(weights="geometric", parameter=1e300)


class TestOrderedWeightedAverageByAQuantifier(AggregatorContract):
    component = OrderedWeightedAverage(weights="quantifier", parameter=1.7)


class TestOrderedWeightedAverageByRanks(AggregatorContract):
    component = OrderedWeightedAverage(weights="rank-exponent", parameter=0.3)


class TestOrderedWeightedAverageByReciprocals(AggregatorContract):
    component = OrderedWeightedAverage(weights="rank-reciprocal")


class TestOrderedWeightedAverageByTheCentroid(AggregatorContract):
    component = OrderedWeightedAverage(weights="centroid")


@pytest.mark.parametrize("n", PAPER_WEIGHTS)
def test_wm_is_the_dot_product_of_the_paper(n: int) -> None:
    scores = np.random.default_rng(n).normal(0.004, 0.002, size=n)
    expected = np.sort(scores)[::-1] @ np.array(PAPER_WEIGHTS[n])
    assert aggregate(WeightedMean(), scores) == pytest.approx(expected, rel=1e-12)


@pytest.mark.parametrize("weights", PAPER_WEIGHTS.values())
def test_the_papers_weights_can_be_given_explicitly(weights: tuple[float, ...]) -> None:
    scores = np.random.default_rng(0).normal(size=len(weights))
    assert aggregate(WeightedMean(weights=weights), scores) == aggregate(WeightedMean(), scores)


@given(ANY)
def test_wm_accepts_one_collaborator(score: float) -> None:
    for component in (WeightedMean(), WeightedMean(fold=True)):
        component.check(1)
        assert aggregate(component, [score]) == score


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


@given(scores_of(ANY, PAPER_WEIGHTS))
def test_owa_with_the_papers_weights_is_wm(scores: list[float]) -> None:
    owa = OrderedWeightedAverage(weights=PAPER_WEIGHTS[len(scores)])
    assert aggregate(owa, scores).hex() == aggregate(WeightedMean(), scores).hex()


@given(scores_of(ANY), st.sampled_from(NAMES))
def test_wm_and_owa_share_their_generators(scores: list[float], name: Any) -> None:
    owa, wm = OrderedWeightedAverage(weights=name), WeightedMean(weights=name)
    explicit = WeightedMean(weights=generated_weights(name, len(scores)))
    assert aggregate(owa, scores) == aggregate(wm, scores) == aggregate(explicit, scores)


@given(scores_of(ANY))
def test_max_and_min_are_ordered_weighted_averages(scores: list[float]) -> None:
    first, *rest = [1.0] + [0.0] * (len(scores) - 1)
    for largest in (
        OrderedWeightedAverage(weights=(first, *rest)),
        OrderedWeightedAverage(weights="geometric", parameter=0.0),
        OrderedWeightedAverage(weights="quantifier", parameter=0.0),
    ):
        assert aggregate(largest, scores) == aggregate(Maximum(), scores)
    assert aggregate(OrderedWeightedAverage(weights=(*rest, first)), scores) == aggregate(Minimum(), scores)


@given(scores_of(ANY), st.sampled_from([("geometric", 1.0), ("rank-exponent", 0.0), ("quantifier", 1.0)]))
def test_am_is_an_ordered_weighted_average(scores: list[float], generator: tuple[Any, float]) -> None:
    name, parameter = generator
    mean = aggregate(OrderedWeightedAverage(weights=name, parameter=parameter), scores)
    assert mean == pytest.approx(aggregate(ArithmeticMean(), scores), abs=1e-12 * max(map(abs, scores)))


def test_owa_weighs_the_best_scores_most_by_default() -> None:
    assert aggregate(OrderedWeightedAverage(), [0, 9, 0]) == pytest.approx(81 / 19)
    assert aggregate(OrderedWeightedAverage(parameter=0.5), [0, 7, 0]) == pytest.approx(4.0)


@pytest.mark.parametrize("weights", ["centroid", (0.6, 0.4)])
def test_a_parameter_requires_a_generator_that_has_one(weights: Any) -> None:
    with pytest.raises(ValueError, match=r"no parameter; .*aggregator\.parameter"):
        OrderedWeightedAverage(weights=weights, parameter=1.0)


@pytest.mark.parametrize("parameter", [-0.5, math.nan])
def test_a_parameter_is_a_number_from_zero(parameter: float) -> None:
    with pytest.raises(ValueError, match="'parameter'"):
        OrderedWeightedAverage(parameter=parameter)


@pytest.mark.parametrize("class_", [WeightedMean, OrderedWeightedAverage])
def test_invalid_weights_are_refused(class_: type[Any]) -> None:
    for weights in ((0.5, 0.4), "geometrik"):
        with pytest.raises(ValueError, match="expected weights"):
            class_(weights=weights)


def test_fold_and_weights_exclude_each_other() -> None:
    for weights in ((0.6, 0.4), "geometric"):
        with pytest.raises(ValueError, match=r"aggregator\.weights or aggregator\.fold$"):
            WeightedMean(weights=weights, fold=True)


def refusal(component: Any, n: int) -> str:
    with pytest.raises(ConfigurationError) as refused:
        component.check(n)
    return refused.value.problem


def numbers(message: str) -> list[int]:
    return [int(number) for number in re.findall(r"\d+", message)]


@pytest.mark.parametrize("n", [4, 6, 20])
def test_wm_without_weights_names_the_paper_s_numbers_and_the_options_to_set(n: int) -> None:
    message = refusal(WeightedMean(), n)
    assert numbers(message) == [n, *PAPER_WEIGHTS]
    assert 'aggregator.weights = "geometric"' in message
    assert "aggregator.fold = true" in message
    WeightedMean(weights="geometric").check(n)


@pytest.mark.parametrize("component", [WeightedMean(), WeightedMean(fold=True)])
@pytest.mark.parametrize("n", [8, 25])
def test_fold_is_suggested_only_where_it_helps(component: Any, n: int) -> None:
    message = refusal(component, n)
    assert numbers(message) == [n, *PAPER_WEIGHTS]
    assert 'aggregator.weights = "geometric"' in message
    assert "fold" not in message


@pytest.mark.parametrize(("name", "class_"), [("wm", WeightedMean), ("owa", OrderedWeightedAverage)])
def test_both_numbers_are_named_if_there_are_too_few_weights(name: str, class_: type[Any]) -> None:
    message = refusal(class_(weights=(0.7, 0.3)), 5)
    assert message.startswith(f"{name} ")
    assert numbers(message) == [2, 5]
    assert "aggregator.weights" in message
