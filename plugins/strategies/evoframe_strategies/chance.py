"""Strategies that draw members at random, all alike or the fitter ones more often; never one twice."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import attrs
import numpy as np
from attrs import validators
from numpy.typing import NDArray

from evoframe import Member
from evoframe_strategies.ranking import ChooseN, Indices, as_indices, best_first, clean_first

__all__ = ["BestAndRandom", "Random", "Rank", "Roulette", "Tournament", "draw_alike"]

Weights = NDArray[np.float64]


@attrs.frozen
class Random(ChooseN):
    """*n* members drawn at random, without repeats (by the authors of arXiv 2510.24510).

    Attributes:
        n: Number of collaborators.
    """

    def select(self, members: Sequence[Member], rng: np.random.Generator) -> Indices:
        """Return indices of *members*, in the order in which *rng* draws them."""
        return as_indices(draw_alike(members, range(len(members)), self.size(len(members)), rng))


@attrs.frozen
class BestAndRandom(ChooseN):
    """The fittest member, and *n* - 1 of the others drawn at random.

    Source: Potter and De Jong 1994, "A cooperative coevolutionary approach to function optimization", PPSN
    III: CCGA-2, in which individuals meet the best and one random member.

    Attributes:
        n: Number of collaborators, the fittest included; 1 chooses only the fittest.
    """

    def select(self, members: Sequence[Member], rng: np.random.Generator) -> Indices:
        """Return the index of the fittest of *members*, then indices in the order in which *rng* draws."""
        size = self.size(len(members))
        best, *others = best_first(members)
        return as_indices([best, *draw_alike(members, sorted(others), size - 1, rng)])


@attrs.frozen
class Tournament(ChooseN):
    """The winners of *n* tournaments among members drawn at random.

    Contestants of a tournament are different, and have not been chosen before. The fittest of them wins, of
    equals that with the lowest index. Source: Goldberg and Deb 1991, "A comparative analysis of selection
    schemes used in genetic algorithms", FOGA 1; for collaborators Wiegand, Liles and De Jong 2001, GECCO
    (collaborator selection pressure).

    Attributes:
        n: Number of collaborators.
        tournament_size: Number of contestants; in smaller populations everybody takes part. 1 chooses at
            random.
    """

    tournament_size: int = attrs.field(default=2, validator=validators.ge(1))

    def select(self, members: Sequence[Member], rng: np.random.Generator) -> Indices:
        """Return the indices of the winners among *members*, in the order of their tournaments."""
        size = self.size(len(members))
        ranks = np.argsort(best_first(members))

        def win(pool: list[int], n: int) -> list[int]:
            left, winners = np.array(pool, dtype=np.intp), list[int]()
            for _ in range(n):
                contestants = rng.choice(left, size=min(self.tournament_size, len(left)), replace=False)
                winners.append(int(contestants[np.argmin(ranks[contestants])]))
                left = left[left != winners[-1]]
            return winners

        return as_indices(clean_first(members, range(len(members)), size, win))


@attrs.frozen
class Roulette(ChooseN):
    """*n* members drawn with probabilities proportional to their fitness, without repeats.

    Fitness is measured from the worst member that can be drawn, so that it can be negative: the worst is
    drawn only if no other is left, and members of equal fitness are drawn alike. Source: Holland 1975,
    "Adaptation in natural and artificial systems" (fitness-proportional selection).

    Attributes:
        n: Number of collaborators.
    """

    def select(self, members: Sequence[Member], rng: np.random.Generator) -> Indices:
        """Return indices of *members*, in the order in which *rng* draws them."""
        return _draw_weighted(members, self.size(len(members)), _above_the_worst, rng)


@attrs.frozen
class Rank(ChooseN):
    """*n* members drawn with probabilities that fall linearly with their rank, without repeats.

    Of N members, the fittest is first drawn with the probability *pressure* / N, and the worst with
    (2 - *pressure*) / N; members of equal fitness are ranked by index. Source: Baker 1985, "Adaptive
    selection methods for genetic algorithms", ICGA 1.

    Attributes:
        n: Number of collaborators.
        pressure: Selection pressure; with 1, all members are drawn alike, with 2, the worst only if no other
            is left.
    """

    pressure: float = attrs.field(default=1.5, validator=[validators.ge(1.0), validators.le(2.0)])

    def select(self, members: Sequence[Member], rng: np.random.Generator) -> Indices:
        """Return indices of *members*, in the order in which *rng* draws them."""
        return _draw_weighted(members, self.size(len(members)), self._weights, rng)

    def _weights(self, ranked: Sequence[Member]) -> Weights:
        return np.linspace(self.pressure, 2.0 - self.pressure, len(ranked), dtype=np.float64)


def draw_alike(
    members: Sequence[Member], indices: Sequence[int], n: int, rng: np.random.Generator
) -> list[int]:
    """Return *n* of the *indices* of members, drawn with equal probabilities; clean members first."""

    def draw(pool: list[int], count: int) -> list[int]:
        drawn: list[int] = rng.choice(np.array(pool, dtype=np.intp), size=count, replace=False).tolist()
        return drawn

    return clean_first(members, indices, n, draw)


def _draw_weighted(
    members: Sequence[Member],
    n: int,
    weigh: Callable[[Sequence[Member]], Weights],
    rng: np.random.Generator,
) -> Indices:
    """Draw *n* members without repeats; *weigh* returns the weights of members, the fittest first."""

    def draw(pool: list[int], count: int) -> list[int]:
        left, drawn = list(pool), list[int]()
        weights = weigh([members[index] for index in pool])
        for _ in range(count):
            place = int(rng.choice(len(left), p=_probabilities(weights)))
            drawn.append(left.pop(place))
            weights = np.delete(weights, place)
        return drawn

    return as_indices(clean_first(members, best_first(members), n, draw))


def _above_the_worst(ranked: Sequence[Member]) -> Weights:
    """Return half of what the fitness of each member exceeds that of the worst; the last is the worst."""
    halves = np.array([member.fitness for member in ranked], dtype=np.float64) / 2.0  # never overflows
    return halves - halves[-1:]


def _probabilities(weights: Weights) -> Weights:
    """Return *weights* divided by their sum; equal probabilities if all are 0."""
    largest = weights.max()
    if largest == 0.0:
        return np.full(len(weights), 1.0 / len(weights))
    shares: Weights = weights / largest
    return shares / float(shares.sum())
