import math
import statistics

import pytest
from crediting import ANY, aggregate, scores_of
from hypothesis import given, strategies as st

from evoframe.testing import AggregatorContract
from evoframe_aggregators import ArithmeticMean, MeanMinusDeviation


class TestMeanMinusDeviation(AggregatorContract):
    component = MeanMinusDeviation()


class TestMeanMinusDeviationWithTheLargestRisk(AggregatorContract):
    component = MeanMinusDeviation(risk=1e100)


@given(scores_of(ANY))
def test_without_risk_it_is_am(scores: list[float]) -> None:
    assert aggregate(MeanMinusDeviation(risk=0.0), scores) == aggregate(ArithmeticMean(), scores)


@given(scores_of(st.floats(-1e3, 1e3)), st.floats(0, 10))
def test_it_is_its_definition(scores: list[float], risk: float) -> None:
    expected = statistics.fmean(scores) - risk * statistics.pstdev(scores)
    assert aggregate(MeanMinusDeviation(risk=risk), scores) == pytest.approx(expected, rel=1e-9, abs=1e-9)


@given(scores_of(ANY), st.floats(0, 1e3), st.floats(0, 1e3))
def test_it_does_not_rise_with_the_risk(scores: list[float], one: float, other: float) -> None:
    more, less = sorted((one, other), reverse=True)
    assert aggregate(MeanMinusDeviation(risk=more), scores) <= aggregate(
        MeanMinusDeviation(risk=less), scores
    )


@given(scores_of(st.integers(-100, 100).map(float)), st.integers(-100, 100))
def test_it_moves_with_the_scores(scores: list[float], shift: int) -> None:
    moved = aggregate(MeanMinusDeviation(), [score + shift for score in scores])
    assert moved == pytest.approx(aggregate(MeanMinusDeviation(), scores) + shift, abs=1e-9)


def test_the_laws_from_which_it_is_exempt_do_not_hold() -> None:
    """Without these examples, the exemptions would be unfounded."""
    assert aggregate(MeanMinusDeviation(), [0, 0, 0, 1]) < 0
    assert aggregate(MeanMinusDeviation(risk=2.0), [0, 2]) < aggregate(MeanMinusDeviation(risk=2.0), [0, 1])
    assert set(MeanMinusDeviation.exempt_from) == {"bounded", "monotone"}


def test_the_steadier_of_equal_means_is_fitter() -> None:
    assert aggregate(MeanMinusDeviation(), [3, 5]) > aggregate(MeanMinusDeviation(), [0, 8])


@pytest.mark.parametrize("risk", [-1.0, math.nan, math.inf])
def test_risk_is_a_number_from_zero(risk: float) -> None:
    with pytest.raises(ValueError, match="'risk'"):
        MeanMinusDeviation(risk=risk)
