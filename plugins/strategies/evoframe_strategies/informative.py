"""The archive of informative collaborators of iCCEA."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import attrs
import numpy as np
from numpy.typing import NDArray

from evoframe import Archived, Choice, CollaborationRun, Member, ScoredMeetings, structure
from evoframe_strategies.chance import draw_alike
from evoframe_strategies.memory import (
    CommonRun,
    Genome,
    completed,
    document,
    first_choice,
    found_in,
    unique_ids,
)
from evoframe_strategies.ranking import ChooseN, Indices

__all__ = ["Informative", "informative_rows"]

Payoff = NDArray[np.float64]


@attrs.frozen
class Informative(ChooseN):
    """Collaborators that preserve the ranking of those who met them, then the fittest, then random ones.

    After each evaluation of the choosing population, the archive is chosen anew among the individuals that
    met all its members. An individual is ranked by its best score with the archive. The first in the archive
    is part of the best meeting. Then the archive is extended by the collaborator that lifts an individual
    above another one which was not below it, with the highest score of the lifted individual. When none is
    left, the archive orders any two individuals as all collaborators do, if these tell them apart.

    The archive takes up to *n* - 1 places, the most informative first. The fittest member, and members drawn
    at random, take the others, so that new individuals can enter. With *n* = 1, only the fittest is chosen.

    Source: Panait, Luke and Harrison 2006, "Archive-based cooperative coevolutionary algorithms", GECCO
    (iCCEA). Simplified: the archive is limited; it is chosen among the collaborators of a turn, of which
    there are few after the initial turn, instead of among the complete population; scores are not measured
    again; and individuals are ranked by their best score whatever the aggregator. A diverged simulation
    counts as the lowest score.

    Attributes:
        n: Number of collaborators.
    """

    def select(self, members: Sequence[Member], rng: np.random.Generator) -> Indices:
        """Return the indices of *members* that are chosen with an empty archive."""
        return first_choice(self.start("", ""), members, rng)

    def start(self, population: str, other: str) -> CollaborationRun:
        """Start with an empty archive of individuals of *other* that are informative for *population*."""
        return _InformativeRun(self, population, other)


@attrs.frozen
class _SavedArchive:
    archive: tuple[Archived, ...] = attrs.field(validator=unique_ids)


class _InformativeRun(CommonRun):
    def __init__(self, strategy: Informative, population: str, other: str) -> None:
        super().__init__(other)
        self._strategy = strategy
        self._population = population
        self._archive: list[Archived] = []

    def choice(self, members: Sequence[Member], rng: np.random.Generator) -> list[Choice]:
        size = self._strategy.size(len(members))
        known = found_in(self._archive, members)[: size - 1]
        chosen = completed(known, members, len(known) + 1)
        left = [index for index in range(len(members)) if index not in chosen]
        return [*chosen, *draw_alike(members, left, size - len(chosen), rng)]

    def observe(self, meetings: ScoredMeetings, genome: Genome) -> None:
        """Choose the archive anew, if there are individuals that met the whole population."""
        judges, payoff = _payoff(meetings, self._population, self.other)
        if not judges:
            return
        individuals = meetings.members[meetings.populations.index(self.other)]
        rows = informative_rows(payoff, self._strategy.n - 1)
        chosen = [judges[row] for row in rows]
        self._archive = [Archived(individuals[index], genome(index)) for index in chosen]

    def state(self) -> Any:
        return {"archive": document(self._archive)}

    def restore(self, state: Any) -> None:
        self._archive = list(structure(state, _SavedArchive, ("state",)).archive)


def informative_rows(payoff: Payoff, limit: int) -> list[int]:
    """Return the rows of a *payoff* matrix that preserve the ranking of its columns by their largest value.

    Args:
        payoff: ``float64[collaborators, individuals]``: their scores, at least one of each.
        limit: Largest number of rows.

    Returns:
        Different rows, the most informative first; of equal ones the first.
    """
    rows: list[int] = []
    best = np.full(payoff.shape[1], -np.inf)
    gains = payoff.max(axis=1)
    while len(rows) < limit and gains.max() > -np.inf:
        rows.append(int(gains.argmax()))
        best = np.maximum(best, payoff[rows[-1]])
        gains = _gains(payoff, best)
    return rows


def _gains(payoff: Payoff, best: Payoff) -> Payoff:
    """Return for each row the largest score by which it lifts a column above another one, or -inf.

    A column is lifted if its *best* value was not above that of the other, and is with the row.
    """
    extended = np.maximum(best, payoff)
    descending = np.argsort(-best, kind="stable")
    lowest = np.minimum.accumulate(extended[:, descending], axis=1)
    last_not_below = np.searchsorted(-best[descending], -best, side="right") - 1
    lifted = extended > lowest[:, last_not_below]
    gains: Payoff = np.where(lifted, payoff, -np.inf).max(axis=1)
    return gains


def _payoff(meetings: ScoredMeetings, population: str, other: str) -> tuple[list[int], Payoff]:
    """Return the clean individuals of *other* that met all members of *population*, and their scores.

    Of several meetings of the same two individuals, in runs of more than two populations, the best counts.

    Returns:
        Indices of these individuals, and ``float64[individuals, members]``; a diverged simulation is -inf.
    """
    place, other_place = meetings.populations.index(population), meetings.populations.index(other)
    individuals, n_members = meetings.members[other_place], meetings.present[place]
    present = meetings.meetings[:, place] < n_members
    who, whom = meetings.meetings[present, other_place], meetings.meetings[present, place]
    scores = meetings.scores[present]
    payoff = np.full((len(individuals), n_members), -np.inf)
    np.maximum.at(payoff, (who, whom), np.where(np.isnan(scores), -np.inf, scores))
    met = np.zeros(payoff.shape, dtype=bool)
    met[who, whom] = True
    complete = [
        index for index in np.flatnonzero(met.all(axis=1)).tolist() if not individuals[index].diverged
    ]
    return complete, payoff[complete]
