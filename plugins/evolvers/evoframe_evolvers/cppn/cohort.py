"""The present generation: its genomes, their ages and their fitness."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any, Literal

import attrs
import numpy as np
from attrs.validators import ge
from numpy.typing import NDArray

from evoframe import Member

__all__ = ["Cohort", "SavedCohort"]

FITNESS_LIMIT = 1e100
"""neat-python adds and subtracts fitnesses without a thought of overflow."""


@attrs.frozen
class _SavedMember:
    born: int = attrs.field(validator=ge(0))
    fitness: float | None
    genome: Any


@attrs.frozen
class SavedCohort:
    """The document that :meth:`Cohort.state` returns."""

    generation: int = attrs.field(validator=ge(0))
    phase: Literal["new", "asked", "told"]
    members: tuple[_SavedMember, ...]


@attrs.define
class Cohort:
    """The present generation of a population.

    Attributes:
        genomes: Id -> genome, in the order of :meth:`ask`.
        generation: How many generations came before.
        born: Id -> the generation in which the genome came into being.
        fitness: Id -> the latest fitness, where there is one.
        phase: ``new`` until asked for, then ``asked`` until told about, then ``told``.
    """

    genomes: dict[int, Any]
    generation: int = 0
    born: dict[int, int] = attrs.field(init=False)
    fitness: dict[int, float] = attrs.field(init=False, factory=dict)
    phase: str = attrs.field(init=False, default="new")

    def __attrs_post_init__(self) -> None:
        self.born = dict.fromkeys(self.genomes, self.generation)

    @property
    def finished(self) -> bool:
        """Whether the next generation is due."""
        return self.phase == "told"

    def ask(self) -> list[Any]:
        """Hand out the genomes, once."""
        if self.phase != "new":
            raise RuntimeError("ask() again before tell(): the fitness of the last genomes is missing")
        self.phase = "asked"
        return list(self.genomes.values())

    def tell(self, fitness: NDArray[np.float64]) -> None:
        """Note the *fitness* of the genomes, in the order of :meth:`ask`."""
        if self.phase != "asked":
            raise RuntimeError("tell() without ask(): there are no genomes to be told about")
        values = np.asarray(fitness, dtype=np.float64)
        if values.shape != (len(self.genomes),):
            raise ValueError(f"expected fitness of shape ({len(self.genomes)},), got {values.shape}")
        if not np.isfinite(values).all():
            raise ValueError(f"fitness must be finite, got {values[~np.isfinite(values)][0]} for a genome")
        for genome, value in zip(self.genomes.values(), values.tolist(), strict=True):
            self._note(genome, value)
        self.phase = "told"

    def _note(self, genome: Any, fitness: float) -> None:
        self.fitness[genome.key] = fitness
        genome.fitness = min(max(fitness, -FITNESS_LIMIT), FITNESS_LIMIT)

    def succeed(self, genomes: Mapping[int, Any]) -> None:
        """Make *genomes* the next generation; those that were here before keep fitness and age."""
        self.generation += 1
        self.genomes = dict(genomes)
        self.born = {key: self.born.get(key, self.generation) for key in genomes}
        self.fitness = {key: self.fitness[key] for key in genomes if key in self.fitness}
        self.phase = "new"

    def members(self, species: Callable[[int], int | None]) -> list[Member]:
        """Return the members; *species* says to which one an id belongs."""
        return [
            Member(
                id=key,
                fitness=self.fitness.get(key),
                species=species(key),
                genome_size=sum(genome.size()),
                age=self.generation - self.born[key],
            )
            for key, genome in self.genomes.items()
        ]

    def state(self, dump: Callable[[Any], Any]) -> dict[str, Any]:
        """Return this generation as JSON values."""
        return {
            "generation": self.generation,
            "phase": self.phase,
            "members": [
                {"born": self.born[key], "fitness": self.fitness.get(key), "genome": dump(genome)}
                for key, genome in self.genomes.items()
            ],
        }

    @classmethod
    def from_state(cls, saved: SavedCohort, genomes: Sequence[Any], size: int) -> Cohort:
        """Return the cohort that :meth:`state` was taken of.

        Args:
            saved: The document.
            genomes: The genomes of its members, in their order.
            size: Number of members of the population.

        Raises:
            ValueError: The members are not such a population, or contradict each other.
        """
        cohort = cls({genome.key: genome for genome in genomes}, saved.generation)
        if len(genomes) != size or len(cohort.genomes) != size:
            raise ValueError(
                f"expected {size} different genomes, got {len(cohort.genomes)} of {len(genomes)}"
            )
        for genome, member in zip(genomes, saved.members, strict=True):
            if member.born > saved.generation:
                raise ValueError(f"genome {genome.key} is born in the future")
            cohort.born[genome.key] = member.born
            if member.fitness is not None:
                cohort._note(genome, member.fitness)
        if saved.phase == "told" and len(cohort.fitness) < size:
            raise ValueError("a genome that was told about has no fitness")
        cohort.phase = saved.phase
        return cohort
