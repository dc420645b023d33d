"""The fitness of the individuals of one population, from the scores of their meetings."""

from __future__ import annotations

import math
import numbers
import statistics
from collections.abc import Callable, Mapping, Sequence
from typing import TypeAlias

import attrs
import numpy as np

from evoframe.contract import Aggregator, Credit, Score, ScoredMeetings, Scores, blaming
from evoframe.errors import ComponentError
from evoframe.evolution.decoding import Meeting
from evoframe.evolution.population import Population

__all__ = ["Judge", "rows_of", "scored_meetings"]

Fold: TypeAlias = Callable[[Scores], float]


@attrs.frozen
class Judge:
    """The assignment of fitness to the individuals of one population.

    Attributes:
        key: Dotted key of the aggregator in the configuration.
        aggregator: Computes fitness from scores.
        sign: 1 if the population evolves towards large scores, -1 towards small ones.
    """

    key: str
    aggregator: Aggregator | Credit
    sign: float = 1.0

    def fitness(
        self,
        population: Population,
        column: int,
        scores: Mapping[Meeting, Score],
        seen: Callable[[], ScoredMeetings],
        *,
        first: bool,
    ) -> list[float | None]:
        """Return the fitness of each member; ``None`` if one of its simulations diverged.

        Args:
            population: The population.
            column: Its index.
            scores: The meetings in which its members are evaluated.
            seen: Returns these meetings with their participants.
            first: Whether this is the initial turn, in which the fitness is the arithmetic mean of all
                scores, unless the aggregator considers whole turns.
        """
        rows = rows_of(population, column, scores, self._read)
        if isinstance(self.aggregator, Credit):
            return self._credited(self.aggregator, population, column, rows, seen())
        return self._folded_all(rows, population, first=first)

    def measure(
        self, population: Population, column: int, scores: Mapping[Meeting, Score], name: str, *, first: bool
    ) -> list[float | None]:
        """Return for each member the values of a measure of its simulations, aggregated like its scores.

        An aggregator that considers whole turns does not apply to measures: they are averaged.
        """
        rows = rows_of(population, column, scores, lambda score: score.measures.get(name))
        return self._folded_all(rows, population, first=first)

    def floor(self, scores: Mapping[Meeting, Score]) -> float | None:
        """Return the worst score of a turn, or ``None`` if all simulations diverged."""
        values = (value for value in map(self._read, scores.values()) if value is not None)
        return min(values, default=None)

    def _read(self, score: Score) -> float | None:
        return None if score.value is None else self.sign * score.value

    def _folded_all(
        self, rows: Sequence[Sequence[float | None]], population: Population, *, first: bool
    ) -> list[float | None]:
        """Return each row aggregated; averaged in the initial turn, and for a credit."""
        mean: Fold = statistics.fmean
        fold = mean if first or isinstance(self.aggregator, Credit) else self.aggregator.aggregate
        return [self._folded(row, fold, population.called(i)) for i, row in enumerate(rows)]

    def _folded(self, row: Sequence[float | None], fold: Fold, individual: str) -> float | None:
        values = [value for value in row if value is not None]
        if len(values) < len(row):
            return None
        with blaming(self.key, individual):
            fitness = fold(np.array(values, dtype=np.float64))
        if not isinstance(fitness, numbers.Real) or not math.isfinite(fitness):
            problem = f"returned the fitness {fitness!r} for the scores {values}"
            raise ComponentError(self.key, problem, individual)
        return float(fitness)

    def _credited(
        self,
        credit: Credit,
        population: Population,
        column: int,
        rows: Sequence[Sequence[float | None]],
        seen: ScoredMeetings,
    ) -> list[float | None]:
        whose = f"population {population.name}"
        with blaming(self.key, whose):
            found = np.asarray(credit.credit(seen, column), dtype=np.float64)
        if found.shape != (len(rows),):
            problem = f"returned fitness of shape {found.shape}, expected {(len(rows),)}"
            raise ComponentError(self.key, problem, whose)
        fitness = [None if None in row else value for row, value in zip(rows, found.tolist(), strict=True)]
        for position, value in enumerate(fitness):
            if value is not None and not math.isfinite(value):
                problem = f"returned the fitness {value!r} for the scores {list(rows[position])}"
                raise ComponentError(self.key, problem, population.called(position))
        return fitness


def rows_of(
    population: Population,
    column: int,
    scores: Mapping[Meeting, Score],
    value_of: Callable[[Score], float | None],
) -> list[list[float | None]]:
    """Return a value of each meeting of each member of a population."""
    rows: list[list[float | None]] = [[] for _ in population.members]
    for meeting, score in scores.items():
        rows[meeting[column]].append(value_of(score))
    return rows


def scored_meetings(
    turn: int, populations: Sequence[Population], scores: Mapping[Meeting, Score], sign: float
) -> ScoredMeetings:
    """Return the meetings of a turn as components see them, with scores times *sign*."""
    values = [math.nan if score.value is None else sign * score.value for score in scores.values()]
    return ScoredMeetings(
        turn=turn,
        populations=tuple(population.name for population in populations),
        members=tuple(population.present for population in populations),
        present=tuple(len(population.members) for population in populations),
        meetings=np.array(list(scores), dtype=np.intp).reshape(len(scores), len(populations)),
        scores=np.array(values, dtype=np.float64),
    )
