"""Orders of members that strategies share; members with a diverged simulation are always last."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence

import attrs
import numpy as np
from attrs import validators
from numpy.typing import NDArray

from evoframe import ConfigurationError, Member

__all__ = ["ChooseN", "Indices", "as_indices", "available", "best_first", "clean_first", "worst_first"]

Indices = NDArray[np.intp]


@attrs.frozen
class ChooseN:
    """Base of the strategies that choose *n* members."""

    n: int = attrs.field(default=2, validator=validators.ge(1))

    def size(self, n_members: int) -> int:
        """Return *n*; require a population of at least *n* members."""
        return available(self.n, n_members)


def available(n: int, n_members: int, times: int = 1) -> int:
    """Return *times* x *n*; require a population of at least that many members.

    Raises:
        ConfigurationError: The population is smaller.
    """
    if n * times <= n_members:
        return n * times
    requested = str(n) if times == 1 else f"{times} x {n}"
    limit = n_members // times
    advice = f"; set collaboration.n to {limit} or less" if limit else ""
    raise ConfigurationError(
        f"{requested} collaborators requested, but the population has {n_members} members{advice}"
    )


def best_first(members: Sequence[Member]) -> list[int]:
    """Return the indices of *members*, the fittest first, ties by index.

    Raises:
        ValueError: A member has no fitness.
    """
    return _ranked(members, -1.0)


def worst_first(members: Sequence[Member]) -> list[int]:
    """Return the indices of *members*, the least fit first, ties by index.

    Raises:
        ValueError: A member has no fitness.
    """
    return _ranked(members, 1.0)


def clean_first(
    members: Sequence[Member], indices: Iterable[int], n: int, take: Callable[[list[int], int], list[int]]
) -> list[int]:
    """Take *n* of *indices*: clean members, and diverged ones only if there are fewer than *n* clean ones.

    Args:
        members: The members that *indices* refer to.
        indices: Indices to take from, at least *n*.
        n: Number of indices to take.
        take: Takes a number of different indices from a list.
    """
    pool = list(indices)
    clean = [index for index in pool if not members[index].diverged]
    taken = take(clean, min(n, len(clean)))
    if len(taken) == n:
        return taken
    diverged = [index for index in pool if members[index].diverged]
    return taken + take(diverged, n - len(taken))


def as_indices(indices: Iterable[int]) -> Indices:
    """Return *indices* as an array."""
    return np.fromiter(indices, dtype=np.intp)


def _ranked(members: Sequence[Member], sign: float) -> list[int]:
    """Return the indices of *members* by *sign* times fitness, diverged members last, ties by index."""
    ranks = []
    for index, member in enumerate(members):
        if member.fitness is None:
            raise ValueError(f"cannot rank member {member.id}: it has no fitness yet")
        if math.isnan(member.fitness):
            raise ValueError(f"cannot rank member {member.id}: its fitness is NaN")
        ranks.append((member.diverged, sign * member.fitness, index))
    return [index for _, _, index in sorted(ranks)]
