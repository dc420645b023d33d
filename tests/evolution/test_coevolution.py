"""Tests of the loop of coevolution, with toy components."""

from __future__ import annotations

import itertools
import math
import statistics
from collections.abc import Callable
from typing import Any, TypeVar

import numpy as np
import pytest
import toys
from loops import continued, history, stopped

from evoframe import Design, PopulationReport, Record, RunConfig, RunError, Turn, assemble
from evoframe.errors import ComponentError

Load = Callable[..., RunConfig]
T = TypeVar("T")


def known(value: T | None) -> T:
    assert value is not None
    return value


def assert_fitness_is_the_mean(turn: Turn, report: PopulationReport, column: int, rel: float) -> None:
    for member in report.members:
        scores = [known(pair.score) for pair in turn.pairs if pair.genomes[column] == member.id]
        assert member.fitness == pytest.approx(statistics.fmean(scores), rel=rel)


def test_the_initial_turn_pairs_all_and_averages_arithmetically(toy_config: Load) -> None:
    turn = next(iter(assemble(toy_config())))
    assert turn.index == 0
    assert len(turn.pairs) == 6 * 5
    for position, report in enumerate(turn.reports):
        for member in report.members:
            assert sum(pair.genomes[position] == member.id for pair in turn.pairs) == (5, 6)[position]
        assert_fitness_is_the_mean(turn, report, position, rel=1e-14)


def test_designs_with_the_same_first_member_are_simulated_in_sequence(toy_config: Load) -> None:
    asked: list[float] = []

    class Noting(toys.Product):
        def key(self, design: Design, record: Record) -> bytes:
            asked.append(float(design.roles["a"][0]))
            return super().key(design, record)

    coevolution = assemble(toy_config())
    coevolution.evaluator.simulator = Noting()
    for _ in coevolution:
        groups = [a for a, _ in itertools.groupby(asked)]
        assert len(groups) == len(set(groups))
        asked.clear()


def test_pairs_that_met_since_the_same_turn_of_the_round_before_are_not_decoded_again(
    toy_config: Load, monkeypatch: pytest.MonkeyPatch
) -> None:
    decoded: list[float] = []
    decode = toys.Number.decode

    def counted(self: toys.Number, network: Any, design: Design) -> Design:
        decoded.extend([1.0] * (self.role == "b"))
        return decode(self, network, design)

    monkeypatch.setattr(toys.Number, "decode", counted)
    met: list[set[tuple[int, ...]]] = []
    spared = 0
    for turn in assemble(toy_config()):
        pairs = {pair.genomes for pair in turn.pairs}
        new = pairs.difference(*met[-2:])
        assert len(decoded) - (turn.best_pair is not None) == len(new)
        spared += len(pairs.difference(*met[-1:])) - len(new)
        met.append(pairs)
        decoded.clear()
    assert spared > 0


def test_populations_take_turns_in_order(toy_config: Load) -> None:
    turns = list(assemble(toy_config()))
    assert [turn.index for turn in turns] == list(range(9))
    assert [turn.reports[0].population for turn in turns[1:]] == ["a", "b"] * 4
    assert [turn.reports[0].generation for turn in turns[1:]] == [1, 1, 2, 2, 3, 3, 4, 4]


def test_all_members_are_paired_with_the_fittest_of_the_other_population(toy_config: Load) -> None:
    turns = list(assemble(toy_config()))
    others = {report.population: report for report in turns[0].reports}
    for turn in turns[1:]:
        [report] = turn.reports
        other = others["b" if report.population == "a" else "a"]
        fittest = sorted(other.members, key=lambda member: -known(member.fitness))[:2]
        column = "ab".index(report.population)
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


def test_fitness_aggregates_the_scores_of_a_members_pairs(toy_config: Load) -> None:
    for turn in list(assemble(toy_config()))[1:]:
        [report] = turn.reports
        assert_fitness_is_the_mean(turn, report, "ab".index(report.population), rel=1e-14)


def test_the_best_pair_is_the_earliest_with_the_best_score(toy_config: Load) -> None:
    best, found = -math.inf, None
    for turn in assemble(toy_config()):
        top = max(known(pair.score) for pair in turn.pairs)
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


def test_the_history_depends_on_the_seed(toy_config: Load) -> None:
    once, again = history(assemble(toy_config())), history(assemble(toy_config()))
    assert once == again
    assert history(assemble(toy_config("run.seed=4"))) != once


def test_two_loops_interleaved_equal_each_alone(toy_config: Load) -> None:
    first, second = assemble(toy_config()), assemble(toy_config("run.seed=9"))
    turns = [list(pair) for pair in zip(first, second, strict=True)]
    assert history([a for a, _ in turns]) == history(assemble(toy_config()))
    assert history([b for _, b in turns]) == history(assemble(toy_config("run.seed=9")))


def test_the_next_population_breeds_while_a_turn_is_simulated(
    toy_config: Load, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked: list[toys.DriftRun] = []
    ask = toys.DriftRun.ask

    def noted(self: toys.DriftRun) -> Any:
        asked.append(self)
        return ask(self)

    monkeypatch.setattr(toys.DriftRun, "ask", noted)
    coevolution = assemble(toy_config())
    a, b = (population.evolver for population in coevolution.populations)
    after_each_turn = []
    for _ in coevolution:
        after_each_turn.append(list(asked))
        asked.clear()
    assert after_each_turn == [[a, b], [a, b], [a], [b], [a], [b], [a], [b], []]


def test_the_state_is_that_before_breeding(toy_config: Load) -> None:
    states: list[Any] = []
    for coevolution in (bred := assemble(toy_config()), assemble(toy_config("run.generations=1"))):
        turns = iter(coevolution)
        for _ in range(3):
            next(turns)
        states.append(coevolution.state())
    assert bred.populations[0].evolver.state() != states[0]["population/a"]["evolver"]
    assert states[0] == states[1]  # with one generation, no population breeds in the last turn


def test_the_state_while_simulating_is_that_of_the_turn_before(toy_config: Load) -> None:
    coevolution = assemble(toy_config())
    seen: list[Any] = []
    expected: list[Any] = []
    for turn in coevolution:
        if turn.index < coevolution.length:
            unchanged = "ab"[(turn.index + 1) % 2]  # the next turn is that of the other population
            expected.append(coevolution.state([unchanged]))
            coevolution.on_simulating = lambda name=unchanged: seen.append(coevolution.state([name]))  # type: ignore[misc]
    assert seen == expected


@pytest.mark.parametrize("at", range(9))
def test_a_restored_loop_continues_bit_for_bit(toy_config: Load, at: int) -> None:
    whole = history(assemble(toy_config()))
    second = continued(toy_config(), stopped(toy_config(), at))
    assert history(second) == whole[at + 1 :]
    assert second.best_score == max(pair[2][i].score for pair in whole for i in range(len(pair[2])))


class TestMoreThanTwoPopulations:
    @pytest.fixture
    def turns(self, toy_config: Load) -> list[Turn]:
        third = ('populations.c.encoder={name="toy-number", role="c"}', "populations.c.evolver=toy-drift")
        return list(assemble(toy_config(*third, "populations.c.size=4")))

    def test_take_turns_in_order(self, turns: list[Turn]) -> None:
        assert [turn.reports[0].population for turn in turns[1:13]] == ["a", "b", "c"] * 4

    def test_are_combined_position_by_position(self, turns: list[Turn]) -> None:
        for turn in turns[1:13]:
            column = "abc".index(turn.reports[0].population)
            teams = {pair.genomes[:column] + pair.genomes[column + 1 :] for pair in turn.pairs}
            assert len(teams) == 2  # not 2 x 2: the i-th collaborator of one with the i-th of the other

    def test_the_initial_turn_pairs_all_members_of_all_populations(self, turns: list[Turn]) -> None:
        sizes = (6, 5, 4)
        for one, size in enumerate(sizes):
            for other, partners in enumerate(sizes):
                met = {(pair.genomes[one], pair.genomes[other]) for pair in turns[0].pairs}
                assert one == other or len(met) == size * partners

    def test_fitness_follows_from_the_scores_of_all_pairs_of_a_turn(self, turns: list[Turn]) -> None:
        for turn in turns:
            for report in turn.reports:
                assert_fitness_is_the_mean(turn, report, "abc".index(report.population), rel=1e-12)


class TestFinalTurn:
    def test_pairs_the_fittest_that_were_not_paired(self, toy_config: Load) -> None:
        coevolution = assemble(toy_config("collaboration={name='toy-last'}"))
        turns = list(coevolution)
        final = turns[-1]
        assert (final.index, final.reports) == (9, ())
        fittest = tuple(p.members[p.fittest()].id for p in coevolution.populations)
        assert [pair.genomes for pair in final.pairs] == [fittest]
        assert coevolution.finished
        assert coevolution.fittest_pair() == final.pairs[0]

    def test_can_find_the_best_pair(self, toy_config: Load) -> None:
        better = 0
        for seed in range(20):
            coevolution = assemble(toy_config("collaboration={name='toy-last'}", f"run.seed={seed}"))
            turns = list(coevolution)
            assert coevolution.best_score == max(known(pair.score) for turn in turns for pair in turn.pairs)
            better += turns[-1].best_pair is not None
        assert better > 0

    def test_is_omitted_if_the_fittest_were_paired(self, toy_config: Load) -> None:
        coevolution = assemble(toy_config())
        assert len(list(coevolution)) == coevolution.length + 1
        assert coevolution.finished

    def test_takes_place_once_after_a_restart(self, toy_config: Load) -> None:
        config = toy_config("collaboration={name='toy-last'}")
        whole = history(assemble(config))
        second = continued(config, stopped(config, assemble(config).length))
        assert not second.finished
        assert history(second) == whole[-1:]
        assert history(continued(config, second)) == []


class TestRandomStreams:
    def genomes(self, config: RunConfig) -> dict[str, Any]:
        coevolution = assemble(config)
        next(iter(coevolution))
        return {population.name: list(population.genomes) for population in coevolution.populations}

    def test_each_population_has_its_own(self, toy_config: Load) -> None:
        genomes = self.genomes(toy_config("populations.a.size=5"))
        assert genomes["a"] != genomes["b"]

    def test_an_additional_population_does_not_change_the_streams_of_others(self, toy_config: Load) -> None:
        two = self.genomes(toy_config())
        third = ('populations.c.encoder={name="toy-number", role="c"}', "populations.c.evolver=toy-drift")
        three = self.genomes(toy_config(*third))
        assert {name: three[name] for name in two} == two
        assert three["c"][:5] not in (two["a"][:5], two["b"])

    def test_collaborators_are_drawn_with_the_stream_of_the_evaluated_population(
        self, toy_config: Load
    ) -> None:
        coevolution = assemble(toy_config("collaboration={name='toy-drawn'}"))
        turns = iter(coevolution)
        next(turns)
        states = [population.rng.bit_generator.state for population in coevolution.populations]
        assert states[0] != states[1]
        next(turns)
        assert coevolution.populations[0].rng.bit_generator.state != states[0]
        assert coevolution.populations[1].rng.bit_generator.state == states[1]


class TestBadComponents:
    """Errors name the component that returned an invalid result."""

    @pytest.mark.parametrize("chosen", [[0, 0], [0, 99], [-1, 0], [0.0, 1.0], [0, 1, 2], 0])
    def test_a_strategy_with_an_invalid_choice_is_named(
        self, toy_config: Load, monkeypatch: pytest.MonkeyPatch, chosen: list[Any]
    ) -> None:
        monkeypatch.setattr(toys.First, "select", lambda self, members, rng: chosen)
        with pytest.raises(ComponentError, match="2 of the 5 members of 'b'") as caught:
            list(assemble(toy_config()))
        assert caught.value.component == "collaboration"
        assert str(chosen) in caught.value.problem

    @pytest.mark.parametrize("fitness", ["abc", None, float("nan"), float("inf")])
    def test_an_aggregator_that_does_not_return_a_number_is_named(
        self, toy_config: Load, monkeypatch: pytest.MonkeyPatch, fitness: Any
    ) -> None:
        monkeypatch.setattr(toys.Mean, "aggregate", lambda self, scores: fitness)
        with pytest.raises(ComponentError, match=f"fitness {fitness!r}") as caught:
            list(assemble(toy_config()))
        assert caught.value.component == "aggregator"

    def test_a_simulator_that_loses_an_outcome_is_named(
        self, toy_config: Load, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        monkeypatch.setattr(toys.Product, "simulate", lambda self, designs, record: [])
        with pytest.raises(ComponentError, match="0 outcomes") as caught:
            list(assemble(toy_config()))
        assert caught.value.component == "simulator"


class TestDivergence:
    def test_a_diverged_individual_is_marked_and_gets_the_lowest_clean_fitness(
        self, toy_config: Load
    ) -> None:
        marked = 0
        for turn in assemble(toy_config("simulator.limit=0.15", "run.generations=20")):
            for report in turn.reports:
                column = "ab".index(report.population)
                clean = [known(member.fitness) for member in report.members if not member.diverged]
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

    def test_a_diverged_individual_is_not_chosen_if_a_clean_one_exists(self, toy_config: Load) -> None:
        coevolution = assemble(toy_config("simulator.limit=0.15", "run.generations=20"))
        others: dict[str, Any] = {}
        chosen = 0
        for turn in coevolution:
            if turn.index > 0 and turn.reports:
                [report] = turn.reports
                column = "ab".index(report.population)
                clean = [m.id for m in others["ba"[column]].members if not m.diverged]
                met = {pair.genomes[1 - column] for pair in turn.pairs}
                assert met <= set(clean) or len(clean) < 2
                chosen += 1
            others |= {report.population: report for report in turn.reports}
            for population in coevolution.populations:
                if any(not member.diverged for member in population.members):
                    assert not population.members[population.fittest()].diverged
        assert chosen == 40

    def test_a_run_stops_if_all_simulations_of_the_initial_turn_diverge(self, toy_config: Load) -> None:
        with pytest.raises(RunError, match="diverged"):
            next(iter(assemble(toy_config("simulator.limit=0"))))


def test_iterating_after_the_end_yields_nothing(toy_config: Load) -> None:
    coevolution = assemble(toy_config())
    assert len(list(coevolution)) == 9
    assert list(coevolution) == []
