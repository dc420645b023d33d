"""Initial populations from the fittest of several random ones."""

from __future__ import annotations

import statistics
from collections.abc import Mapping, Sequence

import attrs

from evoframe.contract import Score
from evoframe.evolution.credit import rows_of
from evoframe.evolution.decoding import Meeting, decoded_designs
from evoframe.evolution.evaluation import Evaluator
from evoframe.evolution.meetings import first_meetings
from evoframe.evolution.population import Population
from evoframe.evolution.roles import Roles

__all__ = ["Drafts"]


@attrs.frozen
class Drafts:
    """Random initial populations, of whose individuals the fittest are chosen.

    Attributes:
        draws: Number of draws of each population; one with a single draw keeps it.
        populations: For each draw, all populations; those with fewer draws repeat their last one.
    """

    draws: tuple[int, ...] = ()
    populations: tuple[tuple[Population, ...], ...] = ()

    def seed(
        self, populations: Sequence[Population], signs: Sequence[float], roles: Roles, evaluator: Evaluator
    ) -> None:
        """Let *populations*, which have not started yet, start with the fittest individuals of all draws.

        The individuals of each draw meet each other as in the initial turn, and their fitness is their mean
        score, times the *signs* of the populations. Those with a diverged simulation come last, and of equal
        ones the first is chosen.
        """
        scores = [_scores(drawn, roles, evaluator) for drawn in self.populations]
        for column, (population, draws) in enumerate(zip(populations, self.draws, strict=True)):
            if draws == 1:
                continue
            drawn = [each[column] for each in self.populations[:draws]]
            ranked = sorted(
                (*rank, number, position)
                for number, each in enumerate(drawn)
                for position, rank in enumerate(_ranks(each, column, scores[number], signs[column]))
            )
            best = ranked[: len(drawn[0].members)]
            population.seed([drawn[number].dump(position) for *_, number, position in best])


def _scores(drawn: Sequence[Population], roles: Roles, evaluator: Evaluator) -> dict[Meeting, Score]:
    for population in drawn:
        population.reproduce()
    meetings = sorted(first_meetings([len(population.members) for population in drawn]))
    designs = decoded_designs(drawn, meetings, roles)
    return dict(zip(meetings, evaluator.evaluate(designs, len(meetings)), strict=True))


def _ranks(
    population: Population, column: int, scores: Mapping[Meeting, Score], sign: float
) -> list[tuple[bool, float]]:
    """Return for each individual whether it diverged, and its negated mean score."""
    rows = rows_of(population, column, scores, lambda score: score.value)
    values = [[value for value in row if value is not None] for row in rows]
    means = [statistics.fmean(row) if row else 0.0 for row in values]
    return [(len(kept) < len(row), -sign * mean) for row, kept, mean in zip(rows, values, means, strict=True)]
