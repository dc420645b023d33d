"""The laws of loading and seeds catch runs that break them."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Sequence
from typing import Any, ClassVar

import attrs
import numpy as np
import pytest
from contracts import starting
from numpy.typing import NDArray

from evoframe import ConfigurationError, Member, Network
from evoframe.testing import EvolverContract

LOADED = "test_a_loaded_genome_is_the_dumped_one"
LOADING = "test_loading_changes_neither_the_run_nor_the_document"
DAMAGED = "test_a_damaged_genome_is_not_loaded"
BEGINS = "test_the_initial_population_begins_with_the_seeds"
MUTANTS = "test_mutants_of_the_seeds_fill_the_initial_population"
IDS = "test_ids_of_a_seeded_run_stand_for_one_genome"
NEW = "test_initial_members_of_a_seeded_run_are_new"
EQUAL = "test_seeded_runs_with_the_same_seed_are_equal"
RESTORED = "test_a_seeded_run_is_restored_without_its_seeds"
KEPT = "test_seeds_are_not_changed"
NUMBER = "test_a_wrong_number_of_seeds_is_refused"

Weights = list[list[float]]


@attrs.define(eq=False)
class Genome:
    id: int
    weights: Weights


class Walking:
    """A valid run of mutation without selection, and the base of the broken ones."""

    def __init__(self, inputs: int, outputs: int, size: int, rng: np.random.Generator) -> None:
        self.shape = (inputs, outputs)
        self.size = size
        self.rng = rng
        self.next_id = 0
        self.bias = 0.0
        self.fitness: list[float] | None = None
        self.asked = False
        self.population = [self.born(self.noise()) for _ in range(size)]

    def born(self, weights: Weights) -> Genome:
        self.next_id += 1
        return Genome(self.next_id, weights)

    def noise(self) -> Weights:
        weights: Weights = self.rng.normal(size=self.shape).tolist()
        return weights

    def mutant(self, genome: Genome) -> Genome:
        noise = self.rng.normal(self.bias, 0.1, size=self.shape)
        return self.born((np.array(genome.weights) + noise).tolist())

    def ask(self) -> Sequence[Any]:
        if self.fitness is not None:
            self.population = [self.mutant(genome) for genome in self.population]
            self.fitness = None
        self.asked = True
        return self.population

    def tell(self, fitness: NDArray[np.float64], measures: Any) -> None:
        if fitness.shape != (self.size,) or not np.isfinite(fitness).all():
            raise ValueError(f"expected {self.size} finite values")
        self.fitness = fitness.tolist()

    def members(self) -> Sequence[Member]:
        fitness: Sequence[float | None] = self.fitness or [None] * self.size
        return [Member(genome.id, f) for genome, f in zip(self.population, fitness, strict=True)]

    def genomes(self) -> Sequence[Any]:
        return self.population

    def express(self, genome: Genome) -> Network:
        weights = np.array(genome.weights)
        return lambda points: np.tanh(points @ weights)

    def dump(self, genome: Genome) -> Any:
        return {"id": genome.id, "weights": [[*row] for row in genome.weights]}

    def load(self, dumped: Any) -> Genome:
        try:
            weights = np.array(dumped["weights"], dtype=np.float64)
            id_ = int(dumped["id"])
        except (KeyError, TypeError, OverflowError) as error:
            raise ValueError("not a genome") from error
        if weights.shape != self.shape or not np.isfinite(weights).all():
            raise ValueError("not a genome")
        return Genome(id_, weights.tolist())

    def seed(self, genomes: Sequence[Genome]) -> None:
        if not 1 <= len(genomes) <= self.size:
            raise ValueError(f"expected 1 to {self.size} genomes, found {len(genomes)}")
        seeds = [self.born(genome.weights) for genome in genomes]
        missing = itertools.islice(itertools.cycle(genomes), self.size - len(seeds))
        self.population = seeds + [self.mutant(genome) for genome in missing]

    def state(self) -> Any:
        return {
            "population": [self.dump(genome) for genome in self.population],
            "fitness": self.fitness,
            "next_id": self.next_id,
            "rng": self.rng.bit_generator.state,
        }

    def restore(self, state: Any) -> None:
        self.population = [self.load(genome) for genome in state["population"]]
        self.fitness, self.next_id = state["fitness"], state["next_id"]
        self.rng.bit_generator.state = state["rng"]


@attrs.frozen
class Walker:
    """A valid evolver, and the base of the broken ones."""

    run: ClassVar[type[Any]] = Walking

    def check(self, size: int) -> None:
        if size < 1:
            raise ConfigurationError(f"a population of {size} cannot walk")

    def start(self, inputs: int, outputs: int, size: int, rng: np.random.Generator) -> Any:
        return self.run(inputs, outputs, size, rng)


class TestWalker(EvolverContract):
    component = Walker()


class TestWalkerAlone(EvolverContract):
    component = Walker()
    size = 1
    turns = 2


class Rounds(Walking):
    def load(self, dumped: Any) -> Genome:
        genome = super().load(dumped)
        return Genome(genome.id, np.round(genome.weights, 6).tolist())


class LoadsUnderAnotherId(Walking):
    def load(self, dumped: Any) -> Genome:
        return self.born(super().load(dumped).weights)


class LoadsWhatItKnows(Walking):
    """Returns its own genome with the same id."""

    def load(self, dumped: Any) -> Genome:
        loaded = super().load(dumped)
        return next((genome for genome in self.population if genome.id == loaded.id), loaded)


class EmptiesTheDocument(Walking):
    def load(self, dumped: Any) -> Genome:
        genome = super().load(dumped)
        dumped.clear()
        return genome


class ValidatesNothing(Walking):
    def load(self, dumped: Any) -> Genome:
        return Genome(dumped["id"], dumped["weights"])


class AcceptsAnyShape(Walking):
    def load(self, dumped: Any) -> Genome:
        try:
            return Genome(0, np.array(dumped["weights"], np.float64).tolist())
        except (KeyError, TypeError, OverflowError) as error:
            raise ValueError("not a genome") from error


class ReplacesJunkByNaN(Walking):
    def load(self, dumped: Any) -> Genome:
        try:
            return super().load(dumped)
        except ValueError:
            return Genome(0, np.full(self.shape, np.nan).tolist())


class SeedsBackwards(Walking):
    def seed(self, genomes: Sequence[Genome]) -> None:
        super().seed(genomes[::-1])


class MutatesTheSeeds(Walking):
    def seed(self, genomes: Sequence[Genome]) -> None:
        super().seed([self.mutant(genome) for genome in genomes])


class AddsTheSeeds(Walking):
    def seed(self, genomes: Sequence[Genome]) -> None:
        before = self.population
        super().seed(genomes)
        self.population += before
        self.size = len(self.population)


class SeedsOnly(Walking):
    def seed(self, genomes: Sequence[Genome]) -> None:
        super().seed(genomes)
        self.population = self.population[: len(genomes)]
        self.size = len(genomes)


class Clones(Walking):
    def seed(self, genomes: Sequence[Genome]) -> None:
        super().seed(genomes)
        clones = [self.born(genomes[0].weights) for _ in self.population[len(genomes) :]]
        self.population[len(genomes) :] = clones


class KeepsIds(Walking):
    def seed(self, genomes: Sequence[Genome]) -> None:
        super().seed(genomes)
        self.population[: len(genomes)] = genomes


class KeepsIdsOfDifferentSeeds(Walking):
    """Ids are unique at first, but given to other genomes again later."""

    def seed(self, genomes: Sequence[Genome]) -> None:
        super().seed(genomes)
        for number, genome in enumerate(self.population):
            genome.id = number + 3
        self.next_id = 2


class Remembers(Walking):
    fitness_of_seeds: float | None = None

    def seed(self, genomes: Sequence[Genome]) -> None:
        super().seed(genomes)
        self.fitness_of_seeds = 1.0

    def members(self) -> Sequence[Member]:
        return [
            member if member.fitness is not None else attrs.evolve(member, fitness=self.fitness_of_seeds)
            for member in super().members()
        ]


class FreshRandom(Walking):
    def seed(self, genomes: Sequence[Genome]) -> None:
        self.rng = np.random.default_rng()
        super().seed(genomes)


class ForgetsThatItWasSeeded(Walking):
    def seed(self, genomes: Sequence[Genome]) -> None:
        super().seed(genomes)
        self.bias = 1.0


class TakesTheSeeds(Walking):
    def seed(self, genomes: Sequence[Genome]) -> None:
        super().seed(genomes)
        for genome in genomes:
            genome.id = self.born([]).id


class AcceptsNone(Walking):
    def seed(self, genomes: Sequence[Genome]) -> None:
        if genomes:
            super().seed(genomes)


class DropsTheRest(Walking):
    def seed(self, genomes: Sequence[Genome]) -> None:
        super().seed(genomes[: self.size])


class RefusesAfterTheFact(Walking):
    def seed(self, genomes: Sequence[Genome]) -> None:
        self.rng.normal()
        super().seed(genomes)


@pytest.mark.parametrize(
    ("run", "law"),
    [
        (Rounds, LOADED),
        (LoadsUnderAnotherId, LOADED),
        (LoadsUnderAnotherId, LOADING),
        (LoadsWhatItKnows, LOADED),
        (EmptiesTheDocument, LOADING),
        (ReplacesJunkByNaN, DAMAGED),
        (SeedsBackwards, BEGINS),
        (MutatesTheSeeds, BEGINS),
        (AddsTheSeeds, BEGINS),
        (SeedsOnly, BEGINS),
        (Clones, MUTANTS),
        (KeepsIds, IDS),
        (KeepsIdsOfDifferentSeeds, IDS),
        (Remembers, NEW),
        (FreshRandom, EQUAL),
        (ForgetsThatItWasSeeded, RESTORED),
        (TakesTheSeeds, KEPT),
        (AcceptsNone, NUMBER),
        (DropsTheRest, NUMBER),
        (RefusesAfterTheFact, NUMBER),
    ],
)
def test_a_broken_run_is_caught(run: type[Any], law: str, breaks: Callable[..., None]) -> None:
    breaks(EvolverContract, starting(run, Walker), law)


def test_a_missing_validation_is_caught(breaks: Callable[..., None]) -> None:
    breaks(EvolverContract, starting(ValidatesNothing, Walker), DAMAGED, error=(KeyError, TypeError))
    breaks(EvolverContract, starting(AcceptsAnyShape, Walker), DAMAGED, error=ValueError)


class Plain:
    """Passes on only what the protocol requires."""

    def __init__(self, *given: Any) -> None:
        run = Walking(*given)
        for name in ("ask", "tell", "members", "genomes", "express", "dump", "state", "restore"):
            setattr(self, name, getattr(run, name))


class TestARunWithoutLoadAndSeeds(EvolverContract):
    component = starting(Plain, Walker)
