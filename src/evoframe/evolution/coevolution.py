"""The loop of cooperative coevolution: populations take turns, each judged by its partners in the others."""

from __future__ import annotations

import contextlib
import math
import numbers
import statistics
import time
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from typing import Any, Self, TypeAlias

import attrs
import numpy as np
from attrs.validators import ge
from numpy.typing import NDArray

from evoframe.contract import (
    Aggregator,
    BestPair,
    CollaborationStrategy,
    Design,
    Pair,
    Score,
    Scores,
    Turn,
    Workload,
    blaming,
)
from evoframe.documents import structure
from evoframe.errors import ComponentError
from evoframe.evolution.evaluation import Evaluator
from evoframe.evolution.population import Population

__all__ = ["Coevolution", "first_meetings"]

Meeting: TypeAlias = tuple[int, ...]
"""One position in each population."""

Fold: TypeAlias = Callable[[Scores], float]


@attrs.define
class Coevolution:
    """Iterate over it to run it; it touches neither files nor the terminal.

    First everyone meets everyone and gets the arithmetic mean of its scores. Then, turn by turn, one
    population reproduces and all its members are judged with collaborators from the others, whose fitness
    stays as it was (paper.md, "The loop"). If the fittest of all populations have not met in the last turn,
    they do so in one more, which judges nobody.

    Collaborators from several other populations are combined position by position: the i-th of each.

    Attributes:
        populations: In the order in which they take turns and are decoded; at least two.
        strategy: Chooses the collaborators.
        aggregator: Folds the scores of an individual into its fitness.
        evaluator: Scores designs.
        generations: How often each population reproduces.
        turn: The latest turn; -1 before the first.
        best_score: The best score of a pair so far.
    """

    populations: tuple[Population, ...]
    strategy: CollaborationStrategy
    aggregator: Aggregator
    evaluator: Evaluator
    generations: int
    turn: int = attrs.field(default=-1, init=False)
    best_score: float | None = attrs.field(default=None, init=False)
    _fittest_have_met: bool = attrs.field(default=False, init=False)

    @property
    def length(self) -> int:
        """Number of turns after the initial meeting in which a population reproduces."""
        return self.generations * len(self.populations)

    @property
    def finished(self) -> bool:
        """Whether there is nothing left to do."""
        return self.turn >= self.length and self._fittest_have_met

    def __iter__(self) -> Iterator[Turn]:
        """Let everyone meet everyone, then let the populations take turns."""
        if self.turn < 0:
            yield self._initial_cross()
        while self.turn < self.length:
            yield self._take_turn(self.turn % len(self.populations))
        if not self._fittest_have_met:
            yield self._play([self._fittest()], [], self.aggregator.aggregate, time.perf_counter())

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def fittest_pair(self) -> Pair:
        """Return the fittest of each population as a pair; after the last turn, they have met."""
        meeting = self._fittest()
        return self._pair(meeting, self._scores([meeting])[meeting])

    def state(self, changed: Collection[str] | None = None) -> dict[str, Any]:
        """Return everything needed to continue after the latest turn, as JSON values.

        Args:
            changed: The populations whose state is wanted; by default all.
        """
        loop = attrs.asdict(_Loop(self.turn, self.best_score, self._fittest_have_met))
        wanted = [p for p in self.populations if changed is None or p.name in changed]
        return {"loop": loop, **{f"population/{p.name}": p.state() for p in wanted}}

    def restore(self, state: Mapping[str, Any]) -> None:
        """Continue from what :meth:`state` returned, bit for bit as if never interrupted.

        Raises:
            KeyError: A part is missing.
            StructureError: A part is no such state; says where.
            ValueError: An evolver or a random stream says so.
        """
        loop = structure(state["loop"], _Loop, ("loop",))
        self.turn, self.best_score = loop.turn, loop.best_score
        self._fittest_have_met = loop.fittest_have_met
        for population in self.populations:
            population.restore(state[f"population/{population.name}"])

    def close(self) -> None:
        """Let the workers go."""
        self.evaluator.close()

    def _initial_cross(self) -> Turn:
        started = time.perf_counter()
        for population in self.populations:
            population.reproduce()
        met = first_meetings([len(population.genomes) for population in self.populations])
        return self._play(met, range(len(self.populations)), statistics.fmean, started)

    def _take_turn(self, index: int) -> Turn:
        started = time.perf_counter()
        self.populations[index].reproduce()
        teams = list(zip(*self._chosen(index), strict=True))
        met = _meetings(index, len(self.populations[index].genomes), teams)
        return self._play(met, [index], self.aggregator.aggregate, started)

    def _chosen(self, index: int) -> list[list[int]]:
        """Return the positions of the collaborators from each population but one.

        Raises:
            RunError: The strategy chose what is not there, the same twice, or not as many as it declared.
        """
        chosen = []
        for other in (other for i, other in enumerate(self.populations) if i != index):
            with blaming("collaboration"):
                size = self.strategy.size(len(other.members))
            with blaming("collaboration"):
                selected = np.asarray(self.strategy.select(other.members, self.populations[index].rng))
            if not _are_positions(selected, size, len(other.members)):
                raise ComponentError(
                    "collaboration",
                    f"chose {selected.tolist()}, not {size} of the {len(other.members)} members of "
                    f"'{other.name}'",
                )
            chosen.append(selected.tolist())
        return chosen

    def _fittest(self) -> Meeting:
        return tuple(population.fittest() for population in self.populations)

    def _play(self, meetings: Sequence[Meeting], judged: Sequence[int], fold: Fold, started: float) -> Turn:
        """Score all *meetings* of a turn, which differ, and let them judge some of the populations."""
        simulated = self.evaluator.simulations
        scores = self._scores(meetings)
        for index in judged:
            self._judge(index, scores, fold)
        self.turn += 1
        self._fittest_have_met = self._fittest() in scores
        return Turn(
            index=self.turn,
            reports=tuple(self.populations[index].report() for index in judged),
            pairs=tuple(self._pair(meeting, score) for meeting, score in scores.items()),
            best_pair=self._best_pair(scores),
            workload=Workload(
                pairs=len(scores),
                simulations=self.evaluator.simulations - simulated,
                seconds=time.perf_counter() - started,
            ),
        )

    def _judge(self, index: int, scores: Mapping[Meeting, Score], fold: Fold) -> None:
        """Give every member of a population the fold of the scores of all its meetings."""
        population = self.populations[index]
        rows: list[list[float | None]] = [[] for _ in population.genomes]
        for meeting, score in scores.items():
            rows[meeting[index]].append(score.value)
        floor = min((score.value for score in scores.values() if score.value is not None), default=None)
        fitness = [_fitness(row, fold, population.called(i)) for i, row in enumerate(rows)]
        population.judge(fitness, floor)

    def _scores(self, meetings: Collection[Meeting]) -> dict[Meeting, Score]:
        """Score different meetings; those that share their first members are simulated side by side."""
        together = sorted(meetings)
        with self._saying_who(together):
            scores = self.evaluator.evaluate(self._designs(together), len(together))
        by_meeting = dict(zip(together, scores, strict=True))
        return {meeting: by_meeting[meeting] for meeting in meetings}

    def _designs(self, meetings: Iterable[Meeting]) -> Iterator[Design]:
        """Decode different meetings; what the first members of several share is decoded once."""
        decoded: dict[Meeting, Design] = {(): Design()}
        for meeting in meetings:
            for length, population in enumerate(self.populations, start=1):
                shared = meeting[:length]
                if shared not in decoded:
                    decoded[shared] = population.decode(shared[-1], decoded[shared[:-1]])
            yield decoded.pop(meeting)

    @contextlib.contextmanager
    def _saying_who(self, meetings: Sequence[Meeting]) -> Iterator[None]:
        """Say whose designs an error is about that knows only their places among those of *meetings*."""
        try:
            yield
        except ComponentError as error:
            if error.concerns:
                raise
            met = (zip(self.populations, meetings[place], strict=True) for place in error.places)
            names = (" with ".join(p.called(position) for p, position in pairs) for pairs in met)
            raise attrs.evolve(error, concerns="; ".join(names)) from error

    def _pair(self, meeting: Meeting, score: Score) -> Pair:
        ids = tuple(
            population.members[position].id
            for population, position in zip(self.populations, meeting, strict=True)
        )
        return Pair(ids, score.value, score.diverged_at)

    def _best_pair(self, scores: Mapping[Meeting, Score]) -> BestPair | None:
        """Return the best pair of this turn if it is better than all before; ties go to the earliest."""
        best: Meeting | None = None
        for meeting, score in scores.items():
            if score.value is not None and (self.best_score is None or score.value > self.best_score):
                self.best_score, best = score.value, meeting
        if best is None or self.best_score is None:
            return None
        [design] = self._designs([best])
        chosen = list(zip(self.populations, best, strict=True))
        return BestPair(
            turn=self.turn,
            score=self.best_score,
            genome_ids={population.name: population.members[i].id for population, i in chosen},
            genomes={population.name: population.dump(i) for population, i in chosen},
            design=design,
        )


def first_meetings(sizes: Sequence[int]) -> list[Meeting]:
    """Return the meetings in which everyone meets everyone, each of them once.

    Args:
        sizes: Of the populations, in the order in which they take turns.
    """
    met: dict[Meeting, None] = {}
    for index, size in enumerate(sizes):
        met.update(dict.fromkeys(_meetings(index, size, _everyone_else(index, sizes))))
    return list(met)


def _everyone_else(index: int, sizes: Sequence[int]) -> list[Meeting]:
    """Return teams of which every member of every other population is part; small populations recur."""
    others = [size for i, size in enumerate(sizes) if i != index]
    return [tuple(position % size for size in others) for position in range(max(others))]


def _meetings(index: int, size: int, teams: Sequence[tuple[int, ...]]) -> list[Meeting]:
    """Return the meetings of each member of a population with each of the *teams* from the others."""
    return [(*team[:index], member, *team[index:]) for member in range(size) for team in teams]


@attrs.frozen
class _Loop:
    """The part of the state that belongs to no population."""

    turn: int = attrs.field(validator=ge(-1))
    best_score: float | None
    fittest_have_met: bool


def _fitness(row: Sequence[float | None], fold: Fold, individual: str) -> float | None:
    """Return the fold of the scores of an individual, or ``None`` if one of its simulations diverged."""
    values = [value for value in row if value is not None]
    if len(values) < len(row):
        return None
    with blaming("aggregator", individual):
        fitness = fold(np.array(values, dtype=np.float64))
    if not isinstance(fitness, numbers.Real) or not math.isfinite(fitness):
        problem = f"gave the fitness {fitness!r} for the scores {values}"
        raise ComponentError("aggregator", problem, individual)
    return float(fitness)


def _are_positions(chosen: NDArray[Any], size: int, members: int) -> bool:
    """Return whether these are so many different positions among so many members."""
    return (
        chosen.shape == (size,)
        and np.issubdtype(chosen.dtype, np.integer)
        and len(set(chosen.tolist())) == size
        and bool(((chosen >= 0) & (chosen < members)).all())
    )
