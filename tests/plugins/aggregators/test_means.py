import decimal
import itertools
import math
import statistics
import sys
from typing import Any

import pytest
from crediting import ANY, POSITIVE, aggregate, scores_of
from hypothesis import example, given, settings, strategies as st

from evoframe.testing import AggregatorContract
from evoframe_aggregators import (
    ArithmeticMean,
    GeometricMean,
    HarmonicMean,
    Maximum,
    Minimum,
    PowerMean,
)

EXPONENTS = st.floats(allow_nan=False, allow_infinity=False) | st.floats(-20, 20)


class TestArithmeticMean(AggregatorContract):
    component = ArithmeticMean()


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


class TestPowerMean(AggregatorContract):
    component = PowerMean()


class TestPowerMeanThatClips(AggregatorContract):
    component = PowerMean(exponent=-3.0, clip=True)


class TestPowerMeanWithASubnormalFloor(AggregatorContract):
    component = PowerMean(exponent=0.5, floor=5e-324)


class TestPowerMeanWithExponentOne(AggregatorContract):
    component = PowerMean(exponent=1.0)


class TestPowerMeanWithATinyExponent(AggregatorContract):
    component = PowerMean(exponent=1e-21, floor=5e-324)


class TestPowerMeanWithAHugeExponent(AggregatorContract):
    component = PowerMean(exponent=sys.float_info.max, floor=5e-324)


class TestPowerMeanWithAHugeNegativeExponent(AggregatorContract):
    component = PowerMean(exponent=-sys.float_info.max, floor=5e-324)


@given(scores_of(ANY))
def test_am_is_the_mean_of_the_standard_library(scores: list[float]) -> None:
    assert aggregate(ArithmeticMean(), scores) == statistics.fmean(scores)


@given(scores_of(POSITIVE))
def test_gm_is_the_geometric_mean_of_the_standard_library(scores: list[float]) -> None:
    assert aggregate(GeometricMean(), scores) == pytest.approx(statistics.geometric_mean(scores), rel=1e-12)


@given(scores_of(POSITIVE))
def test_hm_is_the_harmonic_mean_of_the_standard_library(scores: list[float]) -> None:
    assert aggregate(HarmonicMean(), scores) == pytest.approx(statistics.harmonic_mean(scores), rel=1e-12)


@pytest.mark.parametrize("class_", [GeometricMean, HarmonicMean, PowerMean])
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
def test_effective_scores_enclose_gm_hm_and_power(scores: list[float]) -> None:
    effective = [score if score > 0 else 1e-5 for score in scores]
    for component in (GeometricMean(), HarmonicMean(), PowerMean()):
        assert min(effective) <= aggregate(component, scores) <= max(effective)


@given(scores=scores_of(ANY), floor=st.floats(5e-324, 1e100), clip=st.booleans())
def test_am_gm_and_hm_are_power_means_to_the_last_bit(scores: list[float], floor: float, clip: bool) -> None:
    same = {
        1.0: ArithmeticMean(),
        0.0: GeometricMean(floor=floor, clip=clip),
        -1.0: HarmonicMean(floor=floor, clip=clip),
    }
    for exponent, component in same.items():
        power = PowerMean(exponent=exponent, floor=floor, clip=clip)
        assert aggregate(power, scores).hex() == aggregate(component, scores).hex()


@given(scores_of(st.floats(1e-3, 1e3)), st.floats(0.01, 20) | st.floats(-20, -0.01))
def test_power_is_its_definition(scores: list[float], exponent: float) -> None:
    mean = math.fsum(score**exponent for score in scores) / len(scores)
    power = aggregate(PowerMean(exponent=exponent), scores)
    assert power == pytest.approx(mean ** (1 / exponent), rel=1e-11)


@given(scores_of(st.floats(1e-3, 1e3), range(1, 6)), st.floats(-25, -2), st.sampled_from([1, -1]))
def test_power_is_its_definition_for_small_exponents(scores: list[float], digits: float, sign: int) -> None:
    exponent = sign * 10**digits
    with decimal.localcontext(prec=60):
        power = decimal.Decimal(exponent)
        powers = (decimal.Decimal(score) ** power for score in scores)
        mean = sum(powers, decimal.Decimal()) / len(scores)
        expected = float(mean ** (1 / power))
    assert aggregate(PowerMean(exponent=exponent), scores) == pytest.approx(expected, rel=1e-13)


@given(scores_of(POSITIVE))
def test_am_and_hm_continue_the_power_means_around_them(scores: list[float]) -> None:
    for exponent, component in ((1.0, ArithmeticMean()), (-1.0, HarmonicMean())):
        near = aggregate(PowerMean(exponent=math.nextafter(exponent, 0)), scores)
        assert near == pytest.approx(aggregate(component, scores), rel=1e-12)


@given(scores_of(st.floats(5e-324, 1e100)), st.sampled_from([1.0, -1.0]))
@example([5e-324, 1e100, 1e100, 1e100, 1e100, 1e100, 1e100, 1e100], -1.0)
def test_gm_is_the_limit_of_small_exponents(scores: list[float], sign: float) -> None:
    expected = aggregate(GeometricMean(), scores)
    for size in (5e-324, 1e-300, 1e-22, 1e-21, 1e-19):
        # The ratio to gm is about exp(exponent * variance of logs / 2), below 1 + 2e-14 here.
        power = aggregate(PowerMean(exponent=sign * size), scores)
        assert power == pytest.approx(expected, rel=1e-12, abs=sys.float_info.min)


@given(scores_of(st.floats(5e-324, 1e100)), st.sampled_from([1e300, sys.float_info.max]))
def test_max_and_min_are_the_power_means_of_huge_exponents(scores: list[float], size: float) -> None:
    assert aggregate(PowerMean(exponent=size), scores) == aggregate(Maximum(), scores)
    assert aggregate(PowerMean(exponent=-size), scores) == aggregate(Minimum(), scores)


@given(scores_of(POSITIVE), st.floats(1, 1e6))
def test_power_approaches_max_and_min_as_the_exponent_grows(scores: list[float], size: float) -> None:
    """The largest of n scores exceeds the power mean at most by the factor n**(1/exponent)."""
    factor = len(scores) ** (1 / size) * (1 + 1e-12)
    assert max(scores) <= aggregate(PowerMean(exponent=size), scores) * factor
    assert min(scores) >= aggregate(PowerMean(exponent=-size), scores) / factor


@given(scores_of(POSITIVE), EXPONENTS, EXPONENTS)
@example([1.0, 2.0], 0.0, 1e-22)
@example([1.0, 2.0], 1.0, math.nextafter(1.0, 2.0))
def test_power_does_not_fall_as_its_exponent_grows(scores: list[float], one: float, other: float) -> None:
    smaller, larger = (aggregate(PowerMean(exponent=each), scores) for each in sorted((one, other)))
    assert smaller <= larger * (1 + 1e-12)


def test_power_rises_with_its_exponent_if_scores_differ() -> None:
    results = [aggregate(PowerMean(exponent=each), [1, 2, 4]) for each in (-9, -1, -0.1, 0, 0.1, 1, 2, 9)]
    assert all(low < high for low, high in itertools.pairwise(results))
    assert aggregate(PowerMean(), [1, 7]) == 5.0


@pytest.mark.parametrize("exponent", [math.inf, -math.inf, math.nan])
def test_an_exponent_that_is_not_finite_is_refused_with_the_names_of_the_limits(exponent: float) -> None:
    with pytest.raises(ValueError, match=f"found {exponent}; .*max.*min"):
        PowerMean(exponent=exponent)


def test_only_exponent_one_accepts_all_scores() -> None:
    assert PowerMean(exponent=1.0).domain == ArithmeticMean.domain
    assert PowerMean(exponent=3.0).domain == (1e-5, 1e100)
    assert aggregate(PowerMean(exponent=1.0), [-3.0, 1.0]) == -1.0
