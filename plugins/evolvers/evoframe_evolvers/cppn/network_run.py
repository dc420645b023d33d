"""Base class for the evolution of networks; subclasses add the reproduction."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from random import Random
from typing import Any

import numpy as np
from numpy.typing import NDArray

from evoframe import Member, Network
from evoframe_evolvers.cohort import Cohort, SavedCohort
from evoframe_evolvers.cppn.documents import dump_genome
from evoframe_evolvers.cppn.genomes import GenePool

__all__ = ["NetworkRun"]


class NetworkRun(ABC):
    """Evolution of the genomes of a pool; subclasses set the pool, the size and the first cohort."""

    _pool: GenePool
    _cohort: Cohort
    _size: int

    @abstractmethod
    def _succeed(self) -> None:
        """Replace the evaluated cohort by the next generation."""

    def _species(self, genome_id: int) -> int | None:  # noqa: ARG002
        """Return the species of a genome; ``None`` for evolvers without species."""
        return None

    def _mutations_of_seeds(self, stream: Random) -> int:  # noqa: ARG002
        """Return the number of mutations of a mutant of a seed."""
        return 1

    def _begin(self, genomes: dict[int, Any]) -> None:
        """Replace the initial population."""
        self._cohort = Cohort(genomes)

    def seed(self, genomes: Sequence[Any]) -> None:
        """Start from *genomes* with new ids, and from mutants of them, in turn.

        Raises:
            ValueError: There are none, or more than members.
            RuntimeError: The initial population was already asked for.
        """
        self._cohort.check_seeds(len(genomes))
        seeds = self._pool.adopt(genomes)
        with self._pool.stream.swapped_in() as stream:
            rest = range(self._size - len(seeds))
            mutants = [
                self._pool.mutant(seeds[n % len(seeds)], self._mutations_of_seeds(stream)) for n in rest
            ]
        self._begin({genome.key: genome for genome in [*seeds, *mutants]})

    def ask(self) -> Sequence[Any]:
        """Return the genomes to evaluate: first the initial ones, then those of the next generation."""
        if self._cohort.finished:
            self._succeed()
        return self._cohort.ask()

    def tell(self, fitness: NDArray[np.float64], measures: Mapping[str, NDArray[np.float64]]) -> None:  # noqa: ARG002
        """Store the *fitness* of the genomes of the last :meth:`ask`; *measures* are not used."""
        self._cohort.tell(fitness)

    def genomes(self) -> Sequence[Any]:
        """Return the genomes of :meth:`members`, also after :meth:`restore`."""
        return list(self._cohort.genomes.values())

    def members(self) -> Sequence[Member]:
        """Return the current members, in the order of the last :meth:`ask`."""
        return self._cohort.members(self._species)

    def express(self, genome: Any) -> Network:
        """Return the network that *genome* encodes."""
        return self._pool.express(genome)

    def dump(self, genome: Any) -> Any:
        """Return *genome* as JSON values."""
        return dump_genome(genome)

    def load(self, dumped: Any) -> Any:
        """Return the genome that :meth:`dump` returned as *dumped*, possibly in another run.

        Raises:
            ValueError: It is not a genome of this population; the message describes the fault.
        """
        return self._pool.load(dumped, ("genome",))

    def _saved_cohort(self, saved: SavedCohort) -> Cohort:
        """Return the cohort of a saved state."""
        genomes = [
            self._pool.load(member.genome, ("state", "cohort", f"members[{n}]", "genome"))
            for n, member in enumerate(saved.members)
        ]
        return Cohort.from_state(saved, genomes, self._size)

    @abstractmethod
    def state(self) -> Any:
        """Return everything needed to continue, as JSON values."""

    @abstractmethod
    def restore(self, state: Any) -> None:
        """Continue from the result of :meth:`state`."""
