"""The four collaboration strategies: ``fittest``, ``worst``, ``best-and-worst``, ``random``.

A member with a diverged simulation is chosen only if no other member is left.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence

import attrs
import numpy as np
from attrs import validators
from numpy.typing import NDArray

from evoframe import CollaborationStrategy, ConfigurationError, Member, hookimpl

__all__ = ["BestAndWorst", "Fittest", "Random", "Worst"]

Indices = NDArray[np.intp]


@hookimpl
def evoframe_strategies() -> Mapping[str, type[CollaborationStrategy]]:
    """Register the strategies of the paper's authors."""
    return {"fittest": Fittest, "worst": Worst, "best-and-worst": BestAndWorst, "random": Random}


@attrs.frozen
class _ChooseN:
    """Base of the strategies that choose *n* members."""

    n: int = attrs.field(default=2, validator=validators.ge(1))

    def size(self, n_members: int) -> int:
        """Return *n*; require a population of at least *n* members."""
        return _available(self.n, n_members)


@attrs.frozen
class Fittest(_ChooseN):
    """The *n* fittest members, the fittest first (the strategy of the paper, arXiv 2510.24510).

    Attributes:
        n: Number of collaborators.
    """

    def select(self, members: Sequence[Member], rng: np.random.Generator) -> Indices:  # noqa: ARG002
        """Return the indices of the fittest *members*; *rng* is not used."""
        return _indices(_best_first(members)[: self.size(len(members))])


@attrs.frozen
class Worst(_ChooseN):
    """The *n* least fit members, the worst first (by the authors of arXiv 2510.24510).

    Attributes:
        n: Number of collaborators.
    """

    def select(self, members: Sequence[Member], rng: np.random.Generator) -> Indices:  # noqa: ARG002
        """Return the indices of the least fit *members*; *rng* is not used."""
        return _indices(_worst_first(members)[: self.size(len(members))])


@attrs.frozen
class BestAndWorst:
    """The *n* fittest members, then the *n* worst of the rest (by the authors of arXiv 2510.24510).

    Attributes:
        n: Half the number of collaborators.
    """

    n: int = attrs.field(default=2, validator=validators.ge(1))

    def size(self, n_members: int) -> int:
        """Return twice *n*; require a population of at least that many members."""
        return _available(self.n, n_members, times=2)

    def select(self, members: Sequence[Member], rng: np.random.Generator) -> Indices:  # noqa: ARG002
        """Return the indices of the fittest and the least fit *members*; *rng* is not used."""
        self.size(len(members))
        best = _best_first(members)[: self.n]
        rest = [index for index in _worst_first(members) if index not in best]
        return _indices(best + rest[: self.n])


@attrs.frozen
class Random(_ChooseN):
    """*n* members drawn at random, without repeats (by the authors of arXiv 2510.24510).

    Attributes:
        n: Number of collaborators.
    """

    def select(self, members: Sequence[Member], rng: np.random.Generator) -> Indices:
        """Return indices of *members*, in the order in which *rng* draws them."""
        size = self.size(len(members))
        clean = _indices(index for index, member in enumerate(members) if not member.diverged)
        drawn = rng.choice(clean, size=min(size, len(clean)), replace=False)
        if len(drawn) == size:
            return drawn
        diverged = _indices(index for index, member in enumerate(members) if member.diverged)
        return np.append(drawn, rng.choice(diverged, size=size - len(drawn), replace=False))


def _available(n: int, n_members: int, times: int = 1) -> int:
    """Return *times* x *n*; require a population of at least that many members."""
    if n * times <= n_members:
        return n * times
    requested = str(n) if times == 1 else f"{times} x {n}"
    limit = n_members // times
    advice = f"; set collaboration.n to {limit} or less" if limit else ""
    raise ConfigurationError(
        f"{requested} collaborators requested, but the population has {n_members} members{advice}"
    )


def _best_first(members: Sequence[Member]) -> list[int]:
    return _ranked(members, -1.0)


def _worst_first(members: Sequence[Member]) -> list[int]:
    return _ranked(members, 1.0)


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


def _indices(indices: Iterable[int]) -> Indices:
    return np.fromiter(indices, dtype=np.intp)
