"""The genomes that an evolver asked about last, and what it was told of them."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import attrs
import numpy as np
from numpy.typing import NDArray

from evoframe import Member
from evoframe_evolvers.cppn.checked import entry, number, rows, whole

__all__ = ["Cohort"]

FITNESS_LIMIT = 1e100
"""neat-python adds and subtracts fitnesses without a thought of overflow."""


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
    def from_state(cls, state: Any, size: int, load: Callable[[Any], Any]) -> Cohort:
        """Return the cohort of *size* that :meth:`state` was taken of.

        Raises:
            ValueError: It is no such state.
        """
        saved = rows(state, "members")
        genomes = [load(entry(member, "genome", dict)) for member in saved]
        cohort = cls({genome.key: genome for genome in genomes}, whole(state, "generation", 0))
        if len(saved) != size or len(cohort.genomes) != size:
            raise ValueError(f"expected {size} different genomes, got {len(cohort.genomes)} of {len(saved)}")
        for genome, member in zip(genomes, saved, strict=True):
            cohort._recall(genome, member)
        cohort.phase = _phase(state, cohort)
        return cohort

    def _recall(self, genome: Any, member: Any) -> None:
        self.born[genome.key] = whole(member, "born", 0)
        if self.born[genome.key] > self.generation:
            raise ValueError(f"genome {genome.key} is born in the future")
        if entry(member, "fitness", object) is not None:
            self._note(genome, number(member, "fitness"))


def _phase(state: Any, cohort: Cohort) -> str:
    phase = entry(state, "phase", str)
    if phase not in ("new", "asked", "told"):
        raise ValueError(f"'phase' must be new, asked or told, not '{phase}'")
    if phase == "told" and len(cohort.fitness) < len(cohort.genomes):
        raise ValueError("a genome that was told about has no fitness")
    return phase
