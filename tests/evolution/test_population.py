"""One population: its genomes and what they decode to, its fittest, and how its champion stands and falls."""

from __future__ import annotations

import json
from typing import Any

import numpy as np
import pytest
import toys
from hypothesis import given, strategies as st

from evoframe import Design, Member, PopulationReport, RunError, StructureError
from evoframe.errors import ComponentError
from evoframe.evolution.population import Population


def unjudged() -> Population:
    rng = np.random.default_rng(0)
    return Population("a", toys.Number(), toys.DriftRun(step=0.1, size=0, rng=rng), rng)


def judged(
    population: Population, ids: list[int], fitness: list[float | None], floor: float | None = None
) -> PopulationReport:
    """Replace the members by those with the *ids*, and judge them."""
    evolver = population.evolver
    assert isinstance(evolver, toys.DriftRun)
    evolver.ids, evolver.size = ids, len(ids)
    population.judge(fitness, floor)
    return population.report()


@pytest.fixture
def population() -> Population:
    return unjudged()


class TestChampion:
    def test_falls_when_it_meets_new_collaborators(self, population: Population) -> None:
        assert judged(population, [1, 2], [5.0, 1.0]).standing_champion == 5.0
        assert judged(population, [1, 3], [2.0, 1.0]).standing_champion == 2.0

    def test_is_replaced_by_who_beats_its_latest_fitness(self, population: Population) -> None:
        judged(population, [1, 2], [5.0, 1.0])
        report = judged(population, [1, 3], [2.0, 3.0])
        assert (report.standing_champion, report.best, report.best_so_far) == (3.0, 3.0, 5.0)

    def test_stands_still_when_it_has_left_the_population(self, population: Population) -> None:
        judged(population, [1, 2], [5.0, 1.0])
        assert judged(population, [3, 4], [2.0, 3.0]).standing_champion == 5.0

    def test_a_diverged_champion_gives_way_to_a_clean_one(self, population: Population) -> None:
        judged(population, [1, 2], [5.0, 1.0])
        report = judged(population, [1, 2], [None, 0.5])
        assert (report.standing_champion, report.members[0].fitness) == (0.5, 0.5)

    def test_without_a_clean_one_the_lowest_that_the_population_has_had_counts(
        self, population: Population
    ) -> None:
        judged(population, [1, 2], [5.0, -1.0])
        judged(population, [1, 2], [3.0, 2.0])
        report = judged(population, [1, 2], [None, None])
        assert [member.fitness for member in report.members] == [-1.0, -1.0]

    def test_before_there_was_one_the_lowest_score_of_the_turn_counts(self, population: Population) -> None:
        report = judged(population, [1, 2], [None, None], floor=0.25)
        assert [member.fitness for member in report.members] == [0.25, 0.25]

    def test_nobody_is_the_fittest_before_anybody_was_judged(self, population: Population) -> None:
        with pytest.raises(RunError, match="population 'a' has no members before the first turn"):
            population.fittest()


@given(st.lists(st.floats(-1e3, 1e3), min_size=1, max_size=20))
def test_the_fittest_is_the_first_of_the_best(fitness: list[float]) -> None:
    population = unjudged()
    judged(population, list(range(len(fitness))), list(fitness))
    assert population.fittest() == fitness.index(max(fitness))


def begun(size: int = 4, seed: int = 0) -> Population:
    """Return a population with its first genomes."""
    rng = np.random.default_rng(seed)
    population = Population("a", toys.Number(), toys.Drift().start(1, 1, size, rng), np.random.default_rng(1))
    population.reproduce()
    return population


class TestReproduction:
    def test_replaces_genomes_members_and_networks(self) -> None:
        population = begun()
        first, network = list(population.genomes), population.network(3)
        assert population.network(3) is network  # it is asked for with every encounter
        population.judge([1.0, 2.0, 3.0, 4.0], None)
        population.reproduce()
        assert population.generation == 1
        assert list(population.genomes)[2:] != first[2:]
        assert population.network(3) is not network
        assert [member.id for member in population.members] == [4, 3, 5, 6]

    @pytest.mark.parametrize("counts", [(0, 0), (3, 4), (4, 3), (5, 5)])
    def test_gives_as_many_as_before(self, monkeypatch: pytest.MonkeyPatch, counts: tuple[int, int]) -> None:
        population = begun()
        genomes, members = counts
        monkeypatch.setattr(toys.DriftRun, "ask", lambda _: [0.0] * genomes)
        monkeypatch.setattr(toys.DriftRun, "members", lambda _: [Member(i, None) for i in range(members)])
        message = (
            rf"^populations\.a\.evolver: gave {genomes} genomes and {members} members, expected 4 of each"
        )
        with pytest.raises(ComponentError, match=message):
            population.reproduce()
        assert population.generation == 0


class TestDecoding:
    def test_adds_what_the_encoder_provides(self) -> None:
        population = begun()
        design = population.decode(1, Design({"b": np.ones(1)}))
        assert design.roles.keys() == {"a", "b"}
        assert design.roles["a"][0] == population.genomes[1]

    def test_without_what_the_encoder_provides_is_its_fault(self, monkeypatch: pytest.MonkeyPatch) -> None:
        monkeypatch.setattr(toys.Number, "decode", lambda _, network, design: design)
        with pytest.raises(ComponentError, match=r"^populations\.a\.encoder: left out the role 'a' \(a 2\)$"):
            begun().decode(1, Design())

    def test_of_a_genome_that_is_dumped_says_the_same(self) -> None:
        population = begun()
        assert [population.dump(position) for position in range(4)] == list(population.genomes)


class TestState:
    @given(
        st.lists(st.lists(st.none() | st.floats(-1e3, 1e3), min_size=4, max_size=4), min_size=1, max_size=4)
    )
    def test_is_all_that_is_needed_to_continue(self, fitness: list[list[float | None]]) -> None:
        one, other = begun(seed=3), begun(seed=4)
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
        ("change", "message"),
        [
            ({"generation": -2}, "a.generation: must be >= -1, found -2"),
            ({"generation": "1"}, 'a.generation: expected a whole number, found "1"'),
            ({"diverged": 3}, "a.diverged: expected a list, found 3"),
            ({"more": 1}, "a.more: unknown option"),
        ],
    )
    def test_that_is_none_is_refused_with_its_place(self, change: dict[str, Any], message: str) -> None:
        population = begun()
        population.judge([1.0] * 4, None)
        with pytest.raises(StructureError) as caught:
            begun().restore({**population.state(), **change})
        assert str(caught.value).startswith(message)


def test_there_is_nothing_to_report_before_anybody_was_judged() -> None:
    with pytest.raises(RunError, match="population 'a' was not judged yet"):
        begun().report()


def test_nothing_can_be_compared_where_everything_diverged() -> None:
    with pytest.raises(
        RunError, match=r"every simulation of the initial meeting diverged.*check the simulator"
    ):
        begun().judge([None] * 4, None)
