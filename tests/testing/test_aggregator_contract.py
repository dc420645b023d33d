import math
import statistics
from collections.abc import Callable
from types import MappingProxyType
from typing import Any, ClassVar

import attrs
import numpy as np
import pytest
from contracts import name_of

from evoframe import ConfigurationError, Scores
from evoframe.testing import AggregatorContract

COUNTS = "test_numbers_of_collaborators_are_refused_by_a_configuration_error"
FINITE = "test_the_result_is_finite"
ORDER = "test_the_order_of_the_scores_is_irrelevant"
NOT_CHANGED = "test_the_scores_are_not_changed"
BOUNDED = "test_the_result_lies_within_the_scores"
IDEMPOTENT = "test_equal_scores_give_that_score"
MONOTONE = "test_the_result_does_not_fall_when_a_score_rises"
EXEMPTIONS = "test_exemptions_name_a_law_and_a_reason"
EXEMPTIBLE = {"bounded": BOUNDED, "idempotent": IDEMPOTENT, "monotone": MONOTONE}


@attrs.frozen
class Median:
    """A valid aggregator, and the base of the broken ones."""

    domain: ClassVar[tuple[float, float]] = (-1e100, 1e100)

    def check(self, n: int) -> None:
        if n < 1:
            raise ConfigurationError(f"at least 1 collaborator, not {n}")

    def aggregate(self, scores: Scores) -> float:
        return float(statistics.median(scores.tolist()))


class EvenMedian(Median):
    def check(self, n: int) -> None:
        if n < 1 or n % 2:
            raise ConfigurationError(f"an even number of collaborators, not {n}")


class TestMedian(AggregatorContract):
    component = Median()


class TestEvenMedian(AggregatorContract):
    component = EvenMedian()


class First(Median):
    def aggregate(self, scores: Scores) -> float:
        return float(scores[0])


class UnsortedMean(Median):
    """Depends on the order of the scores in its last bit only."""

    def aggregate(self, scores: Scores) -> float:
        total = 0.0
        for score in scores.tolist():  # not sum(), which compensates rounding from Python 3.12 on
            total += score / len(scores)
        return total


class Product(Median):
    def aggregate(self, scores: Scores) -> float:
        return float(math.prod(sorted(scores.tolist())))


class SortsInPlace(Median):
    def aggregate(self, scores: Scores) -> float:
        scores.sort()
        return super().aggregate(scores)


class Sum(Median):
    def aggregate(self, scores: Scores) -> float:
        return float(np.sort(scores).sum())


class Pessimist(Median):
    """Deviates by slightly more than rounding errors."""

    def aggregate(self, scores: Scores) -> float:
        return float(scores.min()) * (1 - 1e-11)


class RiskAverse(Median):
    """Falls when one score rises above the others."""

    def aggregate(self, scores: Scores) -> float:
        values = np.sort(scores)
        return float(values.mean() - values.std())


class Integer(Median):
    def aggregate(self, scores: Scores) -> Any:
        return int(super().aggregate(scores))


class AcceptsNothing(Median):
    def check(self, n: int) -> None:
        raise ConfigurationError(f"not {n}")


class AcceptsZero(Median):
    def check(self, n: int) -> None:
        pass


class RefusesWithoutAMessage(Median):
    def check(self, n: int) -> None:
        if n < 1:
            raise ConfigurationError


class RefusesWithAnotherError(Median):
    def check(self, n: int) -> None:
        if n < 1:
            raise ValueError(n)


class UpsideDown(Median):
    domain = (1.0, 0.0)


@pytest.mark.parametrize(
    ("component", "law"),
    [
        (First(), ORDER),
        (UnsortedMean(), ORDER),
        (Product(), FINITE),
        (Integer(), FINITE),
        (SortsInPlace(), NOT_CHANGED),
        (Sum(), BOUNDED),
        (Sum(), IDEMPOTENT),
        (Pessimist(), BOUNDED),
        (Pessimist(), IDEMPOTENT),
        (RiskAverse(), MONOTONE),
        (AcceptsNothing(), COUNTS),
        (AcceptsZero(), COUNTS),
        (RefusesWithoutAMessage(), COUNTS),
        (UpsideDown(), "test_the_domain_is_a_range"),
    ],
    ids=name_of,
)
def test_a_broken_aggregator_is_caught(component: Any, law: str, breaks: Callable[..., None]) -> None:
    breaks(AggregatorContract, component, law)


def test_a_refusal_by_another_error_is_caught(breaks: Callable[..., None]) -> None:
    breaks(AggregatorContract, RefusesWithAnotherError(), COUNTS, error=ValueError)


class LawfulOnItsDomain(Median):
    """Breaks every law for negative scores, but none for positive ones."""

    domain = (0.0, 1e100)

    def aggregate(self, scores: Scores) -> float:
        median = super().aggregate(scores)
        return median if scores.min() >= 0 else abs(median) + 1


class TestLawfulOnItsDomain(AggregatorContract):
    component = LawfulOnItsDomain()


class Exempt(Sum):
    exempt_from = MappingProxyType({"bounded": "it is a sum", "idempotent": "it is a sum"})


class TestExempt(AggregatorContract):
    component = Exempt()


@pytest.mark.parametrize(("exemption", "law"), EXEMPTIBLE.items())
def test_an_exemption_without_a_reason_is_caught(
    exemption: str, law: str, breaks: Callable[..., None]
) -> None:
    class Silent(Median):
        exempt_from = MappingProxyType({exemption: " "})

    breaks(AggregatorContract, Silent(), EXEMPTIONS)
    breaks(AggregatorContract, Silent(), law)


def test_an_exemption_from_another_law_is_caught(breaks: Callable[..., None]) -> None:
    class Confused(Median):
        exempt_from = MappingProxyType({"finite": "why not"})

    breaks(AggregatorContract, Confused(), EXEMPTIONS)
