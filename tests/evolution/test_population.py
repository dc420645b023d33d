"""Tests of one population: its genomes, decoding, its fittest member, and its champion."""

from __future__ import annotations

import json
from typing import Any

import numpy as np
import pytest
import toy_capabilities as caps
import toys
from hypothesis import given, strategies as st
from numpy.typing import NDArray

from evoframe import Archived, Design, Member, Network, PopulationReport, RunError, StructureError
from evoframe.errors import ComponentError
from evoframe.evolution.population import Population


def empty_population() -> Population:
    rng = np.random.default_rng(0)
    return Population("a", toys.Number(), toys.DriftRun(step=0.1, size=0, rng=rng), rng)


def evaluated(
    population: Population, ids: list[int], fitness: list[float | None], floor: float | None = None
) -> PopulationReport:
    """Replace the members with individuals with these *ids*, and set their fitness."""
    evolver = population.evolver
    assert isinstance(evolver, toys.DriftRun)
    evolver.ids, evolver.size = ids, len(ids)
    population.judge(fitness, floor)
    return population.report()


@pytest.fixture
def population() -> Population:
    return empty_population()


class TestChampion:
    def test_its_fitness_falls_with_new_collaborators(self, population: Population) -> None:
        assert evaluated(population, [1, 2], [5.0, 1.0]).standing_champion == 5.0
        assert evaluated(population, [1, 3], [2.0, 1.0]).standing_champion == 2.0

    def test_is_replaced_if_its_latest_fitness_is_exceeded(self, population: Population) -> None:
        evaluated(population, [1, 2], [5.0, 1.0])
        report = evaluated(population, [1, 3], [2.0, 3.0])
        assert (report.standing_champion, report.best, report.best_so_far) == (3.0, 3.0, 5.0)

    def test_keeps_its_fitness_after_leaving_the_population(self, population: Population) -> None:
        evaluated(population, [1, 2], [5.0, 1.0])
        assert evaluated(population, [3, 4], [2.0, 3.0]).standing_champion == 5.0

    def test_a_diverged_champion_is_replaced_by_a_clean_one(self, population: Population) -> None:
        evaluated(population, [1, 2], [5.0, 1.0])
        report = evaluated(population, [1, 2], [None, 0.5])
        assert (report.standing_champion, report.members[0].fitness) == (0.5, 0.5)

    def test_without_a_clean_member_the_lowest_fitness_so_far_counts(self, population: Population) -> None:
        evaluated(population, [1, 2], [5.0, -1.0])
        evaluated(population, [1, 2], [3.0, 2.0])
        report = evaluated(population, [1, 2], [None, None])
        assert [member.fitness for member in report.members] == [-1.0, -1.0]

    def test_without_any_fitness_the_lowest_score_of_the_turn_counts(self, population: Population) -> None:
        report = evaluated(population, [1, 2], [None, None], floor=0.25)
        assert [member.fitness for member in report.members] == [0.25, 0.25]

    def test_a_population_without_members_has_no_fittest(self, population: Population) -> None:
        with pytest.raises(RunError, match=r"'a' .*members"):
            population.fittest()


@given(st.lists(st.floats(-1e3, 1e3), min_size=1, max_size=20))
def test_the_fittest_is_the_first_of_the_best(fitness: list[float]) -> None:
    population = empty_population()
    evaluated(population, list(range(len(fitness))), list(fitness))
    assert population.fittest() == fitness.index(max(fitness))


def new_population(size: int = 4, seed: int = 0) -> Population:
    """Return a population with its initial genomes."""
    rng = np.random.default_rng(seed)
    population = Population("a", toys.Number(), toys.Drift().start(1, 1, size, rng), np.random.default_rng(1))
    population.reproduce()
    return population


class TestReproduction:
    def test_replaces_genomes_members_and_networks(self) -> None:
        population = new_population()
        first, network = list(population.genomes), population.network(3)
        assert population.network(3) is network  # every pair requires it
        population.judge([1.0, 2.0, 3.0, 4.0], None)
        population.reproduce()
        assert population.generation == 1
        assert list(population.genomes)[2:] != first[2:]
        assert population.network(3) is not network
        assert [member.id for member in population.members] == [4, 3, 5, 6]

    @pytest.mark.parametrize("counts", [(0, 0), (3, 4), (4, 3), (5, 5)])
    def test_returns_as_many_as_before(
        self, monkeypatch: pytest.MonkeyPatch, counts: tuple[int, int]
    ) -> None:
        population = new_population()
        genomes, members = counts
        monkeypatch.setattr(toys.DriftRun, "ask", lambda _: [0.0] * genomes)
        monkeypatch.setattr(toys.DriftRun, "members", lambda _: [Member(i, None) for i in range(members)])
        numbers = f"{genomes} genomes.*{members} members.*4"
        with pytest.raises(ComponentError, match=numbers) as caught:
            population.reproduce()
        assert caught.value.component == "populations.a.evolver"
        assert population.generation == 0


class TestBreeding:
    def test_changes_nothing_until_reproduction(self) -> None:
        population, alone = new_population(), new_population()
        for each in (population, alone):
            each.judge([1.0, 2.0, 3.0, 4.0], None)
        population.breed()
        assert (population.generation, population.genomes) == (0, alone.genomes)
        assert population.members == alone.members
        assert population.state() == alone.state()
        for each in (population, alone):
            each.reproduce()
        assert (population.generation, population.genomes) == (1, alone.genomes)
        assert population.members == alone.members
        for each in (population, alone):
            each.judge([1.0, 2.0, 3.0, 4.0], None)
        assert population.state() == alone.state()

    def test_reports_an_error_of_the_evolver_when_it_is_needed(self, monkeypatch: pytest.MonkeyPatch) -> None:
        def failing(_: toys.DriftRun) -> Any:
            raise ValueError("no offspring")

        population = new_population()
        population.judge([1.0, 2.0, 3.0, 4.0], None)
        monkeypatch.setattr(toys.DriftRun, "ask", failing)
        population.breed()
        assert population.generation == 0
        with pytest.raises(ComponentError, match="no offspring") as caught:
            population.reproduce()
        assert caught.value.component == "populations.a.evolver"

    def test_is_discarded_when_a_state_is_restored(self) -> None:
        population = new_population()
        population.judge([1.0, 2.0, 3.0, 4.0], None)
        state = json.loads(json.dumps(population.state()))
        population.breed()
        population.restore(state)
        assert population.state() == state
        population.reproduce()
        assert population.generation == 1


class TestNetwork:
    def test_evaluates_the_same_read_only_points_once(self, monkeypatch: pytest.MonkeyPatch) -> None:
        evaluated = counted_evaluations(monkeypatch)
        network, points = new_population().network(3), np.ones((2, 1))
        points.setflags(write=False)
        values = network(points)
        assert network(points) is values
        assert not values.flags.writeable  # an encoder that changed them would change all other bodies
        assert len(evaluated) == 1

    def test_evaluates_other_points_and_those_that_can_change_again(
        self, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        evaluated = counted_evaluations(monkeypatch)
        network, points = new_population().network(3), np.ones((2, 1))
        points.setflags(write=False)
        changing = np.ones((2, 1))
        for asked in (points, changing, changing, points.copy(), points):
            network(asked)
        assert len(evaluated) == 4
        changing[0] = 2.0
        assert network(changing).tolist() == [[2.0 * network(points)[0, 0]], [network(points)[0, 0]]]


def counted_evaluations(monkeypatch: pytest.MonkeyPatch) -> list[Any]:
    """Return a list that receives the points of each evaluation of a network."""
    evaluated: list[Any] = []

    def express(_: Any, genome: float) -> Network:
        def network(points: NDArray[np.float64]) -> NDArray[np.float64]:
            evaluated.append(points)
            return points * genome

        return network

    monkeypatch.setattr(toys.DriftRun, "express", express)
    return evaluated


class TestDecoding:
    def test_adds_the_roles_that_the_encoder_provides(self) -> None:
        population = new_population()
        design = population.decode(1, Design({"b": np.ones(1)}))
        assert design.roles.keys() == {"a", "b"}
        assert design.roles["a"][0] == population.genomes[1]

    def test_a_missing_role_is_attributed_to_the_encoder(self, monkeypatch: pytest.MonkeyPatch) -> None:
        monkeypatch.setattr(toys.Number, "decode", lambda _, network, design: design)
        with pytest.raises(ComponentError, match="role 'a'") as caught:
            new_population().decode(1, Design())
        assert (caught.value.component, caught.value.concerns) == ("populations.a.encoder", "a 2")

    def test_dumps_the_same_genomes(self) -> None:
        population = new_population()
        assert [population.dump(position) for position in range(4)] == list(population.genomes)


class TestState:
    @given(
        st.lists(st.lists(st.none() | st.floats(-1e3, 1e3), min_size=4, max_size=4), min_size=1, max_size=4)
    )
    def test_is_sufficient_to_continue(self, fitness: list[list[float | None]]) -> None:
        one, other = new_population(seed=3), new_population(seed=4)
        for row in fitness:
            one.judge(row, 0.0)
            other.restore(json.loads(json.dumps(one.state())))
            assert other.report() == one.report()
            assert other.state() == one.state()
            for population in (one, other):
                population.reproduce()
            assert list(other.genomes) == list(one.genomes)
            assert other.rng.random() == one.rng.random()

    @pytest.mark.parametrize(
        ("change", "parts"),
        [
            ({"generation": -2}, [">= -1", "found -2"]),
            ({"generation": "1"}, ["whole number", 'found "1"']),
            ({"diverged": 3}, ["a list", "found 3"]),
            ({"more": 1}, ["unknown option"]),
        ],
    )
    def test_an_invalid_state_is_refused_with_its_key(self, change: dict[str, Any], parts: list[str]) -> None:
        population = new_population()
        population.judge([1.0] * 4, None)
        with pytest.raises(StructureError) as caught:
            new_population().restore({**population.state(), **change})
        [fault] = caught.value.faults
        assert fault.path == ("a", *change)
        assert all(part in fault.message for part in parts)


def test_a_population_without_fitness_has_no_report() -> None:
    with pytest.raises(RunError, match=r"'a' .*fitness"):
        new_population().report()


def test_no_fitness_can_be_assigned_if_all_simulations_diverged() -> None:
    with pytest.raises(RunError, match="diverged"):
        new_population().judge([None] * 4, None)


def test_an_error_of_a_network_is_attributed_to_the_evolver(monkeypatch: pytest.MonkeyPatch) -> None:
    """The encoder calls it while decoding."""

    def network(_: NDArray[np.float64]) -> NDArray[np.float64]:
        raise ZeroDivisionError("no weights")

    monkeypatch.setattr(toys.DriftRun, "express", lambda *_: network)
    with pytest.raises(ComponentError, match="ZeroDivisionError: no weights") as caught:
        new_population().decode(2, Design())
    assert (caught.value.component, caught.value.concerns) == ("populations.a.evolver", "a 3")


class TestArrayTypes:
    def typed(self, **options: Any) -> Population:
        encoder, rng = caps.Typed("a", **options), np.random.default_rng(0)
        population = Population("a", encoder, toys.Drift().start(1, 1, 4, rng), np.random.default_rng(1))
        population.reproduce()
        return population

    def test_that_fit_are_accepted(self) -> None:
        assert self.typed().decode(0, Design()).roles["a"].shape == (1,)
        assert self.typed(needs=("b",)).decode(0, Design({"b": np.ones(1)})).roles.keys() == {"a", "b"}

    @pytest.mark.parametrize(
        ("options", "design", "problem"),
        [
            ({"dtype": "uint8"}, Design(), "provided float64[1] for the role 'a', expected uint8[1]"),
            ({"length": 2}, Design(), "provided float64[1] for the role 'a', expected float64[2]"),
            (
                {"needs": ("b",)},
                Design({"b": np.ones((1, 1))}),
                "received float64[1, 1] for the role 'b', expected float64[1]",
            ),
        ],
    )
    def test_that_do_not_fit_are_attributed_to_the_encoder(
        self, options: dict[str, Any], design: Design, problem: str
    ) -> None:
        with pytest.raises(ComponentError) as caught:
            self.typed(**options).decode(1, design)
        assert caught.value.problem == problem
        assert (caught.value.component, caught.value.concerns) == ("populations.a.encoder", "a 2")


class TestCandidates:
    def test_are_the_members_unless_all_populations_reproduce(self) -> None:
        population = new_population()
        population.judge([1.0, 2.0, 3.0, 4.0], None)
        population.reproduce()
        assert population.candidates is population.members

    def test_are_the_generation_before_if_all_populations_reproduce(self) -> None:
        population = new_population()
        population.judge([1.0, 2.0, 3.0, 4.0], None)
        before, genomes = population.members, list(population.genomes)
        population.reproduce(keep_candidates=True)
        assert population.candidates == before
        assert [member.fitness for member in population.candidates] == [1.0, 2.0, 3.0, 4.0]
        assert [member.id for member in population.members] == [4, 3, 5, 6]
        assert population.admit(3) == 0  # it has survived
        assert population.admit(0) == population.admit(0) == 4
        assert population.dump(4) == genomes[0]
        assert population.decode(4, Design()).roles["a"][0] == genomes[0]
        assert population.present == (*population.members, before[0])
        population.begin_turn()
        assert population.candidates is population.members
        assert population.present == population.members

    def test_networks_of_guests_are_not_kept_for_the_next_ones(self) -> None:
        population = new_population()
        population.judge([1.0, 2.0, 3.0, 4.0], None)
        genomes = list(population.genomes)
        population.reproduce(keep_candidates=True)
        population.admit(0)
        assert population.decode(4, Design()).roles["a"][0] == genomes[0]
        population.judge([1.0, 2.0, 3.0, 4.0], None)
        population.begin_turn()
        last = list(population.genomes)
        population.reproduce(keep_candidates=True)
        assert population.admit(0) == 4
        assert population.decode(4, Design()).roles["a"][0] == last[0]

    def test_guests_of_a_population_that_does_not_reproduce_are_replaced_in_the_next_turn(self) -> None:
        rng = np.random.default_rng(0)
        population = Population("a", toys.Number(), caps.Wanting().start(1, 1, 4, rng), rng)
        population.reproduce()
        for key, genome in ((50, 0.5), (60, 0.25)):
            population.begin_turn()
            assert population.admit(Archived(Member(id=key, fitness=1.0), genome)) == 4
            assert population.decode(4, Design()).roles["a"][0] == genome

    def test_are_discarded_when_a_state_is_restored(self) -> None:
        population = new_population()
        population.judge([1.0, 2.0, 3.0, 4.0], None)
        population.reproduce(keep_candidates=True)
        population.admit(0)
        population.judge([1.0, 2.0, 3.0, 4.0], None)
        population.restore(json.loads(json.dumps(population.state())))
        assert population.candidates == population.present == population.members


class TestMeasures:
    def test_are_told_to_the_evolver_with_the_lowest_for_diverged_individuals(
        self, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        told: list[dict[str, list[float]]] = []
        monkeypatch.setattr(
            toys.DriftRun,
            "tell",
            lambda _, fitness, measures: told.append(
                {name: each.tolist() for name, each in measures.items()}
            ),
        )
        population = new_population()
        population.judge([1.0] * 4, None, {"x": [3.0, None, 2.0, None], "y": [None] * 4, "z": [1, 2, 3, 4]})
        assert told == [{"x": [3.0, 2.0, 2.0, 2.0], "y": [0.0] * 4, "z": [1.0, 2.0, 3.0, 4.0]}]

    def test_are_part_of_the_report(self) -> None:
        population = new_population()
        population.judge([1.0] * 4, None, {"x": [3.0, None, 2.0, 5.0]})
        assert population.report().measures == {"x": (3.0, 2.0, 2.0, 5.0)}
