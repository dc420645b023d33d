"""Strategies that choose individuals of earlier generations: the hall of fame and the previous generation."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import attrs
import numpy as np
from attrs import validators

from evoframe import Archived, Choice, CollaborationRun, Member, ScoredMeetings, structure
from evoframe_strategies.memory import (
    CommonRun,
    Genome,
    completed,
    current,
    document,
    first_choice,
    found_in,
    unique_ids,
)
from evoframe_strategies.ranking import ChooseN, Indices, best_first

__all__ = ["HallOfFame", "Previous"]


@attrs.frozen
class HallOfFame(ChooseN):
    """*n* champions of the other population's generations, drawn at random without repeats.

    The champion of a generation is its fittest member without a diverged simulation. While there are fewer
    than *n* champions, the fittest members complete the choice. Source: Rosin and Belew 1997, "New methods
    for competitive coevolution", Evolutionary Computation 5(1), section on the hall of fame; there, the
    archive is not limited.

    Attributes:
        n: Number of collaborators.
        capacity: Number of champions kept, the latest ones; each is stored with its genome in every turn.
    """

    capacity: int = attrs.field(default=100, validator=validators.ge(1))

    def select(self, members: Sequence[Member], rng: np.random.Generator) -> Indices:
        """Return the indices of the fittest *members*, as before there is a champion."""
        return first_choice(self.start("", ""), members, rng)

    def start(self, population: str, other: str) -> CollaborationRun:  # noqa: ARG002
        """Start with an empty archive of champions of *other*."""
        return _HallOfFameRun(self, other)


@attrs.frozen
class _SavedHall:
    champions: tuple[Archived, ...] = attrs.field(validator=unique_ids)


class _HallOfFameRun(CommonRun):
    def __init__(self, strategy: HallOfFame, other: str) -> None:
        super().__init__(other)
        self._strategy = strategy
        self._champions: list[Archived] = []

    def choice(self, members: Sequence[Member], rng: np.random.Generator) -> list[Choice]:
        size = self._strategy.size(len(members))
        known = found_in(self._champions, members)
        drawn = rng.permutation(len(known))[:size] if known else ()
        return completed([known[place] for place in drawn], members, size)

    def observe(self, meetings: ScoredMeetings, genome: Genome) -> None:
        """Add the champion of the current generation; an earlier entry of the same individual is dropped."""
        members = current(meetings, self.other)
        best = best_first(members)[0]
        champion = members[best]
        if champion.diverged:
            return
        others = [one for one in self._champions if one.member.id != champion.id]
        self._champions = [*others, Archived(champion, genome(best))][-self._strategy.capacity :]

    def state(self) -> Any:
        return {"champions": document(self._champions)}

    def restore(self, state: Any) -> None:
        self._champions = list(structure(state, _SavedHall, ("state",)).champions)


@attrs.frozen
class Previous(ChooseN):
    """The *n* fittest of the other population's previous generation, the fittest first.

    They have the fitness that they had in that generation. Before there is one, and in place of members with
    a diverged simulation, the fittest current members are chosen. In a sequential run, ``fittest`` chooses
    from the last generation that was evaluated; this strategy chooses from the one before. Sources: Potter
    and De Jong 1994, "A cooperative coevolutionary approach to function optimization", PPSN III; Luke et al.,
    ECJ, ``ec.coevolve.MultiPopCoevolutionaryEvaluator`` (collaborators from the previous generation).

    Attributes:
        n: Number of collaborators.
    """

    def select(self, members: Sequence[Member], rng: np.random.Generator) -> Indices:
        """Return the indices of the fittest *members*, as before there is a previous generation."""
        return first_choice(self.start("", ""), members, rng)

    def start(self, population: str, other: str) -> CollaborationRun:  # noqa: ARG002
        """Start without a previous generation of *other*."""
        return _PreviousRun(self, other)


@attrs.frozen
class _Generations:
    """The memory of a run.

    Attributes:
        members: The current generation, by which the next one is recognized.
        fittest: Its fittest members.
        previous: The fittest members of the generation before.
    """

    members: tuple[Member, ...] = ()
    fittest: tuple[Archived, ...] = attrs.field(default=(), validator=unique_ids)
    previous: tuple[Archived, ...] = attrs.field(default=(), validator=unique_ids)


class _PreviousRun(CommonRun):
    def __init__(self, strategy: Previous, other: str) -> None:
        super().__init__(other)
        self._strategy = strategy
        self._memory = _Generations()

    def choice(self, members: Sequence[Member], rng: np.random.Generator) -> list[Choice]:  # noqa: ARG002
        preferred = found_in(self._memory.previous, members)
        return completed(preferred, members, self._strategy.size(len(members)))

    def observe(self, meetings: ScoredMeetings, genome: Genome) -> None:
        """Remember a new generation; members and fitness stay the same while others are evaluated."""
        members = current(meetings, self.other)
        if members == self._memory.members:
            return
        best = [index for index in best_first(members) if not members[index].diverged]
        fittest = tuple(Archived(members[index], genome(index)) for index in best[: self._strategy.n])
        self._memory = _Generations(members, fittest, self._memory.fittest)

    def state(self) -> Any:
        memory = self._memory
        return {
            "members": [attrs.asdict(member) for member in memory.members],
            "fittest": document(memory.fittest),
            "previous": document(memory.previous),
        }

    def restore(self, state: Any) -> None:
        self._memory = structure(state, _Generations, ("state",))
