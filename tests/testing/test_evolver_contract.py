import copy
import itertools
import math
import random
from collections.abc import Callable, Mapping, Sequence
from typing import Any, ClassVar

import attrs
import numpy as np
import pytest
from contracts import name_of, starting
from numpy.typing import NDArray

from evoframe import ConfigurationError, Member, Network, NetworkGraph, NetworkLink
from evoframe.testing import EvolverContract

SIZES = "test_sizes_are_refused_by_a_configuration_error"
WANTS = "test_wanted_measures_are_a_tuple_of_different_names"
KEEPS_SIZE = "test_the_population_keeps_its_size"
UNIQUE = "test_ids_are_unique"
ONE_GENOME = "test_an_id_stands_for_one_genome"
GENOMES = "test_genomes_are_those_of_the_last_ask"
OUTLIVE = "test_genomes_outlive_the_next_ask"
MEMBERS = "test_members_have_the_fitness_of_tell_in_order"
NUMBER = "test_a_wrong_number_of_values_is_refused"
NOT_FINITE = "test_fitness_that_is_not_finite_is_refused"
SAME_SEED = "test_the_same_seed_gives_the_same_evolution"
OTHER_SEED = "test_another_seed_gives_another_evolution"
RESTORED = "test_a_restored_run_continues_bit_for_bit"
READING = "test_reading_a_run_does_not_change_it"
INTERLEAVED = "test_interleaved_runs_equal_each_alone"
GLOBAL = "test_global_random_states_are_not_changed"
INDEPENDENT = "test_global_random_states_do_not_matter"
OUTPUTS = "test_networks_give_finite_outputs"
FUNCTIONS = "test_networks_are_functions"
GRAPH = "test_a_graph_has_the_networks_inputs_and_outputs"
ONE_GRAPH = "test_a_genome_has_one_graph"
DAMAGED = "test_a_damaged_genome_is_refused_by_a_value_error"
JSON = "test_a_dumped_genome_is_json"

Genome = dict[str, Any]


class Climbing:
    """A valid run, in which the better half has mutated children, and the base of the broken ones."""

    def __init__(self, inputs: int, outputs: int, size: int, rng: np.random.Generator) -> None:
        self.shape = (inputs, outputs)
        self.size = size
        self.rng = rng
        self.population: list[Genome] = []
        self.fitness: list[float] | None = None
        self.next_id = 0

    def ask(self) -> Sequence[Any]:
        if not self.population:
            self.population = [self.born(np.zeros(self.shape)) for _ in range(self.size)]
        elif self.fitness is not None:
            fitness = self.fitness
            ranked = sorted(range(self.size), key=lambda i: -fitness[i])
            elite = [self.population[i] for i in ranked[: self.size // 2]]
            self.population = self.next_generation(elite)
            self.fitness = None
        return self.population

    def next_generation(self, elite: list[Genome]) -> list[Genome]:
        parents = itertools.islice(itertools.cycle(elite), self.size - len(elite))
        return elite + [self.born(np.array(parent["weights"])) for parent in parents]

    def born(self, weights: NDArray[np.float64]) -> Genome:
        return {"id": self.new_id(), "weights": (weights + self.noise()).tolist()}

    def new_id(self) -> int:
        self.next_id += 1
        return self.next_id

    def noise(self) -> NDArray[np.float64]:
        return self.rng.normal(size=self.shape)

    def tell(self, fitness: NDArray[np.float64], measures: Mapping[str, NDArray[np.float64]]) -> None:
        if fitness.shape != (self.size,) or not np.isfinite(fitness).all():
            raise ValueError(f"expected {self.size} finite values")
        self.fitness = fitness.tolist()

    def members(self) -> Sequence[Member]:
        fitness: Sequence[float | None] = self.fitness or [None] * len(self.population)
        return [Member(genome["id"], f) for genome, f in zip(self.population, fitness, strict=True)]

    def genomes(self) -> Sequence[Any]:
        return self.population

    def express(self, genome: Genome) -> Network:
        weights = np.array(genome["weights"])
        return lambda points: np.tanh(points @ weights)

    def dump(self, genome: Genome) -> Any:
        return copy.deepcopy(genome)

    def state(self) -> Any:
        state = {name: getattr(self, name) for name in ("population", "fitness", "next_id")}
        return copy.deepcopy(state | {"rng": self.rng.bit_generator.state})

    def restore(self, state: Any) -> None:
        for name in ("population", "fitness", "next_id"):
            setattr(self, name, state[name])
        self.rng.bit_generator.state = state["rng"]


@attrs.frozen
class Climber:
    """A valid evolver, and the base of the broken ones."""

    run: ClassVar[type[Any]] = Climbing

    def check(self, size: int) -> None:
        if size < 2:
            raise ConfigurationError(f"a population of {size} cannot climb")

    def start(self, inputs: int, outputs: int, size: int, rng: np.random.Generator) -> Any:
        return self.run(inputs, outputs, size, rng)


class ClimbingVolume(Climbing):
    def tell(self, fitness: NDArray[np.float64], measures: Mapping[str, NDArray[np.float64]]) -> None:
        super().tell(fitness - measures["volume"], measures)
        self.fitness = fitness.tolist()


@attrs.frozen
class VolumeClimber(Climber):
    wants: ClassVar[Any] = ("volume",)
    run: ClassVar[type[Any]] = ClimbingVolume


class TestClimber(EvolverContract):
    component = Climber()


class TestClimberOfOtherShape(EvolverContract):
    component = Climber()
    inputs = 4
    outputs = 1
    size = 5
    turns = 3


class TestVolumeClimber(EvolverContract):
    component = VolumeClimber()


class PythonsRandom(Climbing):
    def noise(self) -> NDArray[np.float64]:
        return np.array([[random.gauss(0, 1) for _ in range(self.shape[1])] for _ in range(self.shape[0])])


class NumpysRandom(Climbing):
    def noise(self) -> NDArray[np.float64]:
        return np.random.normal(size=self.shape)  # noqa: NPY002


class ReadsPythonsState(Climbing):
    """Does not draw from the global state, but depends on it."""

    def noise(self) -> NDArray[np.float64]:
        drawn: int = random.getstate()[1][1]
        return super().noise() + drawn % 1000


class SeedsOnRestore(Climbing):
    def restore(self, state: Any) -> None:
        random.seed(state["next_id"])
        super().restore(state)


class FreshRandom(Climbing):
    def noise(self) -> NDArray[np.float64]:
        return np.random.default_rng().normal(size=self.shape)


class FixedRandom(Climbing):
    def __init__(self, inputs: int, outputs: int, size: int, rng: np.random.Generator) -> None:
        super().__init__(inputs, outputs, size, np.random.default_rng(1))


class Grows(Climbing):
    def next_generation(self, elite: list[Genome]) -> list[Genome]:
        self.size += 1
        return super().next_generation(elite)


class SameId(Climbing):
    def new_id(self) -> int:
        return 1


class IdsByPosition(Climbing):
    def next_generation(self, elite: list[Genome]) -> list[Genome]:
        genomes = super().next_generation(elite)
        return [{**genome, "id": i + 1} for i, genome in enumerate(genomes)]

    def dump(self, genome: Genome) -> Any:
        return genome["weights"]


class MembersByFitness(Climbing):
    def members(self) -> Sequence[Member]:
        return sorted(super().members(), key=lambda member: -(member.fitness or 0.0))


class GenomesByFitness(Climbing):
    def genomes(self) -> Sequence[Any]:
        fitness = self.fitness
        if fitness is None:
            return self.population
        return [self.population[i] for i in sorted(range(self.size), key=lambda i: -fitness[i])]


class Overwrites(Climbing):
    """Stores children in the place of the genomes that they replace."""

    def next_generation(self, elite: list[Genome]) -> list[Genome]:
        children = super().next_generation(elite)[len(elite) :]
        replaced = [genome for genome in self.population if genome not in elite]
        for genome, child in zip(replaced, children, strict=True):
            genome.update(child)
        return elite + replaced


class GenomesOnlyOnce(Climbing):
    """Does not restore the genomes of the last ``ask``."""

    asked: Sequence[Any] = ()

    def ask(self) -> Sequence[Any]:
        self.asked = super().ask()
        return self.asked

    def genomes(self) -> Sequence[Any]:
        return self.asked


class FitnessFromTheStart(Climbing):
    def members(self) -> Sequence[Member]:
        return [attrs.evolve(member, fitness=member.fitness or 0.0) for member in super().members()]


class AcceptsAnyNumber(Climbing):
    def tell(self, fitness: NDArray[np.float64], measures: Mapping[str, NDArray[np.float64]]) -> None:
        super().tell(np.resize(fitness, self.size), measures)


class AcceptsNaN(Climbing):
    def tell(self, fitness: NDArray[np.float64], measures: Mapping[str, NDArray[np.float64]]) -> None:
        super().tell(np.where(np.isnan(fitness), 0.0, fitness), measures)


class AcceptsInfinity(Climbing):
    def tell(self, fitness: NDArray[np.float64], measures: Mapping[str, NDArray[np.float64]]) -> None:
        super().tell(np.where(np.isinf(fitness), 0.0, fitness), measures)


class RefusesAfterTheFact(Climbing):
    """Draws a number before it refuses, which changes the next generation."""

    def tell(self, fitness: NDArray[np.float64], measures: Mapping[str, NDArray[np.float64]]) -> None:
        if not np.isfinite(fitness).all():
            self.rng.normal()
        super().tell(fitness, measures)


class ForgetsItsRandomStream(Climbing):
    def restore(self, state: Any) -> None:
        super().restore({**state, "rng": self.rng.bit_generator.state})


class ForgetsItsCounter(Climbing):
    def restore(self, state: Any) -> None:
        super().restore({**state, "next_id": len(state["population"])})


class ForgetsFitness(Climbing):
    def restore(self, state: Any) -> None:
        super().restore({**state, "fitness": None})


class RoundsItsState(Climbing):
    def state(self) -> Any:
        state = super().state()
        for genome in state["population"]:
            genome["weights"] = np.round(genome["weights"], 12).tolist()
        return state


class StateAdvances(Climbing):
    """Advances a counter when saved, like a pickled configuration of neat-python 2.0."""

    def state(self) -> Any:
        self.next_id += 1
        return super().state()


class ExpressDraws(Climbing):
    def express(self, genome: Genome) -> Network:
        self.rng.normal()
        return super().express(genome)


class DumpChanges(Climbing):
    def dump(self, genome: Genome) -> Any:
        genome["dumped"] = genome.get("dumped", 0) + 1
        return super().dump(genome)


class SharedCounter(Climbing):
    ids: ClassVar[Any] = itertools.count(1)

    def new_id(self) -> int:
        return int(next(self.ids))


class DisturbsTheOther(Climbing):
    """Depends on whether it is the run that was started last, as a run alone always is."""

    last: ClassVar[list[Any]] = [None]

    def __init__(self, inputs: int, outputs: int, size: int, rng: np.random.Generator) -> None:
        super().__init__(inputs, outputs, size, rng)
        self.last[0] = self

    def noise(self) -> NDArray[np.float64]:
        return super().noise() + (self.last[0] is not self)


class Unbounded(Climbing):
    def express(self, genome: Genome) -> Network:
        def network(points: NDArray[np.float64]) -> NDArray[np.float64]:
            with np.errstate(over="ignore"):
                outputs: NDArray[np.float64] = np.exp(points @ np.array(genome["weights"]))
                return outputs

        return network


class Flat(Climbing):
    def express(self, genome: Genome) -> Network:
        network = super().express(genome)
        return lambda points: network(points)[:, 0]


class SinglePrecision(Climbing):
    def express(self, genome: Genome) -> Network:
        network = super().express(genome)
        return lambda points: network(points).astype(np.float32)


class Recurrent(Climbing):
    def express(self, genome: Genome) -> Network:
        network = super().express(genome)
        calls = itertools.count()
        return lambda points: network(points + next(calls))


class CentersPoints(Climbing):
    def express(self, genome: Genome) -> Network:
        network = super().express(genome)

        def centered(points: NDArray[np.float64]) -> NDArray[np.float64]:
            points -= points.mean() + 1
            return network(points)

        return centered


class DumpsTuples(Climbing):
    def dump(self, genome: Genome) -> Any:
        return tuple(genome["weights"])


class DumpsNaN(Climbing):
    def dump(self, genome: Genome) -> Any:
        return math.nan


class DumpsArrays(Climbing):
    def dump(self, genome: Genome) -> Any:
        return np.array(genome["weights"])


class StateOfArrays(Climbing):
    def state(self) -> Any:
        return {**super().state(), "fitness": np.array(self.fitness)}


class NoDump:
    ask = Climbing.ask
    tell = Climbing.tell


@pytest.mark.parametrize(
    ("run", "law"),
    [
        (Grows, KEEPS_SIZE),
        (SameId, UNIQUE),
        (IdsByPosition, ONE_GENOME),
        (GenomesByFitness, GENOMES),
        (GenomesOnlyOnce, RESTORED),
        (Overwrites, OUTLIVE),
        (MembersByFitness, MEMBERS),
        (FitnessFromTheStart, MEMBERS),
        (AcceptsAnyNumber, NUMBER),
        (AcceptsNaN, NOT_FINITE),
        (AcceptsInfinity, NOT_FINITE),
        (RefusesAfterTheFact, NOT_FINITE),
        (PythonsRandom, GLOBAL),
        (PythonsRandom, INDEPENDENT),
        (PythonsRandom, SAME_SEED),
        (NumpysRandom, GLOBAL),
        (NumpysRandom, INDEPENDENT),
        (ReadsPythonsState, INDEPENDENT),
        (SeedsOnRestore, GLOBAL),
        (FreshRandom, SAME_SEED),
        (FixedRandom, OTHER_SEED),
        (ForgetsItsRandomStream, RESTORED),
        (ForgetsItsCounter, RESTORED),
        (ForgetsFitness, RESTORED),
        (RoundsItsState, RESTORED),
        (StateAdvances, READING),
        (StateAdvances, RESTORED),
        (ExpressDraws, READING),
        (DumpChanges, READING),
        (SharedCounter, INTERLEAVED),
        (DisturbsTheOther, INTERLEAVED),
        (Unbounded, OUTPUTS),
        (Flat, OUTPUTS),
        (SinglePrecision, OUTPUTS),
        (Recurrent, FUNCTIONS),
        (CentersPoints, FUNCTIONS),
        (DumpsTuples, JSON),
    ],
)
def test_a_broken_run_is_caught(run: type[Any], law: str, breaks: Callable[..., None]) -> None:
    breaks(EvolverContract, starting(run, Climber), law)


@pytest.mark.parametrize(
    ("run", "law", "error"),
    [
        (DumpsNaN, JSON, ValueError),
        (DumpsArrays, JSON, TypeError),
        (StateOfArrays, RESTORED, TypeError),
        (NoDump, "test_it_starts_a_run", TypeError),
    ],
)
def test_values_that_are_not_json_are_caught(
    run: type[Any], law: str, error: type[Exception], breaks: Callable[..., None]
) -> None:
    breaks(EvolverContract, starting(run, Climber), law, error=error)


class ForgetsToWant(VolumeClimber):
    wants: ClassVar[Any] = ("age",)


@pytest.mark.parametrize("names", ["volume", ["volume"], ("volume", "volume"), ("volume", " "), (1,)])
def test_wrong_wants_are_caught(names: Any, breaks: Callable[..., None]) -> None:
    wanting = type("Wanting", (Climber,), {"wants": names})
    breaks(EvolverContract, wanting(), WANTS)


def test_a_measure_that_is_used_without_being_wanted_is_caught(breaks: Callable[..., None]) -> None:
    breaks(EvolverContract, ForgetsToWant(), KEEPS_SIZE, error=KeyError)


class RefusesWithAnotherError(Climber):
    def check(self, size: int) -> None:
        if size < 2:
            raise ValueError(size)


class RefusesWithoutAMessage(Climber):
    def check(self, size: int) -> None:
        if size < 2:
            raise ConfigurationError


def test_wrong_refusals_are_caught(breaks: Callable[..., None]) -> None:
    breaks(EvolverContract, RefusesWithAnotherError(), SIZES, error=ValueError)
    breaks(EvolverContract, RefusesWithoutAMessage(), SIZES)
    breaks(EvolverContract, Climber(), SIZES, size=1)


@attrs.frozen
class Drawn(Climber):
    """A valid evolver that returns graphs, and the base of the broken ones."""

    def graph(self, genome: Any, inputs: int, outputs: int) -> Any:
        weights = self.weights(genome, (inputs, outputs))
        labels = dict.fromkeys(range(outputs), "tanh")
        links = [NetworkLink(-1 - i, o, w) for i, row in enumerate(weights) for o, w in enumerate(row)]
        return NetworkGraph(tuple(range(-1, -1 - inputs, -1)), tuple(labels), labels, tuple(links))

    def weights(self, genome: Any, shape: tuple[int, int]) -> list[list[float]]:
        if not isinstance(genome, dict):
            raise ValueError("not a genome")  # noqa: TRY004 - an invalid document, not a wrong argument
        try:
            weights = np.array(genome.get("weights"), dtype=np.float64)
        except (TypeError, OverflowError) as error:
            raise ValueError("no weights") from error
        if weights.shape != shape or not np.isfinite(weights).all():
            raise ValueError("no weights")
        found: list[list[float]] = weights.tolist()
        return found


class TestDrawn(EvolverContract):
    component = Drawn()


class Redrawn(Drawn):
    def graph(self, genome: Any, inputs: int, outputs: int) -> Any:
        return self.changed(super().graph(genome, inputs, outputs))

    def changed(self, graph: NetworkGraph) -> Any:
        return graph


class DrawsATuple(Redrawn):
    def changed(self, graph: NetworkGraph) -> Any:
        return attrs.astuple(graph)


class LosesAnInput(Redrawn):
    def changed(self, graph: NetworkGraph) -> Any:
        return attrs.evolve(graph, inputs=graph.inputs[1:])


class LosesAnOutput(Redrawn):
    def changed(self, graph: NetworkGraph) -> Any:
        return attrs.evolve(graph, outputs=graph.outputs[1:])


class OneIdForTwo(Redrawn):
    def changed(self, graph: NetworkGraph) -> Any:
        return attrs.evolve(graph, inputs=graph.inputs[:1] * len(graph.inputs))


class LabelsInputs(Redrawn):
    def changed(self, graph: NetworkGraph) -> Any:
        return attrs.evolve(graph, labels={**graph.labels, -1: "x"})


class LosesALabel(Redrawn):
    def changed(self, graph: NetworkGraph) -> Any:
        return attrs.evolve(graph, labels={0: "tanh"}, links=())


class EmptyLabel(Redrawn):
    def changed(self, graph: NetworkGraph) -> Any:
        return attrs.evolve(graph, labels=dict.fromkeys(graph.labels, " "))


class LinksFromNowhere(Redrawn):
    def changed(self, graph: NetworkGraph) -> Any:
        return attrs.evolve(graph, links=(NetworkLink(99, 0, 1.0),))


class LinksToAnInput(Redrawn):
    def changed(self, graph: NetworkGraph) -> Any:
        return attrs.evolve(graph, links=(NetworkLink(0, -1, 1.0),))


class InfiniteWeight(Redrawn):
    def changed(self, graph: NetworkGraph) -> Any:
        return attrs.evolve(graph, links=(NetworkLink(-1, 0, math.inf),))


class DrawsDifferentlyEachTime(Redrawn):
    calls: ClassVar[Any] = itertools.count()

    def changed(self, graph: NetworkGraph) -> Any:
        return attrs.evolve(graph, links=(NetworkLink(-1, 0, float(next(self.calls))),))


class ChangesTheGenome(Drawn):
    def graph(self, genome: Any, inputs: int, outputs: int) -> Any:
        graph = super().graph(genome, inputs, outputs)
        genome["drawn"] = True
        return graph


class ValidatesNothing(Drawn):
    def weights(self, genome: Any, shape: tuple[int, int]) -> list[list[float]]:
        found: list[list[float]] = genome["weights"]
        return found


class ValidatesOnlyNumbers(Drawn):
    def weights(self, genome: Any, shape: tuple[int, int]) -> list[list[float]]:
        try:
            return [[float(w) for w in row] for row in genome["weights"]]
        except Exception as error:
            raise ValueError("no weights") from error


@pytest.mark.parametrize(
    ("component", "law", "error"),
    [
        (DrawsATuple(), GRAPH, AssertionError),
        (LosesAnInput(), GRAPH, AssertionError),
        (LosesAnOutput(), GRAPH, AssertionError),
        (OneIdForTwo(), GRAPH, AssertionError),
        (LabelsInputs(), GRAPH, AssertionError),
        (LosesALabel(), GRAPH, AssertionError),
        (EmptyLabel(), GRAPH, AssertionError),
        (LinksFromNowhere(), GRAPH, AssertionError),
        (LinksToAnInput(), GRAPH, AssertionError),
        (InfiniteWeight(), GRAPH, AssertionError),
        (DrawsDifferentlyEachTime(), ONE_GRAPH, AssertionError),
        (ChangesTheGenome(), ONE_GRAPH, AssertionError),
        (ValidatesNothing(), DAMAGED, (TypeError, KeyError)),
        (ValidatesOnlyNumbers(), DAMAGED, AssertionError),
    ],
    ids=name_of,
)
def test_a_broken_graph_is_caught(component: Any, law: str, error: Any, breaks: Callable[..., None]) -> None:
    breaks(EvolverContract, component, law, error=error)
