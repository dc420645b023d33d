"""The loop, with toys for everything else."""

from __future__ import annotations

import json
import math
import statistics
from collections.abc import Callable, Iterator
from typing import Any

import attrs
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from evoframe import Coevolution, RunConfig, RunError, Turn, assemble
from evoframe.population import Population

Load = Callable[..., RunConfig]


def history(turns: Iterator[Turn] | list[Turn]) -> list[Any]:
    return [(turn.index, turn.reports, turn.pairs) for turn in turns]


def test_first_everyone_meets_everyone_and_gets_the_arithmetic_mean(toy_config: Load) -> None:
    turn = next(iter(assemble(toy_config())))
    assert turn.index == 0
    assert len(turn.pairs) == 6 * 5
    for position, report in enumerate(turn.reports):
        for member in report.members:
            scores = [pair.score for pair in turn.pairs if pair.genomes[position] == member.id]
            assert len(scores) == (5, 6)[position]
            assert member.fitness == pytest.approx(statistics.fmean(scores), rel=1e-14)


def test_then_populations_take_turns_in_order(toy_config: Load) -> None:
    turns = list(assemble(toy_config()))
    assert [turn.index for turn in turns] == list(range(9))
    assert [turn.reports[0].population for turn in turns[1:]] == ["a", "b"] * 4
    assert [turn.reports[0].generation for turn in turns[1:]] == [1, 1, 2, 2, 3, 3, 4, 4]


def test_all_members_meet_the_fittest_of_the_other_population(toy_config: Load) -> None:
    turns = list(assemble(toy_config()))
    others = {report.population: report for report in turns[0].reports}
    for turn in turns[1:]:
        [report] = turn.reports
        other = others["b" if report.population == "a" else "a"]
        fittest = sorted(other.members, key=lambda member: -member.fitness)[:2]
        column = ["a", "b"].index(report.population)
        met = {pair.genomes[1 - column] for pair in turn.pairs}
        assert met == {member.id for member in fittest}
        assert len(turn.pairs) == 2 * len(report.members)
        others[report.population] = report


def test_the_other_population_keeps_its_fitness(toy_config: Load) -> None:
    coevolution = assemble(toy_config())
    turns = iter(coevolution)
    next(turns)
    before = coevolution.populations[1].members
    next(turns)
    assert coevolution.populations[1].members == before


def test_fitness_is_the_aggregate_of_the_scores_of_its_pairs(toy_config: Load) -> None:
    for turn in list(assemble(toy_config()))[1:]:
        [report] = turn.reports
        column = ["a", "b"].index(report.population)
        for member in report.members:
            scores = [pair.score for pair in turn.pairs if pair.genomes[column] == member.id]
            assert member.fitness == pytest.approx(statistics.fmean(scores), rel=1e-14)


def test_the_best_pair_is_the_earliest_of_the_best_that_were_simulated(toy_config: Load) -> None:
    best, found = -math.inf, None
    for turn in assemble(toy_config()):
        top = max(pair.score for pair in turn.pairs)
        if top > best:
            best, found = top, turn
            assert turn.best_pair is not None
            assert (turn.best_pair.score, turn.best_pair.turn) == (top, turn.index)
            first = next(pair for pair in turn.pairs if pair.score == top)
            assert tuple(turn.best_pair.genome_ids.values()) == first.genomes
            product = np.prod([array[0] for array in turn.best_pair.design.roles.values()])
            assert product == top
        else:
            assert turn.best_pair is None
    assert found is not None


def test_best_so_far_never_falls(toy_config: Load) -> None:
    for name in "ab":
        reports = [
            r
            for turn in assemble(toy_config("run.generations=30"))
            for r in turn.reports
            if r.population == name
        ]
        assert [r.best_so_far for r in reports] == list(np.maximum.accumulate([r.best for r in reports]))


def test_equal_pairs_are_simulated_once(toy_config: Load) -> None:
    coevolution = assemble(toy_config())
    seen = set()
    for turn in coevolution:
        seen |= {pair.genomes for pair in turn.pairs}
    assert coevolution.evaluator.simulations == len(seen)


def test_the_same_seed_gives_the_same_history_and_another_seed_another(toy_config: Load) -> None:
    once, again = history(assemble(toy_config())), history(assemble(toy_config()))
    assert once == again
    assert history(assemble(toy_config("run.seed=4"))) != once


def test_two_loops_interleaved_equal_each_alone(toy_config: Load) -> None:
    first, second = assemble(toy_config()), assemble(toy_config("run.seed=9"))
    turns = [list(pair) for pair in zip(first, second, strict=True)]
    assert history([a for a, _ in turns]) == history(assemble(toy_config()))
    assert history([b for _, b in turns]) == history(assemble(toy_config("run.seed=9")))


@pytest.mark.parametrize("at", range(9))
def test_a_restored_loop_continues_bit_for_bit(toy_config: Load, at: int) -> None:
    whole = history(assemble(toy_config()))
    first = assemble(toy_config())
    for turn in first:
        if turn.index == at:
            break
    state = json.loads(json.dumps(first.state()))
    second = assemble(toy_config())
    second.restore(state)
    assert history(second) == whole[at + 1 :]
    assert second.best_score == max(pair[2][i].score for pair in whole for i in range(len(pair[2])))


def test_more_than_two_populations_are_combined_position_by_position(toy_config: Load) -> None:
    config = toy_config(
        'populations.c.encoder={name="toy-number", role="c"}',
        "populations.c.evolver=toy-drift",
        "populations.c.size=5",
    )
    turns = list(assemble(config))
    assert len(turns) == 1 + 4 * 3
    assert all(len(pair.genomes) == 3 for turn in turns for pair in turn.pairs)
    for turn in turns[1:]:
        column = ["a", "b", "c"].index(turn.reports[0].population)
        teams = {pair.genomes[:column] + pair.genomes[column + 1 :] for pair in turn.pairs}
        assert len(teams) == 2  # not 2 x 2: the i-th collaborator of one with the i-th of the other


class TestDivergence:
    def test_a_diverged_individual_gets_the_lowest_clean_fitness_and_a_mark(self, toy_config: Load) -> None:
        marked = 0
        for turn in assemble(toy_config("simulator.limit=0.15", "run.generations=20")):
            for report in turn.reports:
                column = ["a", "b"].index(report.population)
                clean = [member.fitness for member in report.members if not member.diverged]
                for member in report.members:
                    scores = [pair.score for pair in turn.pairs if pair.genomes[column] == member.id]
                    assert member.diverged == (None in scores)
                    if member.diverged and clean:
                        marked += 1
                        assert member.fitness == min(clean)
        assert marked > 0

    def test_a_diverged_pair_has_a_step_and_no_score(self, toy_config: Load) -> None:
        pairs = [pair for turn in assemble(toy_config("simulator.limit=0.15")) for pair in turn.pairs]
        assert any(pair.score is None for pair in pairs)
        assert all((pair.score is None) == (pair.diverged_at == 1) for pair in pairs)

    def test_a_diverged_one_is_neither_collaborator_nor_champion_while_a_clean_one_exists(
        self, toy_config: Load
    ) -> None:
        coevolution = assemble(toy_config("simulator.limit=0.15", "run.generations=20"))
        for _ in coevolution:
            for population in coevolution.populations:
                if any(not member.diverged for member in population.members):
                    assert not population.members[population.fittest()].diverged

    def test_a_run_of_which_nothing_is_clean_says_so(self, toy_config: Load) -> None:
        with pytest.raises(RunError, match="every simulation of the initial meeting diverged"):
            next(iter(assemble(toy_config("simulator.limit=0"))))


@attrs.define
class Scripted:
    """An evolver of which the members are given."""

    ids: list[int]

    def members(self) -> list[Any]:
        from evoframe import Member  # noqa: PLC0415

        return [Member(id=i, fitness=None) for i in self.ids]

    def tell(self, fitness: Any, measures: Any) -> None:
        pass


def judged(population: Population, ids: list[int], fitness: list[float | None]) -> Any:
    population.evolver.ids = ids  # type: ignore[attr-defined]
    population.judge(fitness, floor=None)
    return population.report()


@pytest.fixture
def population() -> Population:
    return Population("a", None, Scripted([]), np.random.default_rng(0))  # type: ignore[arg-type]


class TestChampion:
    def test_falls_when_it_meets_new_collaborators(self, population: Population) -> None:
        assert judged(population, [1, 2], [5.0, 1.0]).champion == 5.0
        assert judged(population, [1, 3], [2.0, 1.0]).champion == 2.0

    def test_is_replaced_by_who_beats_its_latest_fitness(self, population: Population) -> None:
        judged(population, [1, 2], [5.0, 1.0])
        report = judged(population, [1, 3], [2.0, 3.0])
        assert (report.champion, report.best, report.best_so_far) == (3.0, 3.0, 5.0)

    def test_stands_still_when_it_has_left_the_population(self, population: Population) -> None:
        judged(population, [1, 2], [5.0, 1.0])
        assert judged(population, [3, 4], [2.0, 3.0]).champion == 5.0

    def test_a_diverged_champion_gives_way_to_a_clean_one(self, population: Population) -> None:
        judged(population, [1, 2], [5.0, 1.0])
        report = judged(population, [1, 2], [None, 0.5])
        assert (report.champion, report.members[0].fitness) == (0.5, 0.5)

    def test_without_a_clean_one_the_lowest_that_the_population_has_had_counts(
        self, population: Population
    ) -> None:
        judged(population, [1, 2], [5.0, -1.0])
        report = judged(population, [1, 2], [None, None])
        assert [member.fitness for member in report.members] == [-1.0, -1.0]


@given(st.lists(st.floats(-1e3, 1e3), min_size=1, max_size=20))
def test_the_fittest_is_the_first_of_the_best(fitness: list[float]) -> None:
    population = Population("a", None, Scripted([]), np.random.default_rng(0))  # type: ignore[arg-type]
    judged(population, list(range(len(fitness))), list(fitness))
    assert population.fittest() == fitness.index(max(fitness))


def test_iterating_again_after_the_end_gives_nothing(toy_config: Load) -> None:
    coevolution: Coevolution = assemble(toy_config())
    assert len(list(coevolution)) == 9
    assert list(coevolution) == []
