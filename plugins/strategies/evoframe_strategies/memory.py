"""Archives of individuals, for strategies that remember earlier turns."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import Any

import attrs
import numpy as np

from evoframe import Archived, Choice, CollaborationRun, Judged, Member, ScoredMeetings
from evoframe_strategies.ranking import Indices, as_indices, best_first

__all__ = [
    "CommonRun",
    "Genome",
    "completed",
    "current",
    "document",
    "first_choice",
    "found_in",
    "unique_ids",
]

Genome = Callable[[int], Any]
"""Returns the genome of an individual of the other population as JSON values, by its index."""

_ANYONE = Judged(Member(id=0, fitness=None), index=0)


class CommonRun:
    """Base of the runs that make one choice for all individuals.

    Attributes:
        other: Name of the population whose individuals are chosen.
    """

    def __init__(self, other: str) -> None:
        self.other = other

    def choose(
        self, judged: Sequence[Judged], members: Sequence[Member], rng: np.random.Generator
    ) -> Sequence[Sequence[Choice]]:
        """Return the same collaborators for each of *judged*."""
        return [self.choice(members, rng)] * len(judged)

    def choice(self, members: Sequence[Member], rng: np.random.Generator) -> list[Choice]:
        """Return the collaborators among *members* and archived individuals."""
        raise NotImplementedError


def first_choice(run: CollaborationRun, members: Sequence[Member], rng: np.random.Generator) -> Indices:
    """Return the indices of *members* that a new *run* chooses for an individual: it has no archive yet."""
    [row] = run.choose([_ANYONE], members, rng)
    return as_indices(choice for choice in row if not isinstance(choice, Archived))


def current(meetings: ScoredMeetings, population: str) -> tuple[Member, ...]:
    """Return the members of a population after a turn, without archived individuals."""
    place = meetings.populations.index(population)
    return meetings.members[place][: meetings.present[place]]


def found_in(archive: Iterable[Archived], members: Sequence[Member]) -> list[Choice]:
    """Return the clean individuals of an *archive* as choices: indices of those that are *members* still."""
    places = {member.id: index for index, member in enumerate(members)}
    found: list[Choice] = []
    for archived in archive:
        index = places.get(archived.member.id)
        if not (archived.member if index is None else members[index]).diverged:
            found.append(archived if index is None else index)
    return found


def completed(preferred: Sequence[Choice], members: Sequence[Member], n: int) -> list[Choice]:
    """Return the first *n* of *preferred*, completed by the fittest other *members*."""
    chosen = list(preferred[:n])
    if len(chosen) < n:
        chosen += [index for index in best_first(members) if index not in chosen][: n - len(chosen)]
    return chosen


def document(archive: Iterable[Archived]) -> list[dict[str, Any]]:
    """Return an *archive* as JSON values."""
    return [{"member": attrs.asdict(one.member), "genome": one.genome} for one in archive]


def unique_ids(_: Any, __: Any, archive: Sequence[Archived]) -> None:
    """Refuse an archive that contains an individual twice; a validator of attrs classes."""
    ids = [archived.member.id for archived in archive]
    repeated = sorted({id_ for id_ in ids if ids.count(id_) > 1})
    if repeated:
        raise ValueError(f"expected different individuals, found several with the ids {repeated}")
