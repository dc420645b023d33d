"""What tests say of pairs of groups: how one is found, and how a ranking is written."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterable, Sequence
from typing import Protocol, Self, TypeVar

__all__ = ["Pair", "find_pair", "in_notation", "oriented"]


class Pair(Protocol):
    """What is said of two groups."""

    @property
    def first(self) -> str:
        """The name of one."""

    @property
    def second(self) -> str:
        """The name of the other."""

    @property
    def p(self) -> float:
        """Of their test."""

    @property
    def direction(self) -> int:
        """1 if the first is the greater by what is tested, -1 if the second is, 0 if neither."""

    def turned(self) -> Self:
        """Return the same of the second and the first."""


P = TypeVar("P", bound=Pair)


def find_pair(pairs: Iterable[P], first: str, second: str) -> P:
    """Return what is said of two groups, whichever is the first there.

    Raises:
        KeyError: They are no pair.
    """
    for pair in pairs:
        if (pair.first, pair.second) == (first, second):
            return pair
        if (pair.first, pair.second) == (second, first):
            return pair.turned()
    raise KeyError(f"{first}, {second}")


def in_notation(names: Sequence[str], pair: Callable[[str, str], Pair], alpha: float) -> str:
    """Return a ranking as the paper writes it: between neighbours stands what their test says.

    That is ``=`` if they are not found to differ, and ``>`` if they are. Where the order is by one measure
    and the test by another, a ``<`` says that they contradict each other.

    Args:
        names: From the greatest down.
        pair: Gives the test of two of them.
        alpha: Below which p two neighbours count as different.
    """
    parts = [names[0]]
    for one, other in itertools.pairwise(names):
        found = pair(one, other)
        sign = "=" if found.p >= alpha else ">" if found.direction > 0 else "<"
        parts += [sign, other]
    return " ".join(parts)


def oriented(pair: P) -> P:
    """Return a pair with the greater one first, by what is tested."""
    return pair.turned() if pair.direction < 0 else pair
