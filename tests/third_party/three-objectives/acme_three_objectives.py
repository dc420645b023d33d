"""A third-party evolver with three or more objectives: ``domination``."""

from collections.abc import Mapping, Sequence
from typing import Any

import attrs
import numpy as np
from attrs import validators
from numpy.typing import NDArray

from evoframe import ConfigurationError, Evolver, EvolverRun, Member, Network, hookimpl, structure

Floats = NDArray[np.float64]
LARGEST = 100.0


@attrs.frozen
class Domination:
    """Truncation by Pareto domination: large fitness, and small values of some measures.

    The half of the population with the fewest dominating members survives (the ranks of Fonseca and Fleming
    1993, Genetic algorithms for multiobjective optimization, ICGA). Mutants of the survivors replace the
    rest, and a random newcomer the last one, which age as an objective protects (Schmidt and Lipson 2010,
    Age-fitness Pareto optimization, GECCO). A genome contains the weights of a network with one layer.

    Attributes:
        minimize: Names of the measures.
        mutation_sd: Standard deviation of the mutations of a weight.
    """

    minimize: tuple[str, ...] = attrs.field(
        default=("age", "count-contractile"), validator=validators.min_len(1)
    )
    mutation_sd: float = attrs.field(default=0.3, validator=[validators.gt(0.0), validators.le(LARGEST)])

    @property
    def wants(self) -> tuple[str, ...]:
        return self.minimize

    def check(self, size: int) -> None:
        if size < 4:
            raise ConfigurationError(f"expected a population of at least 4 members, found {size}")

    def start(self, inputs: int, outputs: int, size: int, rng: np.random.Generator) -> EvolverRun:
        self.check(size)
        return DominationRun(self, (inputs + 1, outputs), size, rng)


def dominators(objectives: Floats) -> NDArray[np.intp]:
    """Return how many members dominate each one; *objectives* ``float64[objectives, n]`` are maximized."""
    one, other = objectives[:, :, None], objectives[:, None, :]
    dominates = (one >= other).all(axis=0) & (one > other).any(axis=0)
    counts: NDArray[np.intp] = dominates.sum(axis=0)
    return counts


@attrs.frozen(eq=False)
class Genome:
    """The weights of a network: ``float64[inputs + 1, outputs]``, those of the bias last."""

    id: int
    born: int
    weights: Floats

    def __call__(self, points: Floats) -> Floats:
        sums = points @ self.weights[:-1] + self.weights[-1]
        outputs: Floats = np.sin(np.clip(sums, -1e6, 1e6))
        return outputs


class DominationRun:
    """The evolution of one population."""

    def __init__(
        self, options: Domination, shape: tuple[int, int], size: int, rng: np.random.Generator
    ) -> None:
        self.options = options
        self.shape = shape
        self.size = size
        self.rng = rng
        self.generation = 0
        self.next_id = 1
        self.fitness: dict[int, float] = {}
        self.ranks: list[int] = []  # numbers of dominating members, after tell()
        self.current = [self._newcomer() for _ in range(size)]

    def ask(self) -> Sequence[Genome]:
        if self.ranks:
            self._succeed()
        return list(self.current)

    def _succeed(self) -> None:
        self.generation += 1
        order = sorted(range(self.size), key=lambda index: (self.ranks[index], index))
        kept = [self.current[index] for index in order[: self.size // 2]]
        mutants = [self._mutant(kept[n % len(kept)]) for n in range(self.size - len(kept) - 1)]
        self.current = [*kept, *mutants, self._newcomer()]
        self.fitness = {genome.id: self.fitness[genome.id] for genome in kept}
        self.ranks = []

    def _newcomer(self) -> Genome:
        return self._born(self.rng.normal(size=self.shape))

    def _mutant(self, parent: Genome) -> Genome:
        return self._born(parent.weights + self.rng.normal(0.0, self.options.mutation_sd, self.shape))

    def _born(self, weights: Floats) -> Genome:
        self.next_id += 1
        return Genome(self.next_id - 1, self.generation, np.clip(weights, -LARGEST, LARGEST))

    def tell(self, fitness: Floats, measures: Mapping[str, Floats]) -> None:
        objectives = np.array([fitness, *(-measures[name] for name in self.options.minimize)])
        if objectives.shape[1] != self.size or not np.isfinite(objectives).all():
            raise ValueError(f"expected {self.size} finite values of fitness and of each measure")
        self.ranks = dominators(objectives).tolist()
        self.fitness = {
            genome.id: value for genome, value in zip(self.current, fitness.tolist(), strict=True)
        }

    def members(self) -> Sequence[Member]:
        return [
            Member(
                id=genome.id,
                fitness=self.fitness.get(genome.id),
                genome_size=genome.weights.size,
                age=self.generation - genome.born,
            )
            for genome in self.current
        ]

    def genomes(self) -> Sequence[Genome]:
        return list(self.current)

    def express(self, genome: Genome) -> Network:
        return genome

    def dump(self, genome: Genome) -> Any:
        return {"id": genome.id, "born": genome.born, "weights": genome.weights.tolist()}

    def load(self, dumped: Any) -> Genome:
        return self._genome(structure(dumped, SavedGenome, ("genome",)))

    def _genome(self, saved: "SavedGenome") -> Genome:
        rows, columns = self.shape
        if [len(row) for row in saved.weights] != [columns] * rows:
            raise ValueError(f"genome {saved.id}: expected {rows} rows of {columns} weights")
        weights = np.array(saved.weights, dtype=np.float64).reshape(self.shape)
        if not (np.abs(weights) <= LARGEST).all():
            raise ValueError(f"genome {saved.id}: expected weights up to {LARGEST}")
        return Genome(saved.id, saved.born, weights)

    def state(self) -> Any:
        return {
            "generation": self.generation,
            "next_id": self.next_id,
            "genomes": [self.dump(genome) for genome in self.current],
            "fitness": [self.fitness.get(genome.id) for genome in self.current],
            "ranks": self.ranks,
            "random": self.rng.bit_generator.state,
        }

    def restore(self, state: Any) -> None:
        saved = structure(state, SavedRun, ("state",))
        current = [self._genome(genome) for genome in saved.genomes]
        if len(current) != self.size or len(saved.fitness) != self.size:
            raise ValueError(f"expected {self.size} genomes with their fitness, found {len(current)}")
        if len(saved.ranks) not in {0, self.size}:
            raise ValueError(f"expected the ranks of {self.size} genomes or none, found {len(saved.ranks)}")
        try:
            self.rng.bit_generator.state = saved.random
        except (KeyError, OverflowError, TypeError, ValueError) as error:
            raise ValueError(f"expected the state of a random generator: {error}") from error
        self.generation, self.next_id = saved.generation, saved.next_id
        self.current, self.ranks = current, list(saved.ranks)
        told = zip(current, saved.fitness, strict=True)
        self.fitness = {genome.id: value for genome, value in told if value is not None}


@attrs.frozen
class SavedGenome:
    """A genome as JSON values."""

    id: int
    born: int
    weights: tuple[tuple[float, ...], ...]


@attrs.frozen
class SavedRun:
    """The state of a run as JSON values."""

    generation: int
    next_id: int
    genomes: tuple[SavedGenome, ...]
    fitness: tuple[float | None, ...]
    ranks: tuple[int, ...]
    random: Any


@hookimpl
def evoframe_evolvers() -> Mapping[str, type[Evolver]]:
    return {"domination": Domination}
