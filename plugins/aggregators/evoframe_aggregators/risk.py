"""Mean of the scores, reduced by their spread."""

from __future__ import annotations

import math
from collections.abc import Mapping
from types import MappingProxyType
from typing import ClassVar

import attrs
from attrs import validators

from evoframe import Scores
from evoframe_aggregators.scores import LARGEST, ascending, between, require_one

__all__ = ["MeanMinusDeviation"]


@attrs.frozen
class MeanMinusDeviation:
    """Mean of the scores minus *risk* times their standard deviation: risk-averse credit.

    Of two individuals with the same mean, the one that depends less on its collaborators is fitter. The trade
    of mean against deviation is that of Markowitz, "Portfolio selection" (Journal of Finance, 1952). The
    deviation is that of these scores (divisor n, not n - 1), so that of one score is 0.

    Attributes:
        risk: Aversion to risk, >= 0; 0 is the arithmetic mean.
    """

    risk: float = attrs.field(default=1.0, validator=[validators.ge(0), validators.le(LARGEST)])

    domain: ClassVar[tuple[float, float]] = (-LARGEST, LARGEST)
    exempt_from: ClassVar[Mapping[str, str]] = MappingProxyType(
        {
            "bounded": "a large deviation puts the result below the smallest score",
            "monotone": "a score that rises above the others increases the deviation more than the mean",
        }
    )

    def check(self, n: int) -> None:
        """Require at least one collaborator."""
        require_one("mean-minus-sd", n)

    def aggregate(self, scores: Scores) -> float:
        """Return the mean of *scores* minus *risk* times their standard deviation."""
        values = ascending(scores)
        mean = math.fsum(values) / len(values)
        center = between(values[0], mean, values[-1])  # so that equal scores have no deviation at all
        deviation = math.hypot(*(value - center for value in values)) / math.sqrt(len(values))
        return mean - self.risk * deviation
