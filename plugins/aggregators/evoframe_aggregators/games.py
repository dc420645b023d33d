"""Credit from the game of a turn, whose players are the roles: difference rewards and the Shapley value.

The value of some roles of a meeting is the mean score of all meetings of the turn that have the same
individuals in these roles: the score to expect if only they are known. The value of all roles is the score of
the meeting itself, that of none the mean of all scores. Diverged meetings are left out.
"""

from __future__ import annotations

import itertools
import math
from collections import Counter
from collections.abc import Iterator

import attrs
import numpy as np
from attrs import validators
from numpy.typing import NDArray

from evoframe import ScoredMeetings
from evoframe_aggregators.meetings import common, mean_of_each_group, mean_of_each_member
from evoframe_aggregators.scores import require_one

__all__ = ["Difference", "Shapley"]

Roles = tuple[int, ...]
"""Indices of populations."""


@attrs.frozen
class _Game:
    """The game of a turn."""

    meetings: ScoredMeetings

    @property
    def roles(self) -> Roles:
        return tuple(range(len(self.meetings.populations)))

    def value(self, roles: Roles) -> NDArray[np.float64]:
        """Return the value of these roles in each meeting, ``float64[n]``; NaN if all of them diverged."""
        return mean_of_each_group(common(self.meetings, roles), self.meetings.scores)

    def gain(self, before: Roles, role: int) -> NDArray[np.float64]:
        """Return what *role* adds to the value of the roles *before* it, ``float64[n]``; NaN if diverged."""
        gained = self.value((*before, role)) - self.value(before)
        return np.where(np.isnan(self.meetings.scores), np.nan, gained)


@attrs.frozen
class Difference:
    """Loss of the team without the individual: difference rewards.

    The difference of an individual in a meeting is the score minus the mean score of all individuals of its
    population with the same collaborators, itself included; its fitness is the mean over its meetings. So
    good collaborators do not make everyone fit who met them. If all individuals meet the same collaborators,
    it ranks them as the mean does.

    Sources: Wolpert and Tumer, "Optimal payoff functions for members of collectives" (Advances in Complex
    Systems, 2001); Agogino and Tumer, "Analyzing and visualizing multiagent rewards in dynamic and stochastic
    domains" (Autonomous Agents and Multi-Agent Systems, 2008). An individual that is left out is replaced by
    the mean of its population, their *aristocrat utility*. The unit is that of the scores.
    """

    def check(self, n: int) -> None:
        """Require at least one collaborator."""
        require_one("difference", n)

    def credit(self, meetings: ScoredMeetings, population: int) -> NDArray[np.float64]:
        """Return the mean difference of each member; NaN if all of its meetings diverged."""
        game = _Game(meetings)
        others = tuple(role for role in game.roles if role != population)
        return mean_of_each_member(meetings, population, game.gain(others, population))


@attrs.frozen
class Shapley:
    """Shapley value of the individual's role, mean over its meetings.

    The roles of a meeting join one after another, each with its individual; what a role adds to the value
    (defined as for ``difference``, from meetings with the same individuals in these roles) is averaged over
    the orders in which they can join. In each meeting, the values of all roles sum to its score minus the
    mean of all scores.

    Sources: Shapley, "A value for n-person games" (Contributions to the Theory of Games II, 1953); Castro,
    Gómez, Tejada, "Polynomial calculation of the Shapley value based on sampling" (Computers & Operations
    Research, 2009). The unit is that of the scores.

    Attributes:
        samples: Largest number of orders, >= 1. With more possible ones (5 roles have 120), as many random
            ones are used, the same in all meetings of a turn.
        seed: Seed of the random orders, >= 0; they also depend on the turn.
    """

    samples: int = attrs.field(default=120, validator=validators.ge(1))
    seed: int = attrs.field(default=0, validator=validators.ge(0))

    def check(self, n: int) -> None:
        """Require at least one collaborator."""
        require_one("shapley", n)

    def credit(self, meetings: ScoredMeetings, population: int) -> NDArray[np.float64]:
        """Return the mean Shapley value of each member; NaN if all of its meetings diverged."""
        return mean_of_each_member(meetings, population, self.values(meetings, population))

    def values(self, meetings: ScoredMeetings, population: int) -> NDArray[np.float64]:
        """Return the Shapley value of a role in each meeting, ``float64[n]``; NaN if the meeting diverged."""
        game = _Game(meetings)
        joined = Counter(
            tuple(sorted(order[: order.index(population)]))
            for order in self._orders(len(game.roles), meetings.turn)
        )
        total = np.zeros(len(meetings.scores))
        for before, orders in sorted(joined.items()):
            total += orders / joined.total() * game.gain(before, population)
        return total

    def _orders(self, n: int, turn: int) -> Iterator[Roles]:
        """Yield all orders of *n* roles, or as many random ones as there are samples."""
        if math.factorial(n) <= self.samples:
            yield from itertools.permutations(range(n))
            return
        rng = np.random.default_rng([self.seed, turn])
        for _ in range(self.samples):
            yield tuple(rng.permutation(n).tolist())
