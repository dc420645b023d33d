"""One population: who is its fittest, and how its champion stands and falls."""

from __future__ import annotations

import numpy as np
import pytest
import toys
from hypothesis import given, strategies as st

from evoframe import PopulationReport, RunError
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
