"""The order in which populations reproduce."""

from __future__ import annotations

from collections.abc import Sequence

import attrs

from evoframe.contract import RunConfig
from evoframe.evolution.randomness import stream

__all__ = ["Timing", "timing_of"]


@attrs.frozen
class Timing:
    """The turns of a run after the initial one.

    Attributes:
        kind: ``sequential``, ``parallel`` or ``asynchronous``; see :class:`~evoframe.RunSettings`.
        weights: Turns of each population in a round.
        generations: Number of rounds.
        seed: Seed of the run, for the durations of asynchronous turns.
    """

    kind: str
    weights: tuple[int, ...]
    generations: int
    seed: int = 0

    @property
    def length(self) -> int:
        """Number of turns after the initial one."""
        return self.generations * (1 if self.kind == "parallel" else sum(self.weights))

    def reproducing(self, turn: int, clocks: Sequence[float]) -> tuple[int, ...]:
        """Return the indices of the populations that reproduce in a turn.

        Args:
            turn: Index of the turn, from 1.
            clocks: Simulated time of the next turn of each population; of asynchronous ones.
        """
        if self.kind == "parallel":
            return tuple(range(len(self.weights)))
        if self.kind == "asynchronous":
            return (min(range(len(clocks)), key=clocks.__getitem__),)
        return (self._round[(turn - 1) % len(self._round)],)

    def advanced(
        self, clocks: Sequence[float], turn: int, reproduced: Sequence[int], pairs: int
    ) -> tuple[float, ...]:
        """Return the clocks after a turn in which *reproduced* populations scored a number of *pairs*.

        Until its next turn, a population is occupied for an exponentially distributed time with mean 1 for
        each pair, so that the order of turns is as irregular as on a cluster, but depends only on the seed.
        """
        if self.kind != "asynchronous":
            return tuple(clocks)
        duration = float(stream(self.seed, f"timing/{turn}").standard_gamma(max(pairs, 1)))
        later = list(clocks)
        for index in reproduced:
            later[index] += duration / self.weights[index]
        return tuple(later)

    @property
    def _round(self) -> list[int]:
        return [index for index, weight in enumerate(self.weights) for _ in range(weight)]


def timing_of(config: RunConfig) -> Timing:
    """Return the order of turns that a configuration describes."""
    weights = tuple(population.turns for population in config.populations.values())
    return Timing(config.run.timing, weights, config.run.generations, config.run.seed)
