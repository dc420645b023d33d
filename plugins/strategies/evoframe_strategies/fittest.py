"""Strategies that choose by fitness: the best, the worst, both, and the best of each species."""

from __future__ import annotations

from collections.abc import Sequence

import attrs
import numpy as np
from attrs import validators

from evoframe import Member
from evoframe_strategies.ranking import ChooseN, Indices, as_indices, available, best_first, worst_first

__all__ = ["All", "BestAndWorst", "Fittest", "SpeciesChampions", "Worst"]


@attrs.frozen
class Fittest(ChooseN):
    """The *n* fittest members, the fittest first (the strategy of the paper, arXiv 2510.24510).

    Attributes:
        n: Number of collaborators.
    """

    def select(self, members: Sequence[Member], rng: np.random.Generator) -> Indices:  # noqa: ARG002
        """Return the indices of the fittest *members*; *rng* is not used."""
        return as_indices(best_first(members)[: self.size(len(members))])


@attrs.frozen
class Worst(ChooseN):
    """The *n* least fit members, the worst first (by the authors of arXiv 2510.24510).

    Attributes:
        n: Number of collaborators.
    """

    def select(self, members: Sequence[Member], rng: np.random.Generator) -> Indices:  # noqa: ARG002
        """Return the indices of the least fit *members*; *rng* is not used."""
        return as_indices(worst_first(members)[: self.size(len(members))])


@attrs.frozen
class BestAndWorst:
    """The *n* fittest members, then the *n* worst of the rest (by the authors of arXiv 2510.24510).

    Attributes:
        n: Half the number of collaborators.
    """

    n: int = attrs.field(default=2, validator=validators.ge(1))

    def size(self, n_members: int) -> int:
        """Return twice *n*; require a population of at least that many members."""
        return available(self.n, n_members, times=2)

    def select(self, members: Sequence[Member], rng: np.random.Generator) -> Indices:  # noqa: ARG002
        """Return the indices of the fittest and the least fit *members*; *rng* is not used."""
        self.size(len(members))
        best = best_first(members)[: self.n]
        rest = [index for index in worst_first(members) if index not in best]
        return as_indices(best + rest[: self.n])


@attrs.frozen
class All:
    """All members, in their order: round robin, or complete mixing.

    The number of simulations in a turn is the product of the population sizes. Source: Wiegand, Liles and
    De Jong 2001, "An empirical analysis of collaboration methods in cooperative coevolutionary algorithms",
    GECCO: the largest size of the collaboration pool.
    """

    def size(self, n_members: int) -> int:
        """Return the size of the population; require at least one member."""
        return max(available(1, n_members), n_members)

    def select(self, members: Sequence[Member], rng: np.random.Generator) -> Indices:  # noqa: ARG002
        """Return the indices of all *members*; *rng* is not used."""
        return np.arange(self.size(len(members)), dtype=np.intp)


@attrs.frozen
class SpeciesChampions(ChooseN):
    """The fittest member of each species, the best species first, up to *n*.

    If there are fewer species than *n*, the fittest other members follow. Members of an evolver without
    species count as one species. Source: Stanley and Miikkulainen 2004, "Competitive coevolution through
    evolutionary complexification", JAIR 21: the champions of the best species of the other population.

    Attributes:
        n: Number of collaborators.
    """

    def select(self, members: Sequence[Member], rng: np.random.Generator) -> Indices:  # noqa: ARG002
        """Return the indices of champions and of the fittest other *members*; *rng* is not used."""
        size = self.size(len(members))
        ranked = best_first(members)
        champions: dict[int | None, int] = {}
        for index in ranked:
            if not members[index].diverged:
                champions.setdefault(members[index].species, index)
        return as_indices([*dict.fromkeys([*champions.values(), *ranked])][:size])
