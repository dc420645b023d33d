"""The laws of evolvers."""

from __future__ import annotations

import contextlib
import functools
import json
import math
import random
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any, ClassVar

import numpy as np
import pytest
from hypothesis import strategies as st
from numpy.typing import NDArray

from evoframe.contract import Evolver, EvolverRun, NetworkGraph, SupportsGraph
from evoframe.testing.components import ComponentContract
from evoframe.testing.laws import for_all, global_random_state_untouched, refusal, same_bits

__all__ = ["EvolverContract"]

Floats = NDArray[np.float64]


class EvolverContract(ComponentContract[Evolver]):
    """The laws of an :class:`~evoframe.Evolver` and of the run that it starts.

    The graph of a genome is tested where it is offered.

    Attributes:
        inputs: Inputs of its networks.
        outputs: Outputs of its networks.
        size: Size of the population.
        turns: How long to evolve it.
        measures: Names of the measures that it needs beside fitness.
    """

    protocol = Evolver
    inputs: ClassVar[int] = 3
    outputs: ClassVar[int] = 2
    size: ClassVar[int] = 12
    turns: ClassVar[int] = 6
    measures: ClassVar[tuple[str, ...]] = ()

    def test_sizes_are_refused_by_a_configuration_error(self) -> None:
        """``check`` raises nothing else, says why, and accepts the size under test."""
        assert "" not in [refusal(self.component.check, size) for size in range(1, 41)]
        assert refusal(self.component.check, self.size) is None

    def test_it_starts_a_run(self) -> None:
        """With every method of the protocol."""
        assert isinstance(self.start(), EvolverRun)

    def test_the_population_keeps_its_size(self) -> None:
        """``ask`` gives as many genomes as were asked for, each turn."""
        for _, genomes in self._play(self.start()):
            assert len(genomes) == self.size

    def test_ids_are_unique(self) -> None:
        """Within a population; the members are as many as the genomes."""
        for run, _ in self._play(self.start()):
            ids = [member.id for member in run.members()]
            assert len(set(ids)) == len(ids) == self.size

    def test_an_id_stands_for_one_genome(self) -> None:
        """For the whole run."""
        known: dict[int, str] = {}
        for run, genomes in self._play(self.start()):
            for member, genome in zip(run.members(), genomes, strict=True):
                dumped = _text(run.dump(genome))
                assert known.setdefault(member.id, dumped) == dumped

    def test_genomes_are_those_of_the_last_ask(self) -> None:
        """Before and after they are told about."""
        run = self.start()
        for _ in range(self.turns):
            asked = _dumped(run, run.ask())
            assert _dumped(run, run.genomes()) == asked
            self._tell(run, run.genomes())
            assert _dumped(run, run.genomes()) == asked

    def test_members_have_the_fitness_that_was_told_in_order(self) -> None:
        """Before it is told, the initial members have none."""
        run = self.start()
        for turn in range(self.turns):
            genomes = run.ask()
            if turn == 0:
                assert [member.fitness for member in run.members()] == [None] * self.size
            fitness, measures = self.judge(run, genomes)
            run.tell(fitness, measures)
            assert [member.fitness for member in run.members()] == fitness.tolist()

    def test_a_wrong_number_of_values_is_refused(self) -> None:
        """And leaves the run as it was."""
        self._refuses(lambda fitness: fitness[:-1])
        self._refuses(lambda fitness: np.append(fitness, 0.0))

    def test_fitness_that_is_not_finite_is_refused(self) -> None:
        """And leaves the run as it was."""
        for value in (math.nan, math.inf, -math.inf):
            self._refuses(functools.partial(_with_last, value))

    def test_the_same_seed_gives_the_same_evolution(self) -> None:
        """To the last bit."""
        assert self._history(self.start()) == self._history(self.start())

    def test_another_seed_gives_another_evolution(self) -> None:
        """The generator that is handed over is used."""
        assert self._history(self.start(seed=1)) != self._history(self.start(seed=2))

    def test_a_restored_run_continues_bit_for_bit(self) -> None:
        """After every turn, through JSON text, in a run that was started with another seed."""
        expected = self._history(self.start())
        run = self.start()
        for turn in range(self.turns):
            self._turn(run)
            restored = self.start(seed=turn + 100)
            restored.restore(json.loads(_text(run.state())))
            assert list(restored.members()) == list(run.members())
            assert _dumped(restored, restored.genomes()) == _dumped(run, run.genomes())
            assert _text(restored.state()) == _text(run.state())
            assert self._history(restored, self.turns - turn - 1) == expected[turn + 1 :]

    def test_looking_changes_nothing(self) -> None:
        """``state``, ``members``, ``genomes``, ``express`` and ``dump`` may be called at any time."""
        run, looked_at = self.start(), []
        for _ in range(self.turns):
            genomes = run.ask()
            self._look(run, genomes)
            looked_at.append(self._tell(run, genomes))
            self._look(run, genomes)
        assert looked_at == self._history(self.start())

    def test_interleaved_runs_equal_each_alone(self) -> None:
        """Two populations of one process share nothing."""
        one, other = self.start(seed=1), self.start(seed=2)
        histories = [(self._turn(one), self._turn(other)) for _ in range(self.turns)]
        assert [turn for turn, _ in histories] == self._history(self.start(seed=1))
        assert [turn for _, turn in histories] == self._history(self.start(seed=2))

    def test_global_random_states_are_left_alone(self) -> None:
        """Nothing is drawn from Python's or numpy's shared generators, not even by ``restore``."""
        with global_random_state_untouched():
            run = self.start()
            self._history(run)
            self.start().restore(json.loads(_text(run.state())))

    def test_global_random_states_do_not_matter(self) -> None:
        """Whatever other code has drawn."""
        with _globally_seeded(1):
            first = self._history(self.start())
        with _globally_seeded(2):
            second = self._history(self.start())
        assert first == second

    def test_networks_give_finite_outputs(self) -> None:
        """``float64[n, outputs]`` for every ``float64[n, inputs]``."""
        networks = [run.express(genome) for run, genomes in self._play(self.start()) for genome in genomes]

        def law(seed: int, scale: float, data: st.DataObject) -> None:
            network = networks[data.draw(st.integers(0, len(networks) - 1), label="network")]
            outputs = network(self._points(seed, scale))
            assert outputs.dtype == np.float64
            assert outputs.shape == (16, self.outputs)
            assert np.isfinite(outputs).all()

        scales = st.sampled_from([0.0, 1.0, 20.0, 1e6, 1e50])
        for_all(law, seed=st.integers(0, 2**32 - 1), scale=scales, data=st.data())

    def test_networks_are_functions(self) -> None:
        """The same points give the same outputs, and are left alone; a genome gives the same network."""
        for run, genomes in self._play(self.start()):
            points = self._points(0, 20.0)
            outputs = [network(points) for network in (run.express(genomes[-1]),) * 2]
            assert same_bits(points, self._points(0, 20.0))
            assert same_bits(outputs[0], outputs[1])
            assert same_bits(outputs[0], run.express(genomes[-1])(points))

    def test_a_dumped_genome_is_json(self) -> None:
        """It is equal after a round trip through text."""
        for run, genomes in self._play(self.start()):
            for genome in genomes:
                dumped = run.dump(genome)
                assert json.loads(_text(dumped)) == dumped

    def test_a_graph_has_the_networks_inputs_and_outputs(self) -> None:
        """Each node but the inputs has a label, and links join nodes; also after generations."""
        for dumped in self._drawable():
            self._assert_sound(self._graph(dumped))

    def test_a_genome_has_one_graph(self) -> None:
        """The same again, and from JSON text; the genome is left alone."""
        for dumped in self._drawable():
            before = _text(dumped)
            graph = self._graph(dumped)
            assert self._graph(dumped) == graph
            assert self._graph(json.loads(before)) == graph
            assert _text(dumped) == before

    def test_a_damaged_genome_is_refused_by_a_value_error(self) -> None:
        """Or it is still one: nothing else is raised, and no graph is unsound."""
        texts = [_text(dumped) for dumped in self._drawable()][:: self.size]

        def law(text: str, junk: Any, data: st.DataObject) -> None:
            genome = json.loads(text)
            damaged = _damaged(genome, data.draw(st.sampled_from(list(_places(genome)))), junk)
            with contextlib.suppress(ValueError):
                self._assert_sound(self._graph(damaged))

        if texts:
            for_all(law, text=st.sampled_from(texts), junk=_JUNK, data=st.data())

    def start(self, seed: int = 0) -> EvolverRun:
        """Start a run with its own random stream."""
        rng = np.random.default_rng(seed)
        return self.component.start(self.inputs, self.outputs, self.size, rng)

    def judge(self, run: EvolverRun, genomes: Sequence[Any]) -> tuple[Floats, Mapping[str, Floats]]:
        """Return fitness and measures of *genomes*, which depend on what their networks answer."""
        points = self._points(0, 1.0)
        answers = [np.arctan(run.express(genome)(points)) for genome in genomes]
        fitness = np.array([answer.mean() for answer in answers])
        spread = np.array([answer.std() for answer in answers])
        return fitness, dict.fromkeys(self.measures, spread)

    def _drawable(self) -> Iterator[Any]:
        """Return the dumped genomes of several generations if the evolver offers their graphs."""
        if isinstance(self.component, SupportsGraph):
            for run, genomes in self._play(self.start()):
                yield from map(run.dump, genomes)

    def _graph(self, dumped: Any) -> NetworkGraph:
        assert isinstance(self.component, SupportsGraph)
        graph = self.component.graph(dumped, self.inputs, self.outputs)
        assert isinstance(graph, NetworkGraph)
        return graph

    def _assert_sound(self, graph: NetworkGraph) -> None:
        assert len(graph.inputs) == self.inputs
        assert len(graph.outputs) == self.outputs
        ends = [*graph.inputs, *graph.outputs]
        assert len(set(ends)) == len(ends), "inputs and outputs have ids of their own"
        assert not set(graph.inputs) & set(graph.labels), "inputs are named by the encoder"
        assert set(graph.outputs) <= set(graph.labels)
        assert all(isinstance(label, str) and label.strip() for label in graph.labels.values())
        for link in graph.links:
            assert link.start in graph.labels or link.start in graph.inputs
            assert link.end in graph.labels
            assert math.isfinite(link.weight)

    def _points(self, seed: int, scale: float) -> Floats:
        return scale * np.random.default_rng(seed).uniform(-1, 1, size=(16, self.inputs))

    def _play(self, run: EvolverRun) -> Iterator[tuple[EvolverRun, Sequence[Any]]]:
        """Evolve, and yield between :meth:`ask` and :meth:`tell`."""
        for _ in range(self.turns):
            genomes = run.ask()
            yield run, genomes
            self._tell(run, genomes)

    def _turn(self, run: EvolverRun) -> str:
        return self._tell(run, run.ask())

    def _tell(self, run: EvolverRun, genomes: Sequence[Any]) -> str:
        """Tell the fitness and return everything that can be seen of the turn."""
        fitness, measures = self.judge(run, genomes)
        run.tell(fitness, measures)
        members = [str(member) for member in run.members()]
        return _text([_dumped(run, genomes), members, fitness.tolist()])

    def _history(self, run: EvolverRun, turns: int | None = None) -> list[str]:
        return [self._turn(run) for _ in range(self.turns if turns is None else turns)]

    def _look(self, run: EvolverRun, genomes: Sequence[Any]) -> None:
        run.state()
        run.members()
        run.genomes()
        for genome in genomes:
            run.express(genome)
            run.dump(genome)

    def _refuses(self, spoil: Callable[[Floats], Floats]) -> None:
        run = self.start()
        genomes = run.ask()
        fitness, measures = self.judge(run, genomes)
        spoiled = spoil(fitness)
        with pytest.raises(ValueError, match=r"."):
            run.tell(spoiled, measures)
        history = [self._tell(run, genomes), *self._history(run, self.turns - 1)]
        assert history == self._history(self.start())


_MISSING: Any = object()
_JUNK: st.SearchStrategy[Any] = st.one_of(
    st.sampled_from([None, True, -1, 0, 2, 10**400, math.nan, math.inf, "", "sin", [], {}, [[]], [{}]]),
    st.floats(),
    st.just(_MISSING),
)


def _places(value: Any) -> Iterator[tuple[Any, ...]]:
    """Return the keys that lead to each of the JSON values within *value*, which is the first."""
    yield ()
    if isinstance(value, dict | list):
        for key in value if isinstance(value, dict) else range(len(value)):
            yield from ((key, *rest) for rest in _places(value[key]))


def _damaged(value: Any, place: tuple[Any, ...], junk: Any) -> Any:
    """Return *value* with *junk* at a place, or without it if that is :data:`_MISSING`."""
    if not place:
        return None if junk is _MISSING else junk
    parent = functools.reduce(lambda within, key: within[key], place[:-1], value)
    if junk is _MISSING:
        del parent[place[-1]]
    else:
        parent[place[-1]] = junk
    return value


def _with_last(value: float, fitness: Floats) -> Floats:
    return np.append(fitness[:-1], value)


def _dumped(run: EvolverRun, genomes: Sequence[Any]) -> list[str]:
    return [_text(run.dump(genome)) for genome in genomes]


def _text(value: Any) -> str:
    """Return JSON text that shows everything, the order of dictionaries too."""
    return json.dumps(value, allow_nan=False)


@contextlib.contextmanager
def _globally_seeded(seed: int) -> Iterator[None]:
    states = random.getstate(), np.random.get_state()  # noqa: NPY002 - others may use it
    random.seed(seed)
    np.random.seed(seed)  # noqa: NPY002
    try:
        yield
    finally:
        random.setstate(states[0])
        np.random.set_state(states[1])  # noqa: NPY002
