"""Sorted scores and refusals, which all aggregators share."""

from __future__ import annotations

import math

import numpy as np

from evoframe import ConfigurationError, Scores

__all__ = ["LARGEST", "ascending", "between", "counted", "require_one"]

LARGEST = 1e100
"""Largest absolute score for which every aggregate is finite."""


def require_one(name: str, n: int) -> None:
    """Require at least one collaborator.

    Raises:
        ConfigurationError: *n* is smaller; names the aggregator.
    """
    if n < 1:
        raise ConfigurationError(f"{name} requires at least 1 collaborator, found {n}")


def ascending(scores: Scores) -> list[float]:
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


def between(smallest: float, mean: float, largest: float) -> float:
    """Return *mean* clamped to the range of the values, which rounding errors can push it out of."""
    return min(max(mean, smallest), largest)


def counted(n: int, noun: str) -> str:
    """Return a number with its noun, in the plural unless *n* is 1."""
    return f"{n} {noun}{'' if n == 1 else 's'}"
