"""Simulated turns of two populations, for the laws of collaboration strategies with a memory."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import attrs
import numpy as np

from evoframe.contract import Archived, Choice, CollaborationRun, Judged, Member, ScoredMeetings

__all__ = ["OTHER", "POPULATION", "MadeChoice", "World"]

POPULATION, OTHER = "choosing", "chosen"
"""Names of the two populations: collaborators are chosen for the first among the members of the second."""

_FITNESS = (-1.0, 0.0, 0.004, 0.005, 0.5)  # few values, so that there are ties


@attrs.frozen
class MadeChoice:
    """A call of ``choose``: its arguments, and what it returned.

    Attributes:
        judged: The individuals to be evaluated.
        members: The members to choose from.
        rows: The collaborators of each of *judged*.
    """

    judged: tuple[Judged, ...]
    members: tuple[Member, ...]
    rows: tuple[tuple[Choice, ...], ...]

    def as_json(self) -> Any:
        """Return the rows as JSON values."""
        return [[_as_json(choice) for choice in row] for row in self.rows]


def _as_json(choice: Choice) -> Any:
    return [choice.member.id, choice.genome] if isinstance(choice, Archived) else choice


@attrs.define
class World:
    """Two populations of *size* individuals, with random survivors, fitness, divergences and scores.

    Attributes:
        size: Number of members of each population.
        accepts: Returns whether the strategy accepts a number of members.
        see: Receives each choice, before anything is done with it.
        rng: Source of all random numbers but those of the strategy.
        genomes: Genomes that were requested, by id.
    """

    size: int
    accepts: Callable[[int], bool]
    see: Callable[[MadeChoice], None]
    rng: np.random.Generator
    genomes: dict[int, Any] = attrs.field(factory=dict)
    _members: list[list[Member]] = attrs.field(init=False)
    _met: dict[int, tuple[int, ...]] = attrs.field(factory=dict, init=False)
    _turn: int = attrs.field(default=0, init=False)
    _next_id: int = attrs.field(default=0, init=False)

    def __attrs_post_init__(self) -> None:
        self._members = [[self._born() for _ in range(self.size)] for _ in range(2)]

    def play(self, run: CollaborationRun, rng: np.random.Generator) -> None:
        """Play a turn of the choosing population, and one of the other population.

        The first turn is the initial one, in which everybody meets everybody.
        """
        if self._turn == 0:
            self._initial_turn(run)
        else:
            self._choosing_turn(run, rng)
            self._other_turn(run)

    def _initial_turn(self, run: CollaborationRun) -> None:
        self._evaluate(0)
        self._evaluate(1)
        self._observed(run, [range(self.size)] * self.size, ())

    def _choosing_turn(self, run: CollaborationRun, rng: np.random.Generator) -> None:
        """Choose for a part of the population among all members, then for the rest among a part of them."""
        self._reproduce(0)
        judged = tuple(
            Judged(member, self._met.get(member.id, ()), index=index)
            for index, member in enumerate(self._members[0])
        )
        cut = int(self.rng.integers(1, self.size + 1))
        some = self._some_members()
        calls = [self._chosen(run, rng, judged[:cut], range(self.size))]
        if cut < self.size:
            calls.append(self._chosen(run, rng, judged[cut:], some))
        rows, archived = self._global([*zip(calls, (range(self.size), some), strict=False)])
        self._met = {
            one.member.id: tuple(self._id(choice, archived) for choice in row)
            for one, row in zip(judged, rows, strict=False)
        }
        self._evaluate(0)
        self._observed(run, rows, archived)

    def _other_turn(self, run: CollaborationRun) -> None:
        """Evaluate the other population with two members of the choosing one."""
        self._reproduce(1)
        self._evaluate(1)
        met = self.rng.permutation(self.size)[:2].tolist()
        everybody = list(range(self.size))
        self._observed(run, [everybody if index in met else [] for index in everybody], ())

    def _chosen(
        self,
        run: CollaborationRun,
        rng: np.random.Generator,
        judged: tuple[Judged, ...],
        among: Sequence[int],
    ) -> MadeChoice:
        members = tuple(self._members[1][index] for index in among)
        made = MadeChoice(judged, members, tuple(map(tuple, run.choose(judged, members, rng))))
        self.see(made)
        return made

    def _some_members(self) -> list[int]:
        accepted = [n for n in range(1, self.size + 1) if self.accepts(n)]
        n = int(self.rng.choice(accepted))
        return sorted(self.rng.permutation(self.size)[:n].tolist())

    def _global(
        self, calls: Sequence[tuple[MadeChoice, Sequence[int]]]
    ) -> tuple[list[list[int]], tuple[Archived, ...]]:
        """Return rows of indices of all members and, after them, of archived individuals, and the latter."""
        places = {member.id: index for index, member in enumerate(self._members[1])}
        archived: list[Archived] = []
        rows: list[list[int]] = []
        for call, among in calls:
            for row in call.rows:
                rows.append([])
                for choice in row:
                    if not isinstance(choice, Archived):
                        rows[-1].append(among[choice])
                        continue
                    if choice.member.id not in places:
                        places[choice.member.id] = self.size + len(archived)
                        archived.append(choice)
                    rows[-1].append(places[choice.member.id])
        return rows, tuple(archived)

    def _id(self, index: int, archived: Sequence[Archived]) -> int:
        return self._members[1][index].id if index < self.size else archived[index - self.size].member.id

    def _observed(
        self, run: CollaborationRun, rows: Sequence[Sequence[int]], archived: Sequence[Archived]
    ) -> None:
        """Let the run observe a turn in which the choosing individuals met those of *rows*."""
        pairs = sorted({(index, choice) for index, row in enumerate(rows) for choice in row})
        scores = np.where(self.rng.random(len(pairs)) < 0.1, np.nan, self.rng.choice(_FITNESS, len(pairs)))
        one, other = self._members
        members = (tuple(one), (*other, *(each.member for each in archived)))
        meetings = np.array(pairs, dtype=np.intp).reshape(len(pairs), 2)
        present = (self.size, self.size)
        run.observe(
            ScoredMeetings(self._turn, (POPULATION, OTHER), members, present, meetings, scores),
            lambda index: self._genome(members[1][index].id),
        )
        self._turn += 1

    def _genome(self, id_: int) -> Any:
        return self.genomes.setdefault(id_, {"id": id_, "weights": [0.5 * id_, 1.0]})

    def _reproduce(self, population: int) -> None:
        self._members[population] = [
            attrs.evolve(member, age=member.age + 1) if self.rng.random() < 0.5 else self._born()
            for member in self._members[population]
        ]

    def _born(self) -> Member:
        self._next_id += 1
        species = (None, 1, 2, 3)[self.rng.integers(4)]
        return Member(self._next_id, None, species=species, genome_size=int(self.rng.integers(1, 4)))

    def _evaluate(self, population: int) -> None:
        share = self.rng.choice((0.0, 0.5, 0.9))  # of members with a diverged simulation
        self._members[population] = [
            attrs.evolve(
                member,
                fitness=float(self.rng.choice(_FITNESS)),
                diverged=bool(self.rng.random() < share),
            )
            for member in self._members[population]
        ]
