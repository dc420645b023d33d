"""Rank credit: individuals are compared with each other, collaborator by collaborator."""

from __future__ import annotations

from typing import ClassVar

import attrs
import numpy as np
from numpy.typing import NDArray

from evoframe import ScoredMeetings
from evoframe_aggregators.meetings import common, groups_of, mean_of_each_member
from evoframe_aggregators.scores import require_one

__all__ = ["Rank"]

UNDECIDED = 0.5


@attrs.frozen
class Rank:
    """Share of the other individuals that an individual beats with the same collaborators, from 0 to 1.

    For each collaborator (with three populations: for each pair of them), an individual has the share of the
    others evaluated with it whose score is lower; ties count half. Its fitness is the mean over its
    collaborators, so each of them has the same say, however large its scores are: the Borda count (1784),
    with collaborators as voters. Competitive coevolution counts defeated opponents in this way ("simple
    fitness" of Rosin and Belew, "New methods for competitive coevolution", Evolutionary Computation, 1997).

    A collaborator that nobody else met, or met without divergence, compares nobody and is left out; an
    individual without any comparison has 0.5. The fitness has no unit.
    """

    unit: ClassVar[str] = ""

    def check(self, n: int) -> None:
        """Require at least one collaborator."""
        require_one("rank", n)

    def credit(self, meetings: ScoredMeetings, population: int) -> NDArray[np.float64]:
        """Return the mean share of others that each member beats; diverged meetings are left out."""
        others = [role for role in range(len(meetings.populations)) if role != population]
        beaten = np.full(len(meetings.scores), np.nan)
        for indices in groups_of(common(meetings, others)):
            beaten[indices] = _shares_beaten(meetings.scores[indices])
        fitness = mean_of_each_member(meetings, population, beaten)
        return np.where(np.isnan(fitness), UNDECIDED, fitness)


def _shares_beaten(scores: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return for each score the share of the others that are lower, ties half; NaN without others."""
    shares = np.full(len(scores), np.nan)
    known = np.flatnonzero(~np.isnan(scores))
    if len(known) > 1:
        values = scores[known]
        ascending = np.sort(values)
        lower = np.searchsorted(ascending, values, side="left")
        not_higher = np.searchsorted(ascending, values, side="right")
        ties = not_higher - lower - 1
        shares[known] = (lower + ties / 2) / (len(known) - 1)
    return shares
