"""The loop of cooperative coevolution: populations take turns, each judged by its partners in the others."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from typing import Any, TypeAlias

import attrs
import numpy as np

from evoframe.errors import RunError
from evoframe.evaluation import Evaluator, Score
from evoframe.population import Population
from evoframe.protocols import Aggregator, CollaborationStrategy
from evoframe.values import BestPair, Design, Pair, Scores, Turn, Workload

__all__ = ["Coevolution"]

Meeting: TypeAlias = tuple[int, ...]
"""One position in each population."""


@attrs.define
class Coevolution:
    """Iterate over it to run it; it touches neither files nor the terminal.

    First everyone meets everyone and gets the arithmetic mean of its scores. Then, turn by turn, one
    population reproduces and all its members are judged with collaborators from the others, whose fitness
    stays as it was (paper.md, "The loop").

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

    @property
    def length(self) -> int:
        """Number of turns after the initial meeting."""
        return self.generations * len(self.populations)

    def __iter__(self) -> Iterator[Turn]:
        """Let everyone meet everyone, then let the populations take turns."""
        if self.turn < 0:
            yield self._initial_cross()
        while self.turn < self.length:
            yield self._take_turn(self.populations[self.turn % len(self.populations)])

    def fittest_pair(self) -> Pair:
        """Return the fittest of each population as a pair, which may meet here for the first time."""
        meeting = tuple(population.fittest() for population in self.populations)
        [score] = self.evaluator.evaluate(self._designs([meeting]))
        return self._pair(meeting, score)

    def state(self, changed: Collection[str] | None = None) -> dict[str, Any]:
        """Return everything needed to continue after the latest turn, as JSON values.

        Args:
            changed: The populations whose state is wanted; by default all.
        """
        loop = {"turn": self.turn, "best_score": self.best_score}
        wanted = [p for p in self.populations if changed is None or p.name in changed]
        return {"loop": loop, **{f"population/{p.name}": p.state() for p in wanted}}

    def restore(self, state: Mapping[str, Any]) -> None:
        """Continue from what :meth:`state` returned, bit for bit as if never interrupted."""
        self.turn = state["loop"]["turn"]
        self.best_score = state["loop"]["best_score"]
        for population in self.populations:
            population.restore(state[f"population/{population.name}"])

    def close(self) -> None:
        """Let the workers go."""
        self.evaluator.close()

    def _initial_cross(self) -> Turn:
        started = time.perf_counter()
        for population in self.populations:
            population.reproduce()
        rows = {}
        for index in range(len(self.populations)):
            sizes = self._sizes_of_others(index)
            rows[index] = self._rows(index, [(position,) * len(sizes) for position in range(min(sizes))])
        return self._play(rows, _arithmetic_mean, started)

    def _take_turn(self, population: Population) -> Turn:
        started = time.perf_counter()
        population.reproduce()
        index = self.populations.index(population)
        chosen = [
            self.strategy.select(other.members, population.rng).tolist()
            for other in self.populations
            if other is not population
        ]
        teams = list(zip(*chosen, strict=True))
        return self._play({index: self._rows(index, teams)}, self.aggregator.aggregate, started)

    def _sizes_of_others(self, index: int) -> list[int]:
        return [len(other.genomes) for i, other in enumerate(self.populations) if i != index]

    def _rows(self, index: int, teams: Sequence[tuple[int, ...]]) -> list[list[Meeting]]:
        """Return the meetings of each member of a population with each of the *teams*.

        A team has one collaborator from every other population: the i-th chosen of each.
        """
        size = len(self.populations[index].genomes)
        return [[(*team[:index], member, *team[index:]) for team in teams] for member in range(size)]

    def _play(
        self, rows: dict[int, list[list[Meeting]]], fold: Callable[[Scores], float], started: float
    ) -> Turn:
        """Score all meetings of a turn that *started* then, and let the populations be judged by them."""
        simulated = self.evaluator.simulations
        meetings = list(dict.fromkeys(m for table in rows.values() for row in table for m in row))
        designs = self._designs(meetings)
        scores = dict(zip(meetings, self.evaluator.evaluate(designs), strict=True))
        floor = min((score.value for score in scores.values() if score.value is not None), default=None)
        for index, table in rows.items():
            self.populations[index].judge([_fitness(row, scores, fold) for row in table], floor)
        self.turn += 1
        return Turn(
            index=self.turn,
            reports=tuple(self.populations[index].report() for index in rows),
            pairs=tuple(self._pair(meeting, score) for meeting, score in scores.items()),
            best_pair=self._best_pair(scores, designs),
            workload=Workload(
                pairs=len(meetings),
                simulations=self.evaluator.simulations - simulated,
                seconds=time.perf_counter() - started,
            ),
        )

    def _designs(self, meetings: Sequence[Meeting]) -> list[Design]:
        """Decode the meetings; what the first populations of several meetings share is decoded once."""
        decoded: dict[Meeting, Design] = {(): Design()}
        for meeting in meetings:
            for length, population in enumerate(self.populations, start=1):
                shared = meeting[:length]
                if shared not in decoded:
                    network = population.network(shared[-1])
                    decoded[shared] = population.encoder.decode(network, decoded[shared[:-1]])
        return [decoded[meeting] for meeting in meetings]

    def _pair(self, meeting: Meeting, score: Score) -> Pair:
        ids = tuple(
            population.members[position].id
            for population, position in zip(self.populations, meeting, strict=True)
        )
        return Pair(ids, score.value, score.diverged_at)

    def _best_pair(self, scores: Mapping[Meeting, Score], designs: Sequence[Design]) -> BestPair | None:
        """Return the best pair of this turn if it is better than all before; ties go to the earliest."""
        best: tuple[Meeting, Design] | None = None
        for (meeting, score), design in zip(scores.items(), designs, strict=True):
            if score.value is not None and (self.best_score is None or score.value > self.best_score):
                self.best_score, best = score.value, (meeting, design)
        if best is None or self.best_score is None:
            return None
        meeting, design = best
        chosen = list(zip(self.populations, meeting, strict=True))
        return BestPair(
            turn=self.turn,
            score=self.best_score,
            genome_ids={population.name: population.members[i].id for population, i in chosen},
            genomes={
                population.name: population.evolver.dump(population.genomes[i]) for population, i in chosen
            },
            design=design,
        )


def _arithmetic_mean(scores: Scores) -> float:
    return math.fsum(scores) / len(scores)


def _fitness(
    row: Sequence[Meeting], scores: Mapping[Meeting, Score], fold: Callable[[Scores], float]
) -> float | None:
    values = [scores[meeting].value for meeting in row]
    if None in values:
        return None
    fitness = float(fold(np.array(values, dtype=np.float64)))
    if not math.isfinite(fitness):
        raise RunError(f"the aggregator gave the fitness {fitness} for the scores {values}")
    return fitness
