"""The four collaboration strategies: ``fittest``, ``worst``, ``best-and-worst``, ``random``.

A member with a diverged simulation is chosen only when no clean member is left.
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
    """Offer the strategies of the paper's authors."""
    return {"fittest": Fittest, "worst": Worst, "best-and-worst": BestAndWorst, "random": Random}


@attrs.frozen
class _Some:
    """What the strategies share that choose *n* members."""

    n: int = attrs.field(default=2, validator=validators.ge(1))

    def size(self, n_members: int) -> int:
        """Return *n*, if there are so many members."""
        return _available(self.n, n_members)


@attrs.frozen
class Fittest(_Some):
    """The *n* fittest members, the fittest first (the strategy of the paper, arXiv 2510.24510).

    Attributes:
        n: Number of collaborators.
    """

    def select(self, members: Sequence[Member], rng: np.random.Generator) -> Indices:  # noqa: ARG002
        """Return the indices of the fittest *members*; *rng* is not used."""
        return _indices(_best_first(members)[: self.size(len(members))])


@attrs.frozen
class Worst(_Some):
    """The *n* least fit members, the worst first (a strategy of the paper's authors, arXiv 2510.24510).

    Attributes:
        n: Number of collaborators.
    """

    def select(self, members: Sequence[Member], rng: np.random.Generator) -> Indices:  # noqa: ARG002
        """Return the indices of the least fit *members*; *rng* is not used."""
        return _indices(_worst_first(members)[: self.size(len(members))])


@attrs.frozen
class BestAndWorst:
    """The *n* fittest members, then the *n* worst of the rest (a strategy of arXiv 2510.24510's authors).

    Attributes:
        n: Half the number of collaborators.
    """

    n: int = attrs.field(default=2, validator=validators.ge(1))

    def size(self, n_members: int) -> int:
        """Return twice *n*, if there are so many members."""
        return _available(self.n, n_members, times=2)

    def select(self, members: Sequence[Member], rng: np.random.Generator) -> Indices:  # noqa: ARG002
        """Return the indices of the fittest and the least fit *members*; *rng* is not used."""
        self.size(len(members))
        best = _best_first(members)[: self.n]
        rest = [index for index in _worst_first(members) if index not in best]
        return _indices(best + rest[: self.n])


@attrs.frozen
class Random(_Some):
    """*n* members drawn at random, without repeats (a strategy of the authors of arXiv 2510.24510).

    Attributes:
        n: Number of collaborators.
    """

    def select(self, members: Sequence[Member], rng: np.random.Generator) -> Indices:
        """Return the indices of *members* in the order in which *rng* draws them."""
        size = self.size(len(members))
        clean = _indices(index for index, member in enumerate(members) if not member.diverged)
        drawn = rng.choice(clean, size=min(size, len(clean)), replace=False)
        if len(drawn) == size:
            return drawn
        diverged = _indices(index for index, member in enumerate(members) if member.diverged)
        return np.append(drawn, rng.choice(diverged, size=size - len(drawn), replace=False))


def _available(n: int, n_members: int, times: int = 1) -> int:
    """Return *n* *times* over, unless a population has fewer members."""
    if n * times <= n_members:
        return n * times
    asked = str(n) if times == 1 else f"{times} x {n}"
    limit = n_members // times
    advice = f"; set collaboration.n to {limit} or less" if limit else ""
    raise ConfigurationError(
        f"{asked} collaborators asked for, but the population has {n_members} members{advice}"
    )


def _best_first(members: Sequence[Member]) -> list[int]:
    return _ranked(members, -1.0)


def _worst_first(members: Sequence[Member]) -> list[int]:
    return _ranked(members, 1.0)


def _ranked(members: Sequence[Member], sign: float) -> list[int]:
    """Return the indices of *members* by *sign* times fitness, those that diverged last, ties by index."""
    ranks = []
    for index, member in enumerate(members):
        if member.fitness is None:
            raise ValueError(f"member {member.id} has no fitness yet, so it cannot be ranked")
        if math.isnan(member.fitness):
            raise ValueError(f"the fitness of member {member.id} is NaN, so it cannot be ranked")
        ranks.append((member.diverged, sign * member.fitness, index))
    return [index for _, _, index in sorted(ranks)]


def _indices(indices: Iterable[int]) -> Indices:
    return np.fromiter(indices, dtype=np.intp)
