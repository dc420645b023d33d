"""A third-party strategy that chooses for each individual: ``strangers``."""

from collections import Counter
from collections.abc import Mapping, Sequence

import attrs
import numpy as np
from attrs import validators
from numpy.typing import NDArray

from evoframe import CollaborationStrategy, ConfigurationError, Judged, Member, hookimpl


@attrs.frozen
class Strangers:
    """Members that an individual did not meet in its last evaluation, of as many species as possible.

    A young individual keeps its collaborators instead, as far as they are members still, so that its first
    values of fitness can be compared. In either case, the fittest members of different species come first.

    Attributes:
        n: Number of collaborators.
        settle: Age up to which an individual keeps its collaborators, turns of its population.
    """

    n: int = attrs.field(default=2, validator=validators.ge(1))
    settle: int = attrs.field(default=1, validator=validators.ge(0))

    def size(self, n_members: int) -> int:
        if self.n > n_members:
            raise ConfigurationError(
                f"{self.n} strangers requested, but the population has {n_members} members; "
                f"set collaboration.n to {n_members} or less"
            )
        return self.n

    def select(self, members: Sequence[Member], rng: np.random.Generator) -> NDArray[np.intp]:
        """Return the choice of an individual that has met nobody."""
        return self._chosen(Judged(Member(id=0, fitness=None), index=0), members)

    def select_each(
        self, judged: Sequence[Judged], members: Sequence[Member], rng: np.random.Generator
    ) -> NDArray[np.intp]:
        rows = [self._chosen(individual, members) for individual in judged]
        return np.array(rows, dtype=np.intp).reshape(len(judged), self.size(len(members)))

    def _chosen(self, individual: Judged, members: Sequence[Member]) -> NDArray[np.intp]:
        keeps = individual.member.age <= self.settle
        places = _places_in_species(members)

        def rank(index: int) -> tuple[bool, bool, int, float, int]:
            member = members[index]
            is_known = member.id in individual.collaborators
            return member.diverged, is_known != keeps, places[index], _loss(member), index

        order = sorted(range(len(members)), key=rank)
        return np.array(order[: self.size(len(members))], dtype=np.intp)


def _places_in_species(members: Sequence[Member]) -> dict[int, int]:
    """Return how many fitter members of its species each member has."""
    counts: Counter[int | None] = Counter()
    places = {}
    for index in sorted(range(len(members)), key=lambda i: (members[i].diverged, _loss(members[i]), i)):
        species = members[index].species
        places[index] = counts[species]
        counts[species] += 1
    return places


def _loss(member: Member) -> float:
    return np.inf if member.fitness is None else -member.fitness


@hookimpl
def evoframe_strategies() -> Mapping[str, type[CollaborationStrategy]]:
    return {"strangers": Strangers}
