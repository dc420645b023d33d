"""The loop of cooperative coevolution: populations take turns and are evaluated with collaborators."""

from __future__ import annotations

import contextlib
import math
import numbers
import statistics
import time
from collections import ChainMap, deque
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
    Pair,
    Score,
    Scores,
    Turn,
    Workload,
    blaming,
)
from evoframe.documents import structure
from evoframe.errors import ComponentError
from evoframe.evolution.decoding import Meeting, decoded_designs
from evoframe.evolution.evaluation import Evaluator
from evoframe.evolution.population import Population

__all__ = ["Coevolution", "first_meetings"]

Fold: TypeAlias = Callable[[Scores], float]


@attrs.define
class Coevolution:
    """The loop of a run; iterating over it executes the turns, without input or output.

    In the initial turn, every individual is paired with every individual of the other populations; its
    fitness is the arithmetic mean of its scores. In each following turn, one population reproduces and all
    its members are evaluated with collaborators from the other populations, whose fitness does not change
    (docs/experiment.md, "The loop"). If the fittest individuals of all populations were not paired in the
    last turn, the final pair is scored in a turn of its own, without changing any fitness.

    Collaborators from several other populations are combined by position: the i-th of each.

    Attributes:
        populations: At least two, in the order of turns and of decoding.
        strategy: Chooses the collaborators.
        aggregator: Aggregates the scores of an individual into its fitness.
        evaluator: Scores designs.
        generations: Generations per population.
        on_simulating: Called in each turn while the workers simulate, to complete what concerns the turn
            before. The populations are those of that turn, except the one that has reproduced since.
        turn: Index of the latest turn; -1 before the first.
        best_score: Best score of a pair so far.
    """

    populations: tuple[Population, ...]
    strategy: CollaborationStrategy
    aggregator: Aggregator
    evaluator: Evaluator
    generations: int
    on_simulating: Callable[[], None] = attrs.field(default=lambda: None, init=False)
    turn: int = attrs.field(default=-1, init=False)
    best_score: float | None = attrs.field(default=None, init=False)
    _fittest_have_met: bool = attrs.field(default=False, init=False)
    _recent: deque[dict[tuple[int, ...], Score]] = attrs.field(init=False)

    def __attrs_post_init__(self) -> None:
        # Survivors of a population meet the same collaborators again if these are still the chosen ones, so
        # that the turn in which the population was last evaluated is the oldest one worth keeping.
        self._recent = deque(maxlen=len(self.populations))

    @property
    def length(self) -> int:
        """Number of turns in which a population reproduces."""
        return self.generations * len(self.populations)

    @property
    def finished(self) -> bool:
        """True if all turns are complete."""
        return self.turn >= self.length and self._fittest_have_met

    def __iter__(self) -> Iterator[Turn]:
        """Yield the initial turn, the turns of the populations, and if required that of the final pair."""
        if self.turn < 0:
            yield self._initial_turn()
        while self.turn < self.length:
            yield self._take_turn(self.turn % len(self.populations))
        if not self._fittest_have_met:
            yield self._complete_turn([self._fittest()], [], self.aggregator.aggregate, time.perf_counter())

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def fittest_pair(self) -> Pair:
        """Return the fittest of each population as a pair; after the last turn, its score is known."""
        [pair] = self._pairs(self._scores([self._fittest()]))
        return pair

    def state(self, changed: Collection[str] | None = None) -> dict[str, Any]:
        """Return everything needed to continue after the latest turn, as JSON values.

        Args:
            changed: Names of the populations to include; by default all.
        """
        loop = attrs.asdict(_Loop(self.turn, self.best_score, self._fittest_have_met))
        wanted = [p for p in self.populations if changed is None or p.name in changed]
        return {"loop": loop, **{f"population/{p.name}": p.state() for p in wanted}}

    def restore(self, state: Mapping[str, Any]) -> None:
        """Continue from the result of :meth:`state`, bit for bit as without an interruption.

        Raises:
            KeyError: A part of the state is missing.
            StructureError: A part of the state is invalid; names its keys.
            ValueError: An evolver or a random stream rejects its state.
        """
        loop = structure(state["loop"], _Loop, ("loop",))
        self.turn, self.best_score = loop.turn, loop.best_score
        self._fittest_have_met = loop.fittest_have_met
        self._recent.clear()
        for population in self.populations:
            population.restore(state[f"population/{population.name}"])

    def close(self) -> None:
        """Shut down the workers."""
        self.evaluator.close()

    def _initial_turn(self) -> Turn:
        started = time.perf_counter()
        for population in self.populations:
            population.reproduce()
        met = first_meetings([len(population.genomes) for population in self.populations])
        return self._complete_turn(met, range(len(self.populations)), statistics.fmean, started)

    def _take_turn(self, index: int) -> Turn:
        started = time.perf_counter()
        self.populations[index].reproduce()
        teams = list(zip(*self._chosen(index), strict=True))
        met = _meetings(index, len(self.populations[index].genomes), teams)
        return self._complete_turn(met, [index], self.aggregator.aggregate, started)

    def _chosen(self, index: int) -> list[list[int]]:
        """Return the positions of the collaborators from each population except one.

        Raises:
            RunError: The strategy chose invalid or repeated positions, or another number than declared.
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
                    f"chose {selected.tolist()}, expected {size} of the {len(other.members)} members of "
                    f"'{other.name}'",
                )
            chosen.append(selected.tolist())
        return chosen

    def _fittest(self) -> Meeting:
        return tuple(population.fittest() for population in self.populations)

    def _complete_turn(
        self, meetings: Sequence[Meeting], judged: Sequence[int], fold: Fold, started: float
    ) -> Turn:
        """Score the unique *meetings* of a turn, and set the fitness of the *judged* populations."""
        simulated = self.evaluator.simulations
        scores = self._scores(meetings, self._while_simulating)
        for index in judged:
            self._judge(index, scores, fold)
        pairs = self._pairs(scores)
        self._recent.append({p.genomes: score for p, score in zip(pairs, scores.values(), strict=True)})
        self.turn += 1
        self._fittest_have_met = self._fittest() in scores
        return Turn(
            index=self.turn,
            reports=tuple(self.populations[index].report() for index in judged),
            pairs=pairs,
            best_pair=self._best_pair(scores),
            workload=Workload(
                pairs=len(scores),
                simulations=self.evaluator.simulations - simulated,
                seconds=time.perf_counter() - started,
            ),
        )

    def _while_simulating(self) -> None:
        """Complete what concerns the turn before, and breed the population that reproduces in the next."""
        self.on_simulating()
        if 0 <= self.turn < self.length - 1:
            self.populations[(self.turn + 1) % len(self.populations)].breed()

    def _judge(self, index: int, scores: Mapping[Meeting, Score], fold: Fold) -> None:
        """Set the fitness of each member of a population to the *fold* of the scores of its meetings."""
        population = self.populations[index]
        rows: list[list[float | None]] = [[] for _ in population.genomes]
        for meeting, score in scores.items():
            rows[meeting[index]].append(score.value)
        floor = min((score.value for score in scores.values() if score.value is not None), default=None)
        fitness = [_fitness(row, fold, population.called(i)) for i, row in enumerate(rows)]
        population.judge(fitness, floor)

    def _scores(
        self, meetings: Collection[Meeting], on_simulating: Callable[[], None] = lambda: None
    ) -> dict[Meeting, Score]:
        """Return the scores of unique meetings; pairs of recent turns are not evaluated again."""
        recent = dict(ChainMap(*self._recent))  # an id stands for one genome
        pairs = zip(meetings, self._ids(meetings), strict=True)
        known = {meeting: recent[ids] for meeting, ids in pairs if ids in recent}
        # Sorted, so that designs with the same first members share a batch.
        unknown = sorted(set(meetings) - known.keys())
        with self._naming_individuals(unknown):
            designs = decoded_designs(self.populations, unknown)
            scores = self.evaluator.evaluate(designs, len(unknown), on_simulating)
        known.update(zip(unknown, scores, strict=True))
        return {meeting: known[meeting] for meeting in meetings}

    def _ids(self, meetings: Iterable[Meeting]) -> Iterator[tuple[int, ...]]:
        """Yield the ids of the genomes of each meeting."""
        ids = [[member.id for member in population.members] for population in self.populations]
        return (tuple(map(list.__getitem__, ids, meeting)) for meeting in meetings)

    @contextlib.contextmanager
    def _naming_individuals(self, meetings: Sequence[Meeting]) -> Iterator[None]:
        """Add the names of individuals to an error that contains only the indices of their *meetings*."""
        try:
            yield
        except ComponentError as error:
            if error.concerns:
                raise
            met = (zip(self.populations, meetings[place], strict=True) for place in error.places)
            names = (" with ".join(p.called(position) for p, position in pairs) for pairs in met)
            raise attrs.evolve(error, concerns="; ".join(names)) from error

    def _pairs(self, scores: Mapping[Meeting, Score]) -> tuple[Pair, ...]:
        return tuple(
            Pair(ids, score.value, score.diverged_at)
            for ids, score in zip(self._ids(scores), scores.values(), strict=True)
        )

    def _best_pair(self, scores: Mapping[Meeting, Score]) -> BestPair | None:
        """Return the best pair of this turn if it exceeds all earlier ones; the earliest wins ties."""
        best: Meeting | None = None
        for meeting, score in scores.items():
            if score.value is not None and (self.best_score is None or score.value > self.best_score):
                self.best_score, best = score.value, meeting
        if best is None or self.best_score is None:
            return None
        [design] = decoded_designs(self.populations, [best])
        chosen = list(zip(self.populations, best, strict=True))
        return BestPair(
            turn=self.turn,
            score=self.best_score,
            genome_ids={population.name: population.members[i].id for population, i in chosen},
            genomes={population.name: population.dump(i) for population, i in chosen},
            design=design,
        )


def first_meetings(sizes: Sequence[int]) -> list[Meeting]:
    """Return the meetings of the initial turn, without repeats.

    Args:
        sizes: Sizes of the populations, in the order of turns.
    """
    met: dict[Meeting, None] = {}
    for index, size in enumerate(sizes):
        met.update(dict.fromkeys(_meetings(index, size, _teams_of_others(index, sizes))))
    return list(met)


def _teams_of_others(index: int, sizes: Sequence[int]) -> list[Meeting]:
    """Return teams that cover all members of the other populations; those of smaller ones recur."""
    others = [size for i, size in enumerate(sizes) if i != index]
    return [tuple(position % size for size in others) for position in range(max(others))]


def _meetings(index: int, size: int, teams: Sequence[tuple[int, ...]]) -> list[Meeting]:
    """Return the meetings of each member of a population with each team from the others."""
    return [(*team[:index], member, *team[index:]) for member in range(size) for team in teams]


@attrs.frozen
class _Loop:
    """The part of the state that is independent of the populations."""

    turn: int = attrs.field(validator=ge(-1))
    best_score: float | None
    fittest_have_met: bool


def _fitness(row: Sequence[float | None], fold: Fold, individual: str) -> float | None:
    """Return the fitness of an individual, or ``None`` if one of its simulations diverged."""
    values = [value for value in row if value is not None]
    if len(values) < len(row):
        return None
    with blaming("aggregator", individual):
        fitness = fold(np.array(values, dtype=np.float64))
    if not isinstance(fitness, numbers.Real) or not math.isfinite(fitness):
        problem = f"returned the fitness {fitness!r} for the scores {values}"
        raise ComponentError("aggregator", problem, individual)
    return float(fitness)


def _are_positions(chosen: NDArray[Any], size: int, members: int) -> bool:
    """Return whether *chosen* contains *size* unique positions among *members*."""
    return (
        chosen.shape == (size,)
        and np.issubdtype(chosen.dtype, np.integer)
        and len(set(chosen.tolist())) == size
        and bool(((chosen >= 0) & (chosen < members)).all())
    )
