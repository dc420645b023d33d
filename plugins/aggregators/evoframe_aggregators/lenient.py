"""Lenient credit: at first only the best scores of an individual count, later all of them."""

from __future__ import annotations

import math

import attrs
import numpy as np
from attrs import validators
from numpy.typing import NDArray

from evoframe import ScoredMeetings
from evoframe_aggregators.scores import ascending, require_one

__all__ = ["Lenient"]


@attrs.frozen
class Lenient:
    """Mean of an individual's best scores, whose number changes from turn to turn: lenient learning.

    Bad scores with collaborators that do not suit an individual are forgiven as long as collaborators are
    immature. Of n scores, the best and the share *start* of the other n - 1 count in turn 0, in later turns a
    share that changes linearly to *end* in turn *turns*. Shares are rounded to whole scores. The share 0 is
    ``max``, the share 1 is ``am``.

    Sources: Panait, Sullivan, Luke, "Lenient learners in cooperative multiagent systems" (AAMAS 2006), and
    Panait, Tuyls, Luke, "Theoretical advantages of lenient learners" (Journal of Machine Learning Research,
    2008), where an action is judged by the best of several rewards. Here the collaborators of a turn take
    the place of repeated rewards.

    Attributes:
        start: Share of the scores besides the best that count in turn 0, from 0 to 1.
        end: Share that counts from turn *turns* on, from 0 to 1.
        turns: Number of turns of all populations in which *start* changes to *end*, >= 1.
    """

    start: float = attrs.field(default=0.0, validator=[validators.ge(0), validators.le(1)])
    end: float = attrs.field(default=1.0, validator=[validators.ge(0), validators.le(1)])
    turns: int = attrs.field(default=200, validator=validators.ge(1))

    def check(self, n: int) -> None:
        """Require at least one collaborator."""
        require_one("lenient", n)

    def credit(self, meetings: ScoredMeetings, population: int) -> NDArray[np.float64]:
        """Return the mean of each member's best scores, in their unit; diverged ones are left out."""
        share = self._share(meetings.turn)
        own = [meetings.scores[indices] for indices in meetings.of(population)]
        return np.array([_mean_of_best(scores[~np.isnan(scores)], share) for scores in own])

    def _share(self, turn: int) -> float:
        passed = min(turn / self.turns, 1.0)
        return (1 - passed) * self.start + passed * self.end


def _mean_of_best(scores: NDArray[np.float64], share: float) -> float:
    """Return the mean of the best of *scores*, and of a *share* of the others; NaN if there are none."""
    if not len(scores):
        return math.nan
    others = math.floor(share * (len(scores) - 1) + 0.5)
    best = ascending(scores)[-1 - others :]
    return math.fsum(best) / len(best)
