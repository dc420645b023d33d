"""The current generation: its genomes, their ages and their fitness."""

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
"""Largest absolute fitness passed to neat-python, whose sums and differences could overflow."""


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
    """The current generation of a population.

    Attributes:
        genomes: Id -> genome, in the order of :meth:`ask`.
        generation: Number of generations before this one.
        born: Id -> generation in which the genome was created.
        fitness: Id -> latest fitness; evaluated genomes only.
        phase: ``new`` before :meth:`ask`, then ``asked``, and ``told`` after :meth:`tell`.
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
        """True if the next generation is due."""
        return self.phase == "told"

    def ask(self) -> list[Any]:
        """Return the genomes; can be called once per generation."""
        if self.phase != "new":
            raise RuntimeError("ask() called again before tell(): the last genomes have no fitness yet")
        self.phase = "asked"
        return list(self.genomes.values())

    def check_seeds(self, count: int) -> None:
        """Refuse a number of genomes from which the population shall start.

        Raises:
            ValueError: There are none, or more than members.
            RuntimeError: The initial genomes were already returned.
        """
        if self.generation or self.phase != "new":
            raise RuntimeError("seed() called after ask(): the initial genomes are already in use")
        if not 1 <= count <= len(self.genomes):
            raise ValueError(f"expected 1 to {len(self.genomes)} seeds, found {count}")

    def tell(self, fitness: NDArray[np.float64]) -> None:
        """Store the *fitness* of the genomes, in the order of :meth:`ask`."""
        if self.phase != "asked":
            raise RuntimeError("tell() called before ask(): no genomes are waiting for fitness")
        values = np.asarray(fitness, dtype=np.float64)
        if values.shape != (len(self.genomes),):
            raise ValueError(f"expected fitness of shape ({len(self.genomes)},), found {values.shape}")
        if not np.isfinite(values).all():
            raise ValueError(f"expected finite fitness, found {values[~np.isfinite(values)][0]}")
        for genome, value in zip(self.genomes.values(), values.tolist(), strict=True):
            self._set_fitness(genome, value)
        self.phase = "told"

    def _set_fitness(self, genome: Any, fitness: float) -> None:
        self.fitness[genome.key] = fitness
        genome.fitness = min(max(fitness, -FITNESS_LIMIT), FITNESS_LIMIT)

    def succeed(self, genomes: Mapping[int, Any]) -> None:
        """Replace the generation by *genomes*; survivors keep their fitness and age."""
        self.generation += 1
        self.genomes = dict(genomes)
        self.born = {key: self.born.get(key, self.generation) for key in genomes}
        self.fitness = {key: self.fitness[key] for key in genomes if key in self.fitness}
        self.phase = "new"

    def members(self, species: Callable[[int], int | None]) -> list[Member]:
        """Return the members; *species* returns the species of a genome id."""
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
        """Return the cohort from which :meth:`state` created *saved*.

        Args:
            saved: The document.
            genomes: Genomes of its members, in the same order.
            size: Population size.

        Raises:
            ValueError: The population size differs, or members contradict each other.
        """
        cohort = cls({genome.key: genome for genome in genomes}, saved.generation)
        if len(genomes) != size or len(cohort.genomes) != size:
            raise ValueError(
                f"expected {size} genomes with different ids, found {len(genomes)} genomes with "
                f"{len(cohort.genomes)} different ids"
            )
        for genome, member in zip(genomes, saved.members, strict=True):
            if member.born > saved.generation:
                raise ValueError(
                    f"genome {genome.key}: born in generation {member.born}, after the current generation "
                    f"{saved.generation}"
                )
            cohort.born[genome.key] = member.born
            if member.fitness is not None:
                cohort._set_fitness(genome, member.fitness)
        if saved.phase == "told" and len(cohort.fitness) < size:
            raise ValueError(
                f"expected a fitness for all {size} genomes in phase 'told', found {len(cohort.fitness)}"
            )
        cohort.phase = saved.phase
        return cohort
