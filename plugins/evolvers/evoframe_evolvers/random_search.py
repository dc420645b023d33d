"""Random search: the evolver ``random``, a baseline of equal cost without selection."""

from __future__ import annotations

from random import Random
from typing import Any, Literal

import attrs
import neat
import numpy as np

from evoframe import ConfigurationError, structure
from evoframe_evolvers.cohort import Cohort, SavedCohort
from evoframe_evolvers.cppn import (
    NO_SELECTION,
    GenePool,
    GenomeOptions,
    NetworkRun,
    SavedPool,
    at_least,
)

__all__ = ["RandomSearch", "RandomSearchRun"]


@attrs.frozen(kw_only=True)
class RandomSearch(GenomeOptions):
    """Random search: a new population in every turn, independent of fitness.

    Each genome is initialized as in NEAT and then mutated several times; the number of mutations is drawn
    uniformly from 0 to *mutations*. Mutants of seeds, which only the first turn has, are mutated at least
    once. See :class:`GenomeOptions` for initialization and mutation.

    Attributes:
        mutations: Maximum number of mutations of a genome; with 0, every turn is like NEAT's initial turn.
    """

    mutations: int = at_least(0, 0)

    def check(self, size: int) -> None:
        """Require a population of at least one member."""
        if size < 1:
            raise ConfigurationError(f"expected a population of at least 1 member, found {size}")

    def start(self, inputs: int, outputs: int, size: int, rng: np.random.Generator) -> RandomSearchRun:
        """Start a search that draws *size* genomes per turn for networks with *inputs* and *outputs*."""
        self.check(size)
        return RandomSearchRun(GenePool(self, NO_SELECTION, inputs, outputs, rng), size, self.mutations)


@attrs.frozen
class _SavedRun:
    evolver: Literal["random"]
    pool: SavedPool
    cohort: SavedCohort


class RandomSearchRun(NetworkRun):
    """Random search in one population."""

    def __init__(self, pool: GenePool, size: int, mutations: int) -> None:
        self._pool = pool
        self._size = size
        self._mutations = mutations
        self._cohort = Cohort(self._draw_all())

    def _succeed(self) -> None:
        self._cohort.succeed(self._draw_all())

    def _draw_all(self) -> dict[int, Any]:
        self._pool.tracker.reset_generation()
        with self._pool.stream.swapped_in() as stream:
            genomes = [self._draw(stream) for _ in range(self._size)]
        return {genome.key: genome for genome in genomes}

    def _mutations_of_seeds(self, stream: Random) -> int:
        """Return a number of at least one mutation, since a seed itself is already a member."""
        return stream.randint(1, max(1, self._mutations))

    def _draw(self, stream: Random) -> Any:
        genome = neat.DefaultGenome(next(self._pool.genome_ids))
        genome.configure_new(self._pool.config.genome_config)
        times = stream.randint(0, self._mutations) if self._mutations else 0
        for _ in range(times):
            genome.mutate(self._pool.config.genome_config)
        return genome

    def state(self) -> Any:
        """Return everything needed to continue, as JSON values."""
        return {
            "evolver": "random",
            "pool": self._pool.state(),
            "cohort": self._cohort.state(self.dump),
        }

    def restore(self, state: Any) -> None:
        """Continue from the result of :meth:`state`.

        Raises:
            ValueError: *state* is not the state of a population of this kind; this run is unchanged.
        """
        saved = structure(state, _SavedRun, ("state",))
        cohort = self._saved_cohort(saved.cohort)
        self._pool.restore(saved.pool, cohort.genomes.values())
        self._cohort = cohort
