"""Comparison of measurements that are made in turns (A B A B), by the ratios of neighbors."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Mapping, Sequence
from typing import TypeVar

import attrs
import numpy as np

__all__ = ["Ratio", "alternated", "ratio"]

K = TypeVar("K")
T = TypeVar("T")


@attrs.frozen
class Ratio:
    """Ratios of neighboring measurements.

    Attributes:
        median: Their median.
        lower: Their lower quartile.
        upper: Their upper quartile.
    """

    median: float
    lower: float
    upper: float


def alternated(measures: Mapping[K, Callable[[], T]], rounds: int) -> dict[K, list[T]]:
    """Return *rounds* measurements of each kind, made in turns."""
    taken: dict[K, list[T]] = {key: [] for key in measures}
    for _ in range(rounds):
        for key, measure in measures.items():
            taken[key].append(measure())
    return taken


def ratio(first: Sequence[float], second: Sequence[float]) -> Ratio:
    """Summarize the ratios *second* / *first* of all neighbors in a session A B A B.

    Each measurement of *second* is compared with the one of *first* before it and with the one after it, so
    that a steady change of the machine's speed cancels out.
    """
    in_order = itertools.chain.from_iterable(zip(first, second, strict=True))
    neighbors = enumerate(itertools.pairwise(in_order))
    ratios = [after / before if index % 2 == 0 else before / after for index, (before, after) in neighbors]
    lower, median, upper = np.percentile(ratios, [25.0, 50.0, 75.0]).tolist()
    return Ratio(median, lower, upper)
