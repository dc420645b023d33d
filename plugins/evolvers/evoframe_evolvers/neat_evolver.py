"""NEAT: the evolver ``neat``, an ask/tell adapter around neat-python."""

from __future__ import annotations

import logging
from collections.abc import Mapping, Sequence
from typing import Any, Literal

import attrs
import neat
import numpy as np
from attrs.validators import ge, in_
from neat.reporting import ReporterSet
from neat.species import Species

from evoframe import ConfigurationError, structure
from evoframe_evolvers.cohort import Cohort, SavedCohort
from evoframe_evolvers.cppn import (
    Counter,
    GenePool,
    GenomeOptions,
    NetworkRun,
    SavedPool,
    Sections,
    at_least,
    finite,
    probability,
)
from evoframe_evolvers.crowding import ExactReproduction, RoomyStagnation

__all__ = ["Neat", "NeatRun"]

_log = logging.getLogger(__name__)


@attrs.frozen(kw_only=True)
class Neat(GenomeOptions):
    """NeuroEvolution of Augmenting Topologies (Stanley and Miikkulainen 2002), by neat-python 2.0.

    The defaults come from the paper's table or, for options that it does not list, from the authors'
    configuration. See :class:`GenomeOptions` for the initialization and mutation of genomes.

    If the elites or minimum sizes of all species exceed the population size, *elitism* and
    *min_species_size* are 1 for that turn. If every species goes extinct, which requires
    *species_elitism* = 0, the population is initialized again.

    Attributes:
        compatibility_threshold: A genome belongs to a species if its genetic distance to the species'
            representative is less than this (paper).
        compatibility_disjoint: Weight in the genetic distance of each gene that only one genome has (paper).
        compatibility_weight: Weight in the genetic distance of the differences between genes that both
            genomes have: in weight and bias, and 1 for a different activation or enabled state (paper).
        max_stagnation: Generations without improvement after which a species goes extinct (paper).
        species_elitism: Number of the best species that cannot go extinct (authors' configuration).
        species_fitness: Fitness of a species: the ``max``, ``mean``, ``min`` or ``median`` of its members
            (authors' configuration).
        elitism: Number of the best members of each species that survive unchanged (authors' configuration).
        survival_threshold: Fraction of each species, the best first, that can become parents (paper).
        min_species_size: Minimum number of members of a species (neat-python's default).
    """

    compatibility_threshold: float = attrs.field(default=3.0, validator=ge(0.0))
    compatibility_disjoint: float = attrs.field(default=1.0, validator=[finite, ge(0.0)])
    compatibility_weight: float = attrs.field(default=0.5, validator=[finite, ge(0.0)])
    max_stagnation: int = at_least(1, 25)
    species_elitism: int = at_least(0, 2)
    species_fitness: str = attrs.field(default="max", validator=in_(("max", "mean", "min", "median")))
    elitism: int = at_least(0, 2)
    survival_threshold: float = probability(0.6)
    min_species_size: int = at_least(1, 1)

    def check(self, size: int) -> None:
        """Require a population of *size* that can have offspring."""
        if size < 1:
            raise ConfigurationError(f"expected a population of at least 1 member, found {size}")
        if self.elitism >= size:
            raise ConfigurationError(
                f"elitism = {self.elitism} prevents offspring in a population of {size}; "
                f"set it to less than {size}"
            )
        if self.min_species_size > size:
            raise ConfigurationError(
                f"min_species_size = {self.min_species_size} exceeds the population size {size}; "
                f"set it to {size} or less"
            )

    def start(self, inputs: int, outputs: int, size: int, rng: np.random.Generator) -> NeatRun:
        """Initialize *size* genomes that encode networks with *inputs* and *outputs*."""
        self.check(size)
        return NeatRun(GenePool(self, _selection(self), inputs, outputs, rng), size)


def _selection(options: Neat) -> Sections:
    return {
        "DefaultGenome": {
            "compatibility_disjoint_coefficient": options.compatibility_disjoint,
            "compatibility_weight_coefficient": options.compatibility_weight,
        },
        "DefaultSpeciesSet": {"compatibility_threshold": options.compatibility_threshold},
        "DefaultStagnation": {
            "species_fitness_func": options.species_fitness,
            "max_stagnation": options.max_stagnation,
            "species_elitism": options.species_elitism,
        },
        "DefaultReproduction": {
            "elitism": options.elitism,
            "survival_threshold": options.survival_threshold,
            "min_species_size": options.min_species_size,
        },
    }


@attrs.frozen
class _SavedSpecies:
    id: int = attrs.field(validator=ge(1))
    created: int = attrs.field(validator=ge(0))
    last_improved: int = attrs.field(validator=ge(0))
    representative: int
    members: tuple[int, ...]
    fitness: float | None
    adjusted_fitness: float | None
    best_fitness: float | None


@attrs.frozen
class _SavedRun:
    evolver: Literal["neat"]
    pool: SavedPool
    cohort: SavedCohort
    next_species: int = attrs.field(validator=ge(1))
    species: tuple[_SavedSpecies, ...]


class NeatRun(NetworkRun):
    """Evolution of one population by NEAT."""

    def __init__(self, pool: GenePool, size: int) -> None:
        config, reporters = pool.config, ReporterSet()
        stagnation = RoomyStagnation(config.stagnation_config, reporters, config.reproduction_config)
        self._pool = pool
        self._size = size
        self._reproduction = ExactReproduction(config.reproduction_config, reporters, stagnation)
        self._reproduction.genome_indexer = pool.genome_ids
        self._reproduction.innovation_tracker = pool.tracker
        self._species_set = neat.DefaultSpeciesSet(config.species_set_config, reporters)
        self._species_set.indexer = Counter(1)
        with pool.stream.swapped_in():
            genomes = self._create()
            self._species_set.speciate(config, genomes, 0)
        self._cohort = Cohort(genomes)

    def _species(self, genome_id: int) -> int | None:
        species: int = self._species_set.get_species_id(genome_id)
        return species

    def _create(self) -> dict[int, Any]:
        config = self._pool.config
        genomes: dict[int, Any] = self._reproduction.create_new(
            config.genome_type, config.genome_config, self._size
        )
        self._reproduction.ancestors.clear()
        return genomes

    def _begin(self, genomes: dict[int, Any]) -> None:
        self._species_set.species, self._species_set.indexer.value = {}, 1
        self._species_set.speciate(self._pool.config, genomes, 0)
        super()._begin(genomes)

    def _succeed(self) -> None:
        config, generation = self._pool.config, self._cohort.generation
        with self._pool.stream.swapped_in():
            offspring = self._reproduction.reproduce(config, self._species_set, self._size, generation)
            if not offspring:
                _log.warning("every species went extinct in generation %d; starting again", generation)
                offspring = self._create()
            self._species_set.speciate(config, offspring, generation)
        self._cohort.succeed(offspring)

    def state(self) -> Any:
        """Return everything needed to continue, as JSON values."""
        return {
            "evolver": "neat",
            "pool": self._pool.state(),
            "cohort": self._cohort.state(self.dump),
            "next_species": self._species_set.indexer.value,
            "species": [_dump_species(species) for species in self._species_set.species.values()],
        }

    def restore(self, state: Any) -> None:
        """Continue from the result of :meth:`state`.

        Raises:
            ValueError: *state* is not the state of a population of this kind; this run is unchanged.
        """
        saved = structure(state, _SavedRun, ("state",))
        cohort = self._saved_cohort(saved.cohort)
        species = [_load_species(kind, cohort.genomes) for kind in saved.species]
        _check_partition(species, cohort.genomes, saved.next_species)
        self._pool.restore(saved.pool, cohort.genomes.values())
        self._cohort = cohort
        self._species_set.indexer.value = saved.next_species
        self._species_set.species = {kind.key: kind for kind in species}
        self._species_set.genome_to_species = {key: kind.key for kind in species for key in kind.members}


def _dump_species(species: Any) -> dict[str, Any]:
    return {
        "id": species.key,
        "created": species.created,
        "last_improved": species.last_improved,
        "representative": species.representative.key,
        "members": list(species.members),
        "fitness": species.fitness,
        "adjusted_fitness": species.adjusted_fitness,
        # The only value of the history that neat-python uses; the history itself grows in every turn.
        "best_fitness": max(species.fitness_history, default=None),
    }


def _load_species(saved: _SavedSpecies, genomes: Mapping[int, Any]) -> Any:
    for key in (saved.representative, *saved.members):
        if key not in genomes:
            raise ValueError(f"species {saved.id}: member {key} is not in the population")
    species = Species(saved.id, saved.created)
    species.last_improved = saved.last_improved
    species.update(genomes[saved.representative], {key: genomes[key] for key in saved.members})
    species.fitness, species.adjusted_fitness = saved.fitness, saved.adjusted_fitness
    species.fitness_history = [] if saved.best_fitness is None else [saved.best_fitness]
    return species


def _check_partition(species: Sequence[Any], genomes: Mapping[int, Any], next_species: int) -> None:
    """Require that every genome belongs to exactly one species, and that species have unique ids."""
    members = [key for kind in species for key in kind.members]
    if sorted(members) != sorted(genomes):
        raise ValueError("state.species: expected every member of the population in exactly one species")
    keys = {kind.key for kind in species}
    if len(keys) < len(species) or max(keys) >= next_species or not all(kind.members for kind in species):
        raise ValueError(
            f"state.species: expected non-empty species with unique ids below {next_species}, found ids "
            f"{sorted(kind.key for kind in species)}"
        )
