import math
import statistics

import numpy as np
import pytest
from crediting import ANY, aggregate, scores_of
from hypothesis import given, strategies as st

from evoframe.testing import AggregatorContract
from evoframe_aggregators import Maximum, Median, Minimum, Quantile


class TestMaximum(AggregatorContract):
    component = Maximum()


class TestMinimum(AggregatorContract):
    component = Minimum()


class TestMedian(AggregatorContract):
    component = Median()


class TestQuantile(AggregatorContract):
    component = Quantile()


class TestQuantileBetweenScores(AggregatorContract):
    component = Quantile(q=0.123)


@given(scores_of(ANY))
def test_max_and_min_are_those_of_the_scores(scores: list[float]) -> None:
    assert aggregate(Maximum(), scores) == max(scores)
    assert aggregate(Minimum(), scores) == min(scores)


@given(scores_of(ANY))
def test_median_is_that_of_the_standard_library(scores: list[float]) -> None:
    assert aggregate(Median(), scores) == pytest.approx(statistics.median(scores), rel=1e-15, abs=1e-300)


@given(scores_of(ANY))
def test_special_quantiles_are_min_median_and_max(scores: list[float]) -> None:
    for q, component in ((0.0, Minimum()), (0.5, Median()), (1.0, Maximum())):
        assert aggregate(Quantile(q=q), scores).hex() == aggregate(component, scores).hex()


@given(scores_of(ANY), st.floats(0, 1))
def test_quantile_is_that_of_numpy(scores: list[float], q: float) -> None:
    largest = max(map(abs, scores))
    assert aggregate(Quantile(q=q), scores) == pytest.approx(np.quantile(scores, q), abs=1e-12 * largest)


@given(scores_of(ANY), st.floats(0, 1), st.floats(0, 1))
def test_quantile_does_not_fall_as_q_grows(scores: list[float], one: float, other: float) -> None:
    smaller, larger = (aggregate(Quantile(q=each), scores) for each in sorted((one, other)))
    assert smaller <= larger + 1e-12 * abs(larger)


def test_quantile_interpolates_between_neighbors() -> None:
    assert aggregate(Quantile(q=0.25), [40, 10, 20]) == 15.0
    assert aggregate(Quantile(q=0.9), [0, 10]) == 9.0


def test_the_median_is_not_moved_by_one_extreme_score() -> None:
    assert aggregate(Median(), [1, 2, 1e100]) == aggregate(Median(), [1, 2, 3]) == 2.0


@pytest.mark.parametrize("q", [-0.1, 1.1, math.nan])
def test_q_is_a_share(q: float) -> None:
    with pytest.raises(ValueError, match="'q'"):
        Quantile(q=q)


@pytest.mark.parametrize("component", [Maximum(), Minimum(), Median(), Quantile()], ids=str)
def test_the_sign_of_zero_does_not_depend_on_the_order(component: object) -> None:
    signs = {aggregate(component, scores).hex() for scores in ([0.0, -0.0], [-0.0, 0.0], [-0.0])}
    assert signs == {"0x0.0p+0"}
