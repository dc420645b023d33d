"""Weighted means of the sorted scores: the paper's, and the ordered weighted average."""

from __future__ import annotations

import math
from collections.abc import Mapping
from types import MappingProxyType
from typing import ClassVar

import attrs
from attrs import validators

from evoframe import ConfigurationError, Scores
from evoframe_aggregators.scores import LARGEST, ascending, between, counted, require_one
from evoframe_aggregators.weights import (
    GENERATORS,
    PAPER_WEIGHTS,
    GeneratorName,
    generated_weights,
    require_weights,
)

__all__ = ["OrderedWeightedAverage", "WeightedMean"]

FOLDED: Mapping[int, int] = MappingProxyType({4: 2, 6: 3, 20: 10})
"""Number of collaborators that ``fold`` accepts -> number of values after folding."""


@attrs.frozen
class WeightedMean:
    """Weighted mean of the sorted scores (WM of the paper, arXiv 2510.24510).

    The scores, in descending order, are multiplied by *weights* and summed, so an individual is rewarded for
    its best pairs. One score is its own mean.

    Attributes:
        weights: One non-negative weight for each collaborator, that of the largest score first; their sum
            is 1. Or a generator for any number of collaborators: ``geometric`` is closest to the paper's
            table; for others, and their parameters, see ``owa``. By default, those of the paper's table for
            2, 3, 5, 7 or 10 collaborators.
        fold: Also accept 4, 6 and 20 collaborators, by the rule in the authors' code: adjacent sorted scores
            are averaged two by two, and the 2, 3 or 10 averages are weighted by the paper's table.
    """

    weights: tuple[float, ...] | GeneratorName | None = attrs.field(default=None, validator=require_weights)
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
        require_one("wm", n)
        self._weights(n)

    def aggregate(self, scores: Scores) -> float:
        """Return the weighted mean of *scores*."""
        values = ascending(scores)[::-1]
        weights = self._weights(len(values))
        if len(weights) < len(values):
            values = [
                (larger + smaller) / 2 for larger, smaller in zip(values[::2], values[1::2], strict=True)
            ]
        return _weighted(weights, values)

    def _weights(self, n: int) -> tuple[float, ...]:
        """Return the weights for *n* scores; with ``fold``, for the averages that replace them."""
        if self.weights is not None:
            return _chosen("wm", self.weights, n)
        if n == 1:
            return (1.0,)
        weights = PAPER_WEIGHTS.get(FOLDED.get(n, n) if self.fold else n)
        if weights is None:
            paper = ", ".join(str(count) for count in PAPER_WEIGHTS)
            advice = ", or aggregator.fold = true" if n in FOLDED else ""
            raise ConfigurationError(
                f"wm has no weights for {counted(n, 'collaborator')} (the paper gives {paper}); "
                f'set aggregator.weights = "geometric" (for any number) or a list of weights{advice}'
            )
        return weights


@attrs.frozen
class OrderedWeightedAverage:
    """Ordered weighted average of the scores (OWA operator, Yager 1988).

    The scores, in descending order, are multiplied by *weights* and summed: (1, 0, ..., 0) is the largest
    score, (0, ..., 0, 1) the smallest, and equal weights are the arithmetic mean. Source: "On ordered
    weighted averaging aggregation operators in multicriteria decisionmaking" (IEEE Transactions on Systems,
    Man, and Cybernetics, 1988).

    Attributes:
        weights: One non-negative weight for each collaborator, that of the largest score first; their sum
            is 1. Or a generator for any number of collaborators: ``geometric`` (each weight is *parameter*
            times the one before), ``rank-reciprocal`` (1 / rank**parameter), ``rank-exponent``
            ((n + 1 - rank)**parameter), ``quantifier`` ((rank/n)**parameter - ((rank-1)/n)**parameter),
            ``centroid`` (rank-order centroid).
        parameter: Parameter of the generator, >= 0. By default 2/3 for ``geometric``, which is closest to the
            weights of the paper, 1 for ``rank-reciprocal`` and ``rank-exponent``, 0.5 for ``quantifier``;
            ``centroid`` has none.
    """

    weights: tuple[float, ...] | GeneratorName = attrs.field(default="geometric", validator=require_weights)
    parameter: float | None = attrs.field(default=None, validator=validators.optional(validators.ge(0)))

    domain: ClassVar[tuple[float, float]] = (-LARGEST, LARGEST)

    @parameter.validator
    def _belongs_to_a_generator(self, _: object, parameter: float | None) -> None:
        if parameter is not None and not self._has_parameter():
            raise ValueError(
                f"the weights {self.weights} have no parameter; "
                'remove aggregator.parameter, or set aggregator.weights = "geometric"'
            )

    def check(self, n: int) -> None:
        """Require weights for *n* collaborators."""
        require_one("owa", n)
        self._weights(n)

    def aggregate(self, scores: Scores) -> float:
        """Return the ordered weighted average of *scores*."""
        values = ascending(scores)[::-1]
        return _weighted(self._weights(len(values)), values)

    def _weights(self, n: int) -> tuple[float, ...]:
        return _chosen("owa", self.weights, n, self.parameter)

    def _has_parameter(self) -> bool:
        return isinstance(self.weights, str) and GENERATORS[self.weights].parameter is not None


def _chosen(
    name: str, weights: tuple[float, ...] | GeneratorName, n: int, parameter: float | None = None
) -> tuple[float, ...]:
    """Return the given weights for *n* scores, or generate them."""
    if isinstance(weights, str):
        return generated_weights(weights, n, parameter)
    if len(weights) != n:
        raise ConfigurationError(
            f"{name} has {counted(len(weights), 'weight')} for {counted(n, 'collaborator')}; "
            'set aggregator.weights to one weight for each collaborator, or to "geometric"'
        )
    return weights


def _weighted(weights: tuple[float, ...], descending: list[float]) -> float:
    """Return the weighted mean of values in descending order."""
    mean = math.fsum(weight * value for weight, value in zip(weights, descending, strict=True))
    return between(descending[-1], mean, descending[0])
