"""The four averages of the paper: ``am``, ``wm``, ``gm``, ``hm``.

All of them sort the scores first, so the result does not depend on their order, to the last bit.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from types import MappingProxyType
from typing import ClassVar

import attrs
import numpy as np
from attrs import validators

from evoframe import Aggregator, ConfigurationError, Scores, hookimpl

__all__ = ["PAPER_WEIGHTS", "ArithmeticMean", "GeometricMean", "HarmonicMean", "WeightedMean"]

LARGEST = 1e100
"""Largest absolute score for which every average is finite."""

PAPER_WEIGHTS: Mapping[int, tuple[float, ...]] = MappingProxyType(
    {
        2: (0.6, 0.4),
        3: (0.5, 0.3, 0.2),
        5: (0.4, 0.3, 0.15, 0.1, 0.05),
        7: (0.35, 0.25, 0.15, 0.12, 0.07, 0.04, 0.02),
        10: (0.3, 0.2, 0.15, 0.12, 0.08, 0.05, 0.04, 0.03, 0.02, 0.01),
    }
)
"""Number of collaborators -> weights of the sorted scores, the largest score first (the paper's table)."""

FOLDED: Mapping[int, int] = MappingProxyType({4: 2, 6: 3, 20: 10})
"""Number of collaborators that ``fold`` accepts -> number of values after folding."""


@hookimpl
def evoframe_aggregators() -> Mapping[str, type[Aggregator]]:
    """Register the averages of the paper."""
    return {"am": ArithmeticMean, "wm": WeightedMean, "gm": GeometricMean, "hm": HarmonicMean}


@attrs.frozen
class ArithmeticMean:
    """Arithmetic mean of the scores (AM of the paper, arXiv 2510.24510)."""

    domain: ClassVar[tuple[float, float]] = (-LARGEST, LARGEST)

    def check(self, n: int) -> None:
        """Require at least one collaborator."""
        _require_one("am", n)

    def aggregate(self, scores: Scores) -> float:
        """Return the sum of *scores*, rounded once, divided by their number."""
        values = _ascending(scores)
        return math.fsum(values) / len(values)


def _sum_to_one(_: object, __: object, weights: tuple[float, ...]) -> None:
    if not weights:
        raise ValueError("expected at least one weight, found none")
    for weight in weights:
        if not weight >= 0:
            raise ValueError(f"expected non-negative weights, found {weight}")
    total = math.fsum(weights)
    if not abs(total - 1) <= 1e-12:
        raise ValueError(f"expected weights that sum to 1, found the sum {total:.15g}")


@attrs.frozen
class WeightedMean:
    """Weighted mean of the sorted scores (WM of the paper, arXiv 2510.24510).

    The scores, in descending order, are multiplied by *weights* and summed, so an individual is rewarded for
    its best pairs.

    Attributes:
        weights: One non-negative weight for each collaborator, that of the largest score first; their sum
            is 1. By default, those of the paper's table for 2, 3, 5, 7 or 10 collaborators.
        fold: Also accept 4, 6 and 20 collaborators, by the rule in the authors' code: adjacent sorted scores
            are averaged two by two, and the 2, 3 or 10 averages are weighted by the paper's table.
    """

    weights: tuple[float, ...] | None = attrs.field(default=None, validator=validators.optional(_sum_to_one))
    fold: bool = attrs.field(default=False)

    domain: ClassVar[tuple[float, float]] = (-LARGEST, LARGEST)

    @fold.validator
    def _requires_the_table(self, _: object, fold: bool) -> None:
        if fold and self.weights is not None:
            raise ValueError(
                "fold requires the paper's weights; remove either aggregator.weights or aggregator.fold"
            )

    def check(self, n: int) -> None:
        """Require weights for *n* collaborators."""
        _require_one("wm", n)
        self._weights(n)

    def aggregate(self, scores: Scores) -> float:
        """Return the weighted mean of *scores*."""
        values = _ascending(scores)[::-1]
        weights = self._weights(len(values))
        if len(weights) < len(values):
            values = [
                (larger + smaller) / 2 for larger, smaller in zip(values[::2], values[1::2], strict=True)
            ]
        mean = math.fsum(weight * value for weight, value in zip(weights, values, strict=True))
        return _between(values[-1], mean, values[0])

    def _weights(self, n: int) -> tuple[float, ...]:
        """Return the weights for *n* scores; with ``fold``, for the averages that replace them."""
        if self.weights is not None:
            if len(self.weights) != n:
                raise ConfigurationError(
                    f"wm has {_count(len(self.weights), 'weight')} for {_count(n, 'collaborator')}; "
                    "set aggregator.weights to one weight for each collaborator"
                )
            return self.weights
        weights = PAPER_WEIGHTS.get(FOLDED.get(n, n) if self.fold else n)
        if weights is None:
            paper = ", ".join(str(count) for count in PAPER_WEIGHTS)
            advice = " or aggregator.fold = true" if n in FOLDED else ""
            raise ConfigurationError(
                f"wm has no weights for {_count(n, 'collaborator')} (the paper gives {paper}); "
                f"set aggregator.weights{advice}"
            )
        return weights


@attrs.frozen
class _PositiveMean:
    """Base of the two averages that are defined for positive scores only."""

    floor: float = attrs.field(default=1e-5, validator=[validators.gt(0), validators.le(LARGEST)])
    clip: bool = False

    name: ClassVar[str]

    @property
    def domain(self) -> tuple[float, float]:
        """Range of the scores that are used unchanged."""
        return self.floor, LARGEST

    def check(self, n: int) -> None:
        """Require at least one collaborator."""
        _require_one(self.name, n)

    def _values(self, scores: Scores) -> list[float]:
        """Return the sorted *scores*, those not positive (with *clip*: below *floor*) replaced by *floor*."""
        least = self.floor if self.clip else 0.0
        return sorted(value if value > least else self.floor for value in _ascending(scores))


@attrs.frozen
class GeometricMean(_PositiveMean):
    """Geometric mean of the scores (GM of the paper, arXiv 2510.24510).

    As in the authors' code, *floor* replaces every score that is not positive, but positive scores below
    *floor* are unchanged: a score of 1e-6 counts less than one of -1.

    Attributes:
        floor: Value that replaces every score that is not positive, in the objective's unit.
        clip: Raise positive scores below *floor* to *floor* too, so that a greater score never counts less.
    """

    name = "gm"

    def aggregate(self, scores: Scores) -> float:
        """Return the exponential of the mean logarithm of *scores*."""
        values = self._values(scores)
        mean = math.exp(math.fsum(math.log(value) for value in values) / len(values))
        return _between(values[0], mean, values[-1])


@attrs.frozen
class HarmonicMean(_PositiveMean):
    """Harmonic mean of the scores (HM of the paper, arXiv 2510.24510).

    Scores that are not positive are treated as in :class:`GeometricMean`.

    Attributes:
        floor: Value that replaces every score that is not positive, in the objective's unit.
        clip: Raise positive scores below *floor* to *floor* too, so that a greater score never counts less.
    """

    name = "hm"

    def aggregate(self, scores: Scores) -> float:
        """Return the reciprocal of the mean reciprocal of *scores*."""
        values = self._values(scores)
        # In units of the smallest value no reciprocal exceeds 1, so nothing overflows, not even 1/5e-324.
        smallest = values[0]
        mean = smallest * (len(values) / math.fsum(smallest / value for value in values))
        return _between(smallest, mean, values[-1])


def _require_one(name: str, n: int) -> None:
    if n < 1:
        raise ConfigurationError(f"{name} requires at least 1 collaborator, found {n}")


def _ascending(scores: Scores) -> list[float]:
    """Return *scores* in ascending order, as Python floats.

    Raises:
        ValueError: *scores* is empty, or one of them is not finite.
    """
    values: list[float] = np.sort(np.asarray(scores, dtype=np.float64)).tolist()
    if not values:
        raise ValueError("expected at least one score, found none")
    for value in (values[0], values[-1]):  # sorting puts infinities at the ends, and NaN at the last place
        if not math.isfinite(value):
            raise ValueError(f"expected finite scores, found {value}")
    return values


def _between(smallest: float, mean: float, largest: float) -> float:
    """Return *mean* clamped to the range of the values, which rounding errors can push it out of."""
    return min(max(mean, smallest), largest)


def _count(n: int, noun: str) -> str:
    return f"{n} {noun}{'' if n == 1 else 's'}"
