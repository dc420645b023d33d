"""Tests of all aggregators and credits together, as the plugin offers them."""

import itertools
import math
import re
from typing import Any

import numpy as np
import pytest
from crediting import ANY, POSITIVE, aggregate, credited, crossed, scores_of
from hypothesis import given

from evoframe import Aggregator, ConfigurationError, Credit
from evoframe_aggregators import (
    PAPER_WEIGHTS,
    ArithmeticMean,
    Difference,
    GeometricMean,
    HarmonicMean,
    Lenient,
    Maximum,
    MeanMinusDeviation,
    Median,
    Minimum,
    OrderedWeightedAverage,
    PowerMean,
    Quantile,
    Rank,
    Shapley,
    WeightedMean,
    evoframe_aggregators,
)

OFFERED = dict(evoframe_aggregators())
AGGREGATORS: dict[str, Any] = {
    name: class_() for name, class_ in OFFERED.items() if isinstance(class_(), Aggregator)
}
CREDITS: dict[str, Any] = {name: class_() for name, class_ in OFFERED.items() if name not in AGGREGATORS}


def test_each_has_its_name() -> None:
    assert {
        "am": ArithmeticMean,
        "wm": WeightedMean,
        "gm": GeometricMean,
        "hm": HarmonicMean,
        "max": Maximum,
        "min": Minimum,
        "median": Median,
        "quantile": Quantile,
        "power": PowerMean,
        "owa": OrderedWeightedAverage,
        "mean-minus-sd": MeanMinusDeviation,
        "lenient": Lenient,
        "rank": Rank,
        "difference": Difference,
        "shapley": Shapley,
    } == OFFERED


def test_the_others_credit_all_meetings_of_a_turn() -> None:
    assert list(CREDITS) == ["lenient", "rank", "difference", "shapley"]
    assert all(isinstance(component, Credit) for component in CREDITS.values())


@pytest.mark.parametrize("name", OFFERED)
def test_no_collaborators_are_refused(name: str) -> None:
    with pytest.raises(ConfigurationError) as refused:
        OFFERED[name]().check(0)
    assert refused.value.problem.startswith(f"{name} ")
    assert re.findall(r"\d+", refused.value.problem) == ["1", "0"]


@pytest.mark.parametrize("name", sorted(OFFERED.keys() - {"wm"}))
@pytest.mark.parametrize("n", [1, 4, 8, 25, 1000])
def test_every_one_but_wm_accepts_any_number_of_collaborators(name: str, n: int) -> None:
    component: Any = OFFERED[name]()
    component.check(n)
    scores = np.linspace(0.001, 0.009, n)
    result = (
        component.credit(crossed([scores, scores]), 0) if name in CREDITS else aggregate(component, scores)
    )
    assert np.isfinite(result).all()


@given(scores_of(POSITIVE, PAPER_WEIGHTS))
def test_the_averages_are_ordered(scores: list[float]) -> None:
    names = ("max", "power", "am", "gm", "hm", "min")
    for greater, smaller in itertools.pairwise(names):
        assert aggregate(AGGREGATORS[greater], scores) >= aggregate(AGGREGATORS[smaller], scores) * (
            1 - 1e-12
        )
    wm = aggregate(AGGREGATORS["wm"], scores)
    assert aggregate(AGGREGATORS["max"], scores) >= wm
    assert wm >= aggregate(AGGREGATORS["am"], scores) * (1 - 1e-12)


@given(ANY)
def test_one_score_is_its_own_average(score: float) -> None:
    for name, component in AGGREGATORS.items():
        requires_positive = name in ("gm", "hm", "power")
        assert aggregate(component, [score]) == (1e-5 if requires_positive and score <= 0 else score)
    assert credited(CREDITS["lenient"], crossed([[score]])) == [score]


@pytest.mark.parametrize("name", AGGREGATORS)
class TestInvalidScores:
    def test_no_scores_are_refused(self, name: str) -> None:
        with pytest.raises(ValueError, match="found none"):
            aggregate(AGGREGATORS[name], [])

    @pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf])
    @pytest.mark.parametrize("index", [0, 1])
    def test_infinity_and_nan_are_refused(self, name: str, value: float, index: int) -> None:
        scores = [0.004, 0.004]
        scores[index] = value
        with pytest.raises(ValueError, match=f"found {value}$"):
            aggregate(AGGREGATORS[name], scores)
