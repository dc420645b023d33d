"""The laws of evolvers."""

from __future__ import annotations

import contextlib
import functools
import json
import math
import random
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
import pytest
from hypothesis import strategies as st

from evoframe.contract import EvolverRun, NetworkGraph, SupportsGraph
from evoframe.testing.evolving import Floats, dumped_all, json_text
from evoframe.testing.laws import (
    JUNK,
    damaged_at,
    for_all,
    global_random_state_untouched,
    places_in,
    refusal,
    same_bits,
)
from evoframe.testing.seeding import SeedingLaws

__all__ = ["EvolverContract"]


class EvolverContract(SeedingLaws):
    """The laws of an :class:`~evoframe.Evolver` and of the run that it starts.

    The tests supply the measures that the evolver wants. Graphs of genomes are tested if the evolver returns
    them; loading and seeds, if its runs offer them.

    Attributes:
        inputs: Number of inputs of its networks.
        outputs: Number of outputs of its networks.
        size: Size of the population.
        turns: Number of turns of the tests.
    """

    def test_sizes_are_refused_by_a_configuration_error(self) -> None:
        """``check`` raises only ``ConfigurationError`` with a message, and accepts the tested size."""
        for size in range(1, 41):
            assert refusal(self.component.check, size) != "", (
                f"check({size}) raises an error without a message"
            )
        refused = refusal(self.component.check, self.size)
        assert refused is None, f"check() must accept the tested size {self.size}, or override 'size'"

    def test_it_starts_a_run(self) -> None:
        """``start`` returns an ``EvolverRun`` with every method of the protocol."""
        assert isinstance(self.start(), EvolverRun), "start() must return an EvolverRun; a method is missing"

    def test_wanted_measures_are_a_tuple_of_different_names(self) -> None:
        """``wants`` is a tuple of names, without repeats, if the evolver has it."""
        wanted = getattr(self.component, "wants", ())
        assert isinstance(wanted, tuple), f"wants must be a tuple, found {type(wanted).__name__}"
        assert all(isinstance(name, str) and name.strip() for name in wanted), (
            f"wants must be strings that are not empty, found {wanted}"
        )
        assert len(set(wanted)) == len(wanted), f"wants must be different names, found {wanted}"

    def test_the_population_keeps_its_size(self) -> None:
        """``ask`` returns as many genomes as the population has members, in every turn."""
        for _, genomes in self._play(self.start()):
            assert len(genomes) == self.size, f"ask() must return {self.size} genomes, found {len(genomes)}"

    def test_ids_are_unique(self) -> None:
        """Members of a population have different ids, one member for each genome."""
        for run, _ in self._play(self.start()):
            ids = [member.id for member in run.members()]
            assert len(set(ids)) == len(ids) == self.size, (
                f"members() must return {self.size} members with different ids, found the ids {ids}"
            )

    def test_an_id_stands_for_one_genome(self) -> None:
        """An id belongs to the same genome during the whole run."""
        known: dict[int, str] = {}
        for run, genomes in self._play(self.start()):
            for member, genome in zip(run.members(), genomes, strict=True):
                dumped = json_text(run.dump(genome))
                assert known.setdefault(member.id, dumped) == dumped, (
                    f"the id {member.id} belongs to two different genomes"
                )

    def test_genomes_are_those_of_the_last_ask(self) -> None:
        """``genomes`` returns the genomes of the last ``ask``, before and after ``tell``."""
        run = self.start()
        for _ in range(self.turns):
            asked = dumped_all(run, run.ask())
            assert dumped_all(run, run.genomes()) == asked, "genomes() must equal the last ask()"
            self._tell(run, run.genomes())
            assert dumped_all(run, run.genomes()) == asked, (
                "genomes() must equal the last ask(), also after tell()"
            )

    def test_genomes_outlive_the_next_ask(self) -> None:
        """``ask`` does not change the genomes of the call before, which can still be in use."""
        earlier: list[Any] = []
        dumped: list[str] = []
        for run, genomes in self._play(self.start()):
            assert dumped_all(run, earlier) == dumped, "ask() must not change the genomes that it replaces"
            earlier, dumped = list(genomes), dumped_all(run, genomes)

    def test_members_have_the_fitness_of_tell_in_order(self) -> None:
        """Members have the fitness passed to ``tell``, in order; initial members have none before."""
        run = self.start()
        for turn in range(self.turns):
            genomes = run.ask()
            if turn == 0:
                initial = [member.fitness for member in run.members()]
                assert initial == [None] * self.size, (
                    "initial members must have the fitness None before tell()"
                )
            fitness, measures = self.judge(run, genomes)
            run.tell(fitness, measures)
            assert [member.fitness for member in run.members()] == fitness.tolist(), (
                "members() must return the fitness passed to tell(), in the order of ask()"
            )

    def test_a_wrong_number_of_values_is_refused(self) -> None:
        """``tell`` refuses a wrong number of fitness values, and the run is unchanged."""
        self._refuses(lambda fitness: fitness[:-1])
        self._refuses(lambda fitness: np.append(fitness, 0.0))

    def test_fitness_that_is_not_finite_is_refused(self) -> None:
        """``tell`` refuses infinite and NaN fitness, and the run is unchanged."""
        for value in (math.nan, math.inf, -math.inf):
            self._refuses(functools.partial(_with_last, value))

    def test_the_same_seed_gives_the_same_evolution(self) -> None:
        """Runs with the same seed are equal, to the last bit."""
        assert self._history(self.start()) == self._history(self.start()), (
            "two runs with the same seed differ; draw from the generator passed to start() only"
        )

    def test_another_seed_gives_another_evolution(self) -> None:
        """Runs with different seeds differ."""
        assert self._history(self.start(seed=1)) != self._history(self.start(seed=2)), (
            "two runs with different seeds are equal; draw from the generator passed to start()"
        )

    def test_a_restored_run_continues_bit_for_bit(self) -> None:
        """A run restored from JSON text after any turn continues as the original, whatever its seed."""
        expected = self._history(self.start())
        run = self.start()
        for turn in range(self.turns):
            self._turn(run)
            restored = self.start(seed=turn + 100)
            restored.restore(json.loads(json_text(run.state())))
            assert list(restored.members()) == list(run.members()), "restore() must restore the members"
            assert dumped_all(restored, restored.genomes()) == dumped_all(run, run.genomes()), (
                "restore() must restore the genomes of the last ask()"
            )
            assert json_text(restored.state()) == json_text(run.state()), (
                "state() must equal the restored state"
            )
            assert self._history(restored, self.turns - turn - 1) == expected[turn + 1 :], (
                f"the run restored after turn {turn} continues differently; is the random state restored?"
            )

    def test_reading_a_run_does_not_change_it(self) -> None:
        """``state``, ``members``, ``genomes``, ``express`` and ``dump`` can be called at any time."""
        run, read = self.start(), []
        for _ in range(self.turns):
            genomes = run.ask()
            self._read(run, genomes)
            read.append(self._tell(run, genomes))
            self._read(run, genomes)
        assert read == self._history(self.start()), (
            "calling state(), members(), genomes(), express() or dump() changes the run"
        )

    def test_interleaved_runs_equal_each_alone(self) -> None:
        """Two populations in one process do not affect each other."""
        one, other = self.start(seed=1), self.start(seed=2)
        histories = [(self._turn(one), self._turn(other)) for _ in range(self.turns)]
        shared = "two runs in one process affect each other; keep all state in the run"
        assert [turn for turn, _ in histories] == self._history(self.start(seed=1)), shared
        assert [turn for _, turn in histories] == self._history(self.start(seed=2)), shared

    def test_global_random_states_are_not_changed(self) -> None:
        """A run does not draw from the global generators of Python and numpy, not even in ``restore``."""
        with global_random_state_untouched():
            run = self.start()
            self._history(run)
            self.start().restore(json.loads(json_text(run.state())))

    def test_global_random_states_do_not_matter(self) -> None:
        """A run does not depend on the global generators of Python and numpy."""
        with _globally_seeded(1):
            first = self._history(self.start())
        with _globally_seeded(2):
            second = self._history(self.start())
        assert first == second, (
            "the run depends on global random state; draw from the generator passed to start() only"
        )

    def test_networks_give_finite_outputs(self) -> None:
        """Networks return finite ``float64[n, outputs]`` for every ``float64[n, inputs]``."""
        networks = [run.express(genome) for run, genomes in self._play(self.start()) for genome in genomes]

        def law(seed: int, scale: float, data: st.DataObject) -> None:
            network = networks[data.draw(st.integers(0, len(networks) - 1), label="network")]
            outputs = network(self._points(seed, scale))
            assert outputs.dtype == np.float64, f"a network must return float64, found {outputs.dtype}"
            assert outputs.shape == (16, self.outputs), (
                f"a network must return shape (16, {self.outputs}) for 16 points, found {outputs.shape}"
            )
            assert np.isfinite(outputs).all(), "a network must return finite outputs for finite points"

        scales = st.sampled_from([0.0, 1.0, 20.0, 1e6, 1e50])
        for_all(law, seed=st.integers(0, 2**32 - 1), scale=scales, data=st.data())

    def test_networks_are_functions(self) -> None:
        """A network returns the same outputs for the same points, and does not change them."""
        for run, genomes in self._play(self.start()):
            points = self._points(0, 20.0)
            outputs = [network(points) for network in (run.express(genomes[-1]),) * 2]
            assert same_bits(points, self._points(0, 20.0)), "a network must not change its points"
            assert same_bits(outputs[0], outputs[1]), (
                "a network returns different outputs for the same points"
            )
            assert same_bits(outputs[0], run.express(genomes[-1])(points)), (
                "express() returns different networks for the same genome"
            )

    def test_a_dumped_genome_is_json(self) -> None:
        """A dumped genome is equal after a round trip through JSON text."""
        for run, genomes in self._play(self.start()):
            for genome in genomes:
                dumped = run.dump(genome)
                assert json.loads(json_text(dumped)) == dumped, (
                    "dump() must return values that survive a round trip through JSON: lists, not tuples"
                )

    def test_a_graph_has_the_networks_inputs_and_outputs(self) -> None:
        """All nodes except the inputs have labels, and links connect nodes, in every generation."""
        for dumped in self._drawable():
            self._assert_sound(self._graph(dumped))

    def test_a_genome_has_one_graph(self) -> None:
        """A genome has the same graph every time, also when read from JSON text, and is not changed."""
        for dumped in self._drawable():
            before = json_text(dumped)
            graph = self._graph(dumped)
            assert self._graph(dumped) == graph, "graph() returns different graphs for the same genome"
            assert self._graph(json.loads(before)) == graph, "graph() differs after a round trip through JSON"
            assert json_text(dumped) == before, "graph() must not change the genome"

    def test_a_damaged_genome_is_refused_by_a_value_error(self) -> None:
        """A damaged genome gives a ``ValueError`` or a valid graph."""
        texts = [json_text(dumped) for dumped in self._drawable()][:: self.size]

        def law(text: str, junk: Any, data: st.DataObject) -> None:
            genome = json.loads(text)
            damaged = damaged_at(data.draw(st.sampled_from(list(places_in(genome)))), genome, junk)
            with contextlib.suppress(ValueError):
                self._assert_sound(self._graph(damaged))

        if texts:
            for_all(law, text=st.sampled_from(texts), junk=JUNK, data=st.data())

    def _drawable(self) -> Iterator[Any]:
        """Return dumped genomes of several generations if the evolver returns graphs, else nothing."""
        if isinstance(self.component, SupportsGraph):
            for run, genomes in self._play(self.start()):
                yield from map(run.dump, genomes)

    def _graph(self, dumped: Any) -> NetworkGraph:
        assert isinstance(self.component, SupportsGraph)
        graph = self.component.graph(dumped, self.inputs, self.outputs)
        assert isinstance(graph, NetworkGraph), (
            f"graph() must return a NetworkGraph, found {type(graph).__name__}"
        )
        return graph

    def _assert_sound(self, graph: NetworkGraph) -> None:
        n_inputs, n_outputs = len(graph.inputs), len(graph.outputs)
        assert n_inputs == self.inputs, f"a graph must have {self.inputs} inputs, found {n_inputs}"
        assert n_outputs == self.outputs, f"a graph must have {self.outputs} outputs, found {n_outputs}"
        ends = [*graph.inputs, *graph.outputs]
        assert len(set(ends)) == len(ends), f"inputs and outputs must have different ids, found {ends}"
        labeled = sorted(set(graph.inputs) & set(graph.labels))
        assert not labeled, (
            f"inputs must not have labels (the encoder names them), found labels for {labeled}"
        )
        unlabeled = sorted(set(graph.outputs) - set(graph.labels))
        assert not unlabeled, f"outputs must have labels, found none for {unlabeled}"
        assert all(isinstance(label, str) and label.strip() for label in graph.labels.values()), (
            f"labels must be strings that are not empty, found {dict(graph.labels)}"
        )
        for link in graph.links:
            assert link.start in graph.labels or link.start in graph.inputs, (
                f"links must start at a node of the graph, found {link.start}"
            )
            assert link.end in graph.labels, (
                f"links must end at a node that is not an input, found {link.end}"
            )
            assert math.isfinite(link.weight), f"links must have finite weights, found {link.weight}"

    def _refuses(self, spoil: Callable[[Floats], Floats]) -> None:
        run = self.start()
        genomes = run.ask()
        fitness, measures = self.judge(run, genomes)
        spoiled = spoil(fitness)
        with pytest.raises(ValueError, match=r"."):
            run.tell(spoiled, measures)
        history = [self._tell(run, genomes), *self._history(run, self.turns - 1)]
        assert history == self._history(self.start()), "a refused tell() must not change the run"


def _with_last(value: float, fitness: Floats) -> Floats:
    return np.append(fitness[:-1], value)


@contextlib.contextmanager
def _globally_seeded(seed: int) -> Iterator[None]:
    states = random.getstate(), np.random.get_state()  # noqa: NPY002 - restored below for other tests
    random.seed(seed)
    np.random.seed(seed)  # noqa: NPY002
    try:
        yield
    finally:
        random.setstate(states[0])
        np.random.set_state(states[1])  # noqa: NPY002
