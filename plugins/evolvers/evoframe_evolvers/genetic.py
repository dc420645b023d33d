"""A genetic algorithm of real numbers: the evolver ``genetic``, whose genomes are vectors."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Literal, TypeAlias

import attrs
import numpy as np
from attrs.validators import ge
from numpy.typing import NDArray

from evoframe import ConfigurationError, Member, Network, structure
from evoframe_evolvers.cohort import Cohort, SavedCohort
from evoframe_evolvers.cppn import at_least, finite, probability

__all__ = ["Genetic", "GeneticRun", "VectorGenome"]

Genes: TypeAlias = NDArray[np.float64]


@attrs.frozen(kw_only=True)
class Genetic:
    """Genetic algorithm of real numbers, with one gene from 0 to 1 for each output of a network.

    The network of a genome is constant: it returns the genes at every point, so that an encoder such as
    ``vector`` encodes them directly. Initial genes are uniformly distributed. In each generation the *elites*
    survive, and children replace all others: the winner of a tournament, crossed with that of another one
    with probability *crossover_rate*, and then mutated. Genes are clipped to 0 and 1. There are no species.
    (A. E. Eiben and J. E. Smith 2015, Introduction to evolutionary computing, chapters 4 and 5.)

    Attributes:
        elites: Number of the fittest members that survive unchanged; fewer than the population has members.
        tournament: Number of members, drawn with replacement, of which the fittest becomes a parent.
        crossover: ``uniform`` takes each gene from either parent. ``one-point`` takes the genes before a
            random place from the first parent, the others from the second. ``blend`` draws each gene between
            those of the parents, and up to *blend* times their distance beyond (BLX-alpha; L. J. Eshelman and
            J. D. Schaffer 1993, Real-coded genetic algorithms and interval-schemata, FOGA 2).
        crossover_rate: Probability that a child has two parents.
        blend: Largest distance of a blended gene from the nearer parent, in units of the parents' distance.
        mutation_rate: Probability that a gene mutates.
        mutation_sd: Standard deviation of the normal distribution of mutations.
    """

    elites: int = at_least(0, 1)
    tournament: int = at_least(1, 2)
    crossover: Literal["uniform", "one-point", "blend"] = "uniform"
    crossover_rate: float = probability(0.5)
    blend: float = attrs.field(default=0.5, validator=[finite, ge(0.0)])
    mutation_rate: float = probability(1.0)
    mutation_sd: float = attrs.field(default=0.05, validator=[finite, ge(0.0)])

    def check(self, size: int) -> None:
        """Require a population of *size* that can have offspring."""
        if size < 1:
            raise ConfigurationError(f"expected a population of at least 1 member, found {size}")
        if self.elites >= size:
            raise ConfigurationError(
                f"elites = {self.elites} prevents offspring in a population of {size}; "
                f"set it to less than {size}"
            )

    def start(self, inputs: int, outputs: int, size: int, rng: np.random.Generator) -> GeneticRun:  # noqa: ARG002
        """Draw *size* genomes of *outputs* genes; the number of *inputs* does not matter."""
        self.check(size)
        return GeneticRun(self, outputs, size, rng)

    def cross(self, one: Genes, other: Genes, rng: np.random.Generator) -> Genes:
        """Return the genes of a child of two parents; blended ones can exceed the range from 0 to 1."""
        if self.crossover == "uniform":
            return np.where(rng.random(len(one)) < 0.5, one, other)
        if self.crossover == "one-point":
            return np.where(np.arange(len(one)) < rng.integers(1, len(one), endpoint=True), one, other)
        return one + (other - one) * rng.uniform(-self.blend, 1.0 + self.blend, len(one))

    def mutate(self, genes: Genes, rng: np.random.Generator) -> Genes:
        """Return mutated *genes*, from 0 to 1."""
        changes = rng.normal(0.0, self.mutation_sd, len(genes))
        mutates = rng.random(len(genes)) < self.mutation_rate
        mutated: Genes = (genes + np.where(mutates, changes, 0.0)).clip(0.0, 1.0)
        return mutated


@attrs.define(eq=False)
class VectorGenome:
    """A vector of genes.

    Attributes:
        key: Its id.
        genes: ``float64[outputs]`` from 0 to 1, read-only.
        fitness: Latest fitness; ``None`` before the first evaluation.
    """

    key: int
    genes: Genes
    fitness: float | None = None

    def __attrs_post_init__(self) -> None:
        self.genes.setflags(write=False)

    def size(self) -> tuple[int]:
        """Return the number of genes."""
        return (len(self.genes),)


@attrs.frozen
class _Constant:
    """The network that returns the same outputs at every point."""

    genes: Genes

    def __call__(self, points: NDArray[np.float64]) -> NDArray[np.float64]:
        return np.tile(self.genes, (len(points), 1))


@attrs.frozen
class _SavedGenome:
    id: int = attrs.field(validator=ge(1))
    genes: tuple[float, ...]


@attrs.frozen
class _SavedRun:
    evolver: Literal["genetic"]
    next_genome: int
    cohort: SavedCohort
    random: Any


class GeneticRun:
    """Evolution of one population by a genetic algorithm."""

    def __init__(self, options: Genetic, outputs: int, size: int, rng: np.random.Generator) -> None:
        self._options = options
        self._outputs = outputs
        self._size = size
        self._rng = rng
        self._next_id = 1
        self._cohort = self._cohort_of(rng.uniform(size=(size, outputs)))

    def _cohort_of(self, vectors: Sequence[Genes] | Genes) -> Cohort:
        genomes = [self._new(genes) for genes in vectors]
        return Cohort({genome.key: genome for genome in genomes})

    def _new(self, genes: Genes) -> VectorGenome:
        self._next_id += 1
        return VectorGenome(self._next_id - 1, genes)

    def seed(self, genomes: Sequence[VectorGenome]) -> None:
        """Start from *genomes* with new ids, and from mutants of them, in turn.

        Raises:
            ValueError: There are none, or more than members.
            RuntimeError: The initial population was already asked for.
        """
        self._cohort.check_seeds(len(genomes))
        seeds = [genome.genes for genome in genomes]
        rest = range(self._size - len(seeds))
        mutants = [self._options.mutate(seeds[n % len(seeds)], self._rng) for n in rest]
        self._next_id = 1
        self._cohort = self._cohort_of([*seeds, *mutants])

    def ask(self) -> Sequence[VectorGenome]:
        """Return the genomes to evaluate: first the initial ones, then those of the next generation."""
        if self._cohort.finished:
            self._succeed()
        return self._cohort.ask()

    def _succeed(self) -> None:
        ranked = self._ranked()
        offspring = [*ranked[: self._options.elites]]
        offspring += [self._child(ranked) for _ in range(self._size - len(offspring))]
        self._cohort.succeed({genome.key: genome for genome in offspring})

    def _ranked(self) -> list[VectorGenome]:
        """Return the members, the fittest first; equally fit ones in the order of the population."""
        fitness = self._cohort.fitness
        return sorted(self._cohort.genomes.values(), key=lambda genome: -fitness[genome.key])

    def _child(self, ranked: Sequence[VectorGenome]) -> VectorGenome:
        genes = self._parent(ranked)
        if self._rng.random() < self._options.crossover_rate:
            genes = self._options.cross(genes, self._parent(ranked), self._rng)
        return self._new(self._options.mutate(genes, self._rng))

    def _parent(self, ranked: Sequence[VectorGenome]) -> Genes:
        """Return the genes of the winner of a tournament."""
        entrants = self._rng.integers(len(ranked), size=self._options.tournament)
        return ranked[int(entrants.min())].genes

    def tell(self, fitness: NDArray[np.float64], measures: Mapping[str, NDArray[np.float64]]) -> None:  # noqa: ARG002
        """Store the *fitness* of the genomes of the last :meth:`ask`; *measures* are not used."""
        self._cohort.tell(fitness)

    def genomes(self) -> Sequence[VectorGenome]:
        """Return the genomes of :meth:`members`, also after :meth:`restore`."""
        return list(self._cohort.genomes.values())

    def members(self) -> Sequence[Member]:
        """Return the current members, in the order of the last :meth:`ask`."""
        return self._cohort.members(lambda _: None)

    def express(self, genome: VectorGenome) -> Network:
        """Return the network that returns the genes at every point."""
        return _Constant(genome.genes)

    def dump(self, genome: VectorGenome) -> Any:
        """Return *genome* as JSON values."""
        return {"id": genome.key, "genes": genome.genes.tolist()}

    def load(self, dumped: Any) -> VectorGenome:
        """Return the genome that :meth:`dump` returned as *dumped*.

        Raises:
            ValueError: It is not a genome of this population; the message describes the fault.
        """
        return self._load(dumped, ("genome",))

    def _load(self, dumped: Any, path: tuple[str, ...]) -> VectorGenome:
        saved = structure(dumped, _SavedGenome, path)
        genes = np.array(saved.genes, dtype=np.float64)
        if genes.shape != (self._outputs,) or not ((genes >= 0.0) & (genes <= 1.0)).all():
            expected = f"expected {self._outputs} numbers from 0 to 1"
            raise ValueError(f"{'.'.join(path)}.genes: {expected}, found {[*saved.genes]}")
        return VectorGenome(saved.id, genes)

    def state(self) -> Any:
        """Return everything needed to continue, as JSON values."""
        return {
            "evolver": "genetic",
            "next_genome": self._next_id,
            "cohort": self._cohort.state(self.dump),
            "random": self._rng.bit_generator.state,
        }

    def restore(self, state: Any) -> None:
        """Continue from the result of :meth:`state`.

        Raises:
            ValueError: *state* is not the state of a population of this kind; this run is unchanged.
        """
        saved = structure(state, _SavedRun, ("state",))
        genomes = [
            self._load(member.genome, ("state", "cohort", f"members[{n}]", "genome"))
            for n, member in enumerate(saved.cohort.members)
        ]
        cohort = Cohort.from_state(saved.cohort, genomes, self._size)
        if saved.next_genome <= max(cohort.genomes):
            raise ValueError(f"state.next_genome: must be > {max(cohort.genomes)}, found {saved.next_genome}")
        self._restore_random(saved.random)
        self._cohort, self._next_id = cohort, saved.next_genome

    def _restore_random(self, state: Any) -> None:
        try:
            self._rng.bit_generator.state = state
        except (KeyError, OverflowError, TypeError, ValueError) as error:
            raise ValueError(f"state.random: expected the state of a random stream: {error}") from error
