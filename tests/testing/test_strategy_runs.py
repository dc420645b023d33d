"""The laws of runs, tested by strategies that violate them."""

from __future__ import annotations

import random
from collections.abc import Callable, Sequence
from typing import Any, ClassVar

import attrs
import numpy as np
import pytest

from evoframe import Archived, ConfigurationError, Judged, Member, ScoredMeetings, structure
from evoframe.testing import CollaborationStrategyContract

STARTS = "test_it_starts_a_run"
VALID = "test_a_run_chooses_members_and_archived_individuals"
DECLARED = "test_a_run_chooses_as_many_as_declared"
ONCE = "test_a_run_chooses_nobody_twice_for_an_individual"
CLEAN = "test_a_run_chooses_nobody_diverged_while_a_clean_member_is_left"
SEEN = "test_archived_genomes_are_those_that_the_run_has_seen"
SAME = "test_the_same_random_state_gives_the_same_run"
JSON = "test_a_state_is_json"
RESTORED = "test_a_restored_run_continues_bit_for_bit"
DAMAGED = "test_a_damaged_state_is_refused_by_a_value_error"

Genome = Callable[[int], Any]


def ranked(members: Sequence[Member]) -> list[int]:
    return sorted(range(len(members)), key=lambda i: (members[i].diverged, -(members[i].fitness or 0.0), i))


@attrs.frozen
class Saved:
    champion: Archived | None


class Run:
    """A valid run: the fittest clean individual of the last turn, and the fittest other member."""

    champion: Archived | None = None

    def __init__(self, other: str) -> None:
        self.other = other

    def choose(self, judged: Sequence[Judged], members: Sequence[Member], rng: np.random.Generator) -> Any:
        return [self.row(members, rng)] * len(judged)

    def row(self, members: Sequence[Member], rng: np.random.Generator) -> list[Any]:
        known = self.known(members)
        return [*known, *(index for index in ranked(members) if index not in known)][:2]

    def known(self, members: Sequence[Member]) -> list[Any]:
        if self.champion is None:
            return []
        ids = [member.id for member in members]
        if self.champion.member.id not in ids:
            return [] if self.champion.member.diverged else [self.champion]
        place = ids.index(self.champion.member.id)
        return [] if members[place].diverged else [place]

    def observe(self, meetings: ScoredMeetings, genome: Genome) -> None:
        place = meetings.populations.index(self.other)
        members = meetings.members[place][: meetings.present[place]]
        best = ranked(members)[0]
        if not members[best].diverged:
            self.champion = Archived(members[best], genome(best))

    def state(self) -> Any:
        one = self.champion
        return {"champion": one and {"member": attrs.asdict(one.member), "genome": one.genome}}

    def restore(self, state: Any) -> None:
        self.champion = structure(state, Saved, ("state",)).champion


@attrs.frozen
class Remembers:
    """A strategy with the run above, and the base of those with broken runs."""

    run: ClassVar[type[Any]] = Run

    def size(self, n_members: int) -> int:
        if n_members < 2:
            raise ConfigurationError(f"2 of {n_members} members")
        return 2

    def select(self, members: Sequence[Member], rng: np.random.Generator) -> Any:
        raise NotImplementedError

    def start(self, population: str, other: str) -> Any:
        return self.run(other)


class TestRemembers(CollaborationStrategyContract):
    component = Remembers()


def with_run(run: type[Any]) -> Any:
    """Return a strategy with a broken *run*."""
    return type(run.__name__, (Remembers,), {"run": run})()


class WithoutObserve:
    """A run that lacks a method."""

    def __init__(self, other: str) -> None: ...
    def choose(self, judged: Any, members: Any, rng: Any) -> Any: ...
    def state(self) -> Any: ...
    def restore(self, state: Any) -> None: ...


class ArchivesMembers(Run):
    def known(self, members: Sequence[Member]) -> list[Any]:
        return [self.champion] if self.champion and super().known(members) else []


class NumpyIntegers(Run):
    def row(self, members: Sequence[Member], rng: np.random.Generator) -> list[Any]:
        return [*np.array(ranked(members)[:2])]


class FromTheEnd(Run):
    def row(self, members: Sequence[Member], rng: np.random.Generator) -> list[Any]:
        return [index - len(members) for index in ranked(members)[:2]]


class OneTooMany(Run):
    def row(self, members: Sequence[Member], rng: np.random.Generator) -> list[Any]:
        return ranked(members)[:3]


class OnlyOneRow(Run):
    def choose(self, judged: Any, members: Any, rng: np.random.Generator) -> Any:
        return super().choose(judged, members, rng)[:1]


class Repeats(Run):
    def row(self, members: Sequence[Member], rng: np.random.Generator) -> list[Any]:
        return [*self.known(members), *ranked(members)][:2]


class ArchivesDiverged(Run):
    def observe(self, meetings: ScoredMeetings, genome: Genome) -> None:
        place = meetings.populations.index(self.other)
        self.champion = Archived(meetings.members[place][0], genome(0))

    def known(self, members: Sequence[Member]) -> list[Any]:
        is_member = self.champion and self.champion.member.id in {member.id for member in members}
        return [self.champion] if self.champion and not is_member else []


class KeepsDivergedMembers(Run):
    def observe(self, meetings: ScoredMeetings, genome: Genome) -> None:
        if self.champion is None:
            super().observe(meetings, genome)

    def known(self, members: Sequence[Member]) -> list[Any]:
        ids = [member.id for member in members]
        is_member = self.champion and self.champion.member.id in ids
        return [ids.index(self.champion.member.id)] if self.champion and is_member else super().known(members)


class InventsGenomes(Run):
    def observe(self, meetings: ScoredMeetings, genome: Genome) -> None:
        super().observe(meetings, lambda index: {"index": index})


class GenomesOfOthers(Run):
    def observe(self, meetings: ScoredMeetings, genome: Genome) -> None:
        super().observe(meetings, lambda index: genome((index + 1) % meetings.present[1]))


class PythonsRandom(Run):
    def row(self, members: Sequence[Member], rng: np.random.Generator) -> list[Any]:
        return random.sample(range(len(members)), 2)


class SharedMemory(Run):
    seen: ClassVar[list[int]] = []

    def row(self, members: Sequence[Member], rng: np.random.Generator) -> list[Any]:
        self.seen.append(0)
        return ranked(members)[:2] if len(self.seen) % 5 else ranked(members)[1::-1]


class TuplesInTheState(Run):
    def state(self) -> Any:
        return super().state() | {"more": (1, 2)}

    def restore(self, state: Any) -> None:
        super().restore({"champion": state["champion"]})


class Forgets(Run):
    def restore(self, state: Any) -> None:
        self.kept = state

    def state(self) -> Any:
        return getattr(self, "kept", None) or super().state()


class CountsWithoutState(Run):
    turns = 0

    def observe(self, meetings: ScoredMeetings, genome: Genome) -> None:
        self.turns += 1

    def row(self, members: Sequence[Member], rng: np.random.Generator) -> list[Any]:
        return ranked(members)[:2] if self.turns < 4 else ranked(members)[1::-1]


class TrustsStates(Run):
    def restore(self, state: Any) -> None:
        one = state["champion"]
        self.champion = one and Archived(Member(**one["member"]), one["genome"])


@pytest.mark.parametrize(
    ("run", "law"),
    [
        (WithoutObserve, STARTS),
        (ArchivesMembers, VALID),
        (NumpyIntegers, VALID),
        (FromTheEnd, VALID),
        (OneTooMany, DECLARED),
        (OnlyOneRow, DECLARED),
        (Repeats, ONCE),
        (ArchivesDiverged, CLEAN),
        (KeepsDivergedMembers, CLEAN),
        (InventsGenomes, SEEN),
        (GenomesOfOthers, SEEN),
        (PythonsRandom, SAME),
        (SharedMemory, SAME),
        (TuplesInTheState, JSON),
        (Forgets, RESTORED),
        (CountsWithoutState, RESTORED),
    ],
    ids=lambda value: getattr(value, "__name__", value),
)
def test_a_broken_run_is_caught(run: type[Any], law: str, breaks: Callable[..., None]) -> None:
    breaks(CollaborationStrategyContract, with_run(run), law)


def test_a_damaged_state_that_raises_another_error_is_caught(breaks: Callable[..., None]) -> None:
    breaks(CollaborationStrategyContract, with_run(TrustsStates), DAMAGED, error=(TypeError, KeyError))


class AcceptsAnyState(Run):
    """A run that restores numbers that it does not expect, and then chooses too few."""

    turn = 0

    def observe(self, meetings: ScoredMeetings, genome: Genome) -> None:
        self.turn += 1

    def row(self, members: Sequence[Member], rng: np.random.Generator) -> list[Any]:
        return ranked(members)[: 2 if type(self.turn) is int else 1]

    def state(self) -> Any:
        return {"turn": self.turn}

    def restore(self, state: Any) -> None:
        if isinstance(state, dict) and type(state.get("turn")) in (int, float):
            self.turn = state["turn"]
        else:
            raise ValueError(state)


def test_a_damaged_state_that_breaks_other_laws_is_caught(breaks: Callable[..., None]) -> None:
    breaks(CollaborationStrategyContract, with_run(AcceptsAnyState), DAMAGED)


def test_broken_choices_of_a_strategy_without_a_memory_are_caught_in_its_run(
    breaks: Callable[..., None],
) -> None:
    breaks(CollaborationStrategyContract, AlwaysThree(), DECLARED)


@attrs.frozen
class AlwaysThree(Remembers):
    """A strategy for each individual, with more collaborators than it declares."""

    start: ClassVar[Any] = None

    def select_each(self, judged: Any, members: Sequence[Member], rng: Any) -> Any:
        return np.tile(np.array(ranked(members)[:3], dtype=np.intp), (len(judged), 1))
