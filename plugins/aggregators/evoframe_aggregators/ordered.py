"""Order statistics of the scores: largest, smallest, median, any quantile."""

from __future__ import annotations

import math
from typing import ClassVar

import attrs
from attrs import validators

from evoframe import Scores
from evoframe_aggregators.scores import LARGEST, ascending, between, require_one

__all__ = ["Maximum", "Median", "Minimum", "Quantile"]

NO_SIGN = 0.0
"""Turns -0.0 into 0.0, since sorting leaves both in any order."""


@attrs.frozen
class _OrderStatistic:
    """Base of the order statistics, which are defined for any scores."""

    name: ClassVar[str]
    domain: ClassVar[tuple[float, float]] = (-LARGEST, LARGEST)

    def check(self, n: int) -> None:
        """Require at least one collaborator."""
        require_one(self.name, n)


@attrs.frozen
class Maximum(_OrderStatistic):
    """Largest score: *optimistic* credit (Wiegand, Liles, De Jong 2001).

    An individual is judged by its best collaborator alone. In "An empirical analysis of collaboration methods
    in cooperative coevolutionary algorithms" (GECCO 2001), it was the best of
    maximum, mean and minimum.
    """

    name = "max"

    def aggregate(self, scores: Scores) -> float:
        """Return the largest of *scores*."""
        return ascending(scores)[-1] + NO_SIGN


@attrs.frozen
class Minimum(_OrderStatistic):
    """Smallest score: *pessimistic* credit (Wiegand, Liles, De Jong 2001).

    An individual is judged by its worst collaborator alone, so it must suit all of them. Source: "An
    empirical analysis of collaboration methods in cooperative coevolutionary algorithms" (GECCO 2001).
    """

    name = "min"

    def aggregate(self, scores: Scores) -> float:
        """Return the smallest of *scores*."""
        return ascending(scores)[0] + NO_SIGN


@attrs.frozen
class Median(_OrderStatistic):
    """Median of the scores: the middle one, or the mean of the two in the middle.

    Fewer than half of the scores cannot move it beyond the others, however extreme they are (Huber, Robust
    Statistics, 1981).
    """

    name = "median"

    def aggregate(self, scores: Scores) -> float:
        """Return the median of *scores*."""
        return _quantile(ascending(scores), 0.5)


@attrs.frozen
class Quantile(_OrderStatistic):
    """Quantile of the scores, by linear interpolation between neighbors.

    Definition 7 of Hyndman and Fan, "Sample quantiles in statistical packages" (The American Statistician,
    1996), which is also numpy's: of n sorted scores, the one at the position ``(n - 1) * q``, from 0.

    Attributes:
        q: From 0 (smallest score) to 1 (largest score); 0.5 is the median.
    """

    q: float = attrs.field(default=0.75, validator=[validators.ge(0), validators.le(1)])

    name = "quantile"

    def aggregate(self, scores: Scores) -> float:
        """Return the quantile *q* of *scores*."""
        return _quantile(ascending(scores), self.q)


def _quantile(values: list[float], q: float) -> float:
    """Return the quantile *q* of ascending *values*."""
    position = (len(values) - 1) * q
    below = math.floor(position)
    lower, upper = values[below], values[math.ceil(position)]
    share = position - below
    return between(lower, (1 - share) * lower + share * upper, upper) + NO_SIGN
