"""Arithmetic, geometric and harmonic mean, and the power mean, of which they are special cases."""

from __future__ import annotations

import math
from typing import ClassVar

import attrs
from attrs import validators

from evoframe import Scores
from evoframe_aggregators.scores import LARGEST, ascending, between, require_one

__all__ = ["ArithmeticMean", "GeometricMean", "HarmonicMean", "PowerMean"]

NEGLIGIBLE = 1e-22
"""Absolute exponent below which power and geometric mean of floats differ by less than a rounding error."""


@attrs.frozen
class ArithmeticMean:
    """Arithmetic mean of the scores (AM of the paper, arXiv 2510.24510)."""

    domain: ClassVar[tuple[float, float]] = (-LARGEST, LARGEST)

    def check(self, n: int) -> None:
        """Require at least one collaborator."""
        require_one("am", n)

    def aggregate(self, scores: Scores) -> float:
        """Return the sum of *scores*, rounded once, divided by their number."""
        values = ascending(scores)
        return math.fsum(values) / len(values)


@attrs.frozen
class _PositiveMean:
    """Base of the means that are defined for positive scores only."""

    floor: float = attrs.field(default=1e-5, validator=[validators.gt(0), validators.le(LARGEST)])
    clip: bool = False

    name: ClassVar[str]

    @property
    def domain(self) -> tuple[float, float]:
        """Range of the scores that are used unchanged."""
        return self.floor, LARGEST

    def check(self, n: int) -> None:
        """Require at least one collaborator."""
        require_one(self.name, n)

    def _values(self, scores: Scores) -> list[float]:
        """Return the sorted *scores*, those not positive (with *clip*: below *floor*) replaced by *floor*."""
        least = self.floor if self.clip else 0.0
        return sorted(value if value > least else self.floor for value in ascending(scores))


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
        return between(values[0], mean, values[-1])


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
        return between(smallest, mean, values[-1])


@attrs.frozen
class PowerMean(_PositiveMean):
    """Power mean of the scores, ``(mean of score**exponent) ** (1 / exponent)`` (Hölder 1889).

    The larger the exponent, the more the best scores count: -1 is the harmonic, 0 the geometric and 1 the
    arithmetic mean, bit for bit (``hm``, ``gm``, ``am``). Towards infinity it becomes the largest score
    (``max``), towards minus infinity the smallest (``min``); an exponent of 1e300 or -1e300 is that limit.
    Source: Bullen, Handbook of Means and Their Inequalities, 2003, chapter III.

    Any exponent but 1 requires positive scores; others are treated as in :class:`GeometricMean`.

    Attributes:
        exponent: Any finite number.
        floor: Value that replaces every score that is not positive, in the objective's unit; not used by
            exponent 1.
        clip: Raise positive scores below *floor* to *floor* too, so that a greater score never counts less.
    """

    exponent: float = attrs.field(default=2.0)

    name = "power"

    @exponent.validator
    def _is_finite(self, _: object, exponent: float) -> None:
        if not math.isfinite(exponent):
            raise ValueError(
                f'expected a finite exponent, found {exponent}; aggregator = "max" and "min" are the limits'
            )

    @property
    def domain(self) -> tuple[float, float]:
        """Range of the scores that are used unchanged."""
        return ArithmeticMean.domain if self.exponent == 1 else (self.floor, LARGEST)

    def aggregate(self, scores: Scores) -> float:
        """Return the power mean of *scores*."""
        if self.exponent == 1:
            return ArithmeticMean().aggregate(scores)
        if self.exponent == -1:
            return HarmonicMean(floor=self.floor, clip=self.clip).aggregate(scores)
        if abs(self.exponent) < NEGLIGIBLE:
            return GeometricMean(floor=self.floor, clip=self.clip).aggregate(scores)
        values = self._values(scores)
        return between(values[0], self._mean(values), values[-1])

    def _mean(self, values: list[float]) -> float:
        """Return the power mean of ascending positive *values*.

        In units of the value that counts most, no power exceeds 1, so nothing overflows. ``expm1`` and
        ``log1p`` keep the digits that small exponents need.
        """
        unit = values[-1] if self.exponent > 0 else values[0]
        logs = (math.log(value) - math.log(unit) for value in values)
        excess = math.fsum(math.expm1(self.exponent * log) for log in logs) / len(values)
        root = math.exp(math.log1p(excess) / self.exponent / 2)
        return unit * root * root  # not their square, which exceeds all floats if unit is the smallest float
