"""Pairs of compared groups: look-up, orientation, and rankings in the paper's notation."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterable, Sequence
from typing import Protocol, Self, TypeVar

__all__ = ["Pair", "find_pair", "format_ranking", "orient"]


class Pair(Protocol):
    """Comparison of two groups."""

    @property
    def first(self) -> str:
        """Name of the first group."""

    @property
    def second(self) -> str:
        """Name of the second group."""

    @property
    def p(self) -> float:
        """The p-value."""

    @property
    def direction(self) -> int:
        """1 if the first group is the greater one in the test, -1 if the second is, 0 if neither."""

    def turned(self) -> Self:
        """Return the comparison with the two groups swapped."""


P = TypeVar("P", bound=Pair)


def find_pair(pairs: Iterable[P], first: str, second: str) -> P:
    """Return the comparison of *first* and *second*, swapped if *pairs* has it in the other order.

    Raises:
        KeyError: *pairs* does not have the two groups.
    """
    for pair in pairs:
        if (pair.first, pair.second) == (first, second):
            return pair
        if (pair.first, pair.second) == (second, first):
            return pair.turned()
    raise KeyError(f"{first}, {second}")


def format_ranking(names: Sequence[str], pair: Callable[[str, str], Pair], alpha: float) -> str:
    """Return a ranking in the paper's notation; each sign compares only its two neighbors.

    ``>`` means a significant difference, ``=`` none. If the groups are sorted by a different measure than the
    test uses, ``<`` marks a significant difference in the opposite direction.

    Args:
        names: Names from the greatest group to the smallest.
        pair: Returns the comparison of two groups.
        alpha: Significance level.
    """
    parts = [names[0]]
    for one, other in itertools.pairwise(names):
        found = pair(one, other)
        sign = "=" if found.p >= alpha else ">" if found.direction > 0 else "<"
        parts += [sign, other]
    return " ".join(parts)


def orient(pair: P) -> P:
    """Return a pair with the greater group first, as measured by the test."""
    return pair.turned() if pair.direction < 0 else pair
