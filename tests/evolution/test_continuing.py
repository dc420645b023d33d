"""Loops with every kind of timing, strategy, credit and role: any of them can be stopped and continued."""

from __future__ import annotations

import itertools
import json
import math
from collections.abc import Callable
from typing import Any

import pytest
import toys
from loops import continued, history, stopped
from toy_capabilities import VARIANTS

from evoframe import Coevolution, RunConfig, assemble

Variant = Callable[..., RunConfig]

WITHOUT_ROLES = [name for name in VARIANTS if "role" not in name]


def result(coevolution: Coevolution) -> Any:
    """Return everything that a loop leaves behind when it is finished."""
    assert coevolution.finished
    return coevolution.best_score, coevolution.fittest_pair(), coevolution.state()


@pytest.mark.parametrize("name", VARIANTS)
def test_a_loop_continues_bit_for_bit_after_any_turn(toy_variant: Variant, name: str) -> None:
    config = toy_variant(name)
    whole = assemble(config)
    turns = history(whole)
    for at in range(len(turns)):
        second = continued(config, stopped(config, at))
        assert history(second) == turns[at + 1 :], f"after turn {at}"
        assert result(second) == result(whole), f"after turn {at}"


@pytest.mark.parametrize("name", VARIANTS)
def test_a_loop_that_is_stopped_after_each_turn_takes_the_same_turns(toy_variant: Variant, name: str) -> None:
    config = toy_variant(name)
    whole = assemble(config)
    turns = history(whole)
    current, taken = assemble(config), []
    for _ in turns:
        taken += history([next(iter(current))])
        current = continued(config, current)
    assert taken == turns
    assert result(current) == result(whole)


@pytest.mark.parametrize("name", VARIANTS)
def test_a_restored_loop_has_the_state_that_it_was_given(toy_variant: Variant, name: str) -> None:
    config = toy_variant(name)
    for at in range(3):
        left = stopped(config, at)
        state = json.loads(json.dumps(left.state()))
        assert json.loads(json.dumps(continued(config, left).state())) == state


@pytest.mark.parametrize("name", VARIANTS)
def test_the_state_while_a_turn_is_simulated_is_that_after_the_turn_before(
    toy_variant: Variant, name: str
) -> None:
    """A turn is saved meanwhile, with the populations that do not reproduce."""
    coevolution = assemble(toy_variant(name))
    names = {population.name for population in coevolution.populations}
    expected: list[str] = []
    seen: list[str] = []
    for _ in coevolution:
        left = names - set(coevolution.reproducing_next)
        if not coevolution.finished:
            expected.append(json.dumps(coevolution.state(left), sort_keys=True))
            coevolution.on_simulating = lambda left=left: seen.append(  # type: ignore[misc]
                json.dumps(coevolution.state(left), sort_keys=True)
            )
    assert seen == expected


@pytest.mark.parametrize("name", VARIANTS)
def test_a_finished_loop_knows_the_score_of_its_fittest_pair(toy_variant: Variant, name: str) -> None:
    coevolution = assemble(toy_variant(name))
    last = list(coevolution)[-1]
    assert coevolution.fittest_pair() in last.pairs
    fittest = tuple(each.members[each.fittest()].id for each in coevolution.populations)
    assert coevolution.fittest_pair().genomes == fittest


@pytest.mark.parametrize("name", WITHOUT_ROLES)
def test_the_score_of_a_pair_is_that_of_the_genomes_that_it_names(toy_variant: Variant, name: str) -> None:
    """Also of archived individuals, and of those of the generation before."""
    coevolution = assemble(toy_variant(name))
    genomes: dict[tuple[str, int], float] = {}
    for turn in coevolution:
        for population in coevolution.populations:
            for member, genome in zip(population.members, population.genomes, strict=True):
                assert genomes.setdefault((population.name, member.id), genome) == genome
        names = [population.name for population in coevolution.populations]
        for pair in turn.pairs:
            values = [genomes[key] for key in zip(names, pair.genomes, strict=True)]
            if pair.score is not None:
                assert pair.score == pytest.approx(math.prod(values), rel=1e-12)


@pytest.mark.parametrize("name", VARIANTS)
def test_each_member_of_an_evaluated_population_has_a_meeting_with_each_other_population(
    toy_variant: Variant, name: str
) -> None:
    coevolution = assemble(toy_variant(name))
    names = [population.name for population in coevolution.populations]
    for turn in coevolution:
        assert len({pair.genomes for pair in turn.pairs}) == len(turn.pairs)
        for report in turn.reports:
            column = names.index(report.population)
            assert {member.id for member in report.members} <= {pair.genomes[column] for pair in turn.pairs}


class TestOnePopulation:
    def test_meets_nobody(self, toy_variant: Variant) -> None:
        for turn in assemble(toy_variant("one")):
            [report] = turn.reports
            assert [pair.genomes for pair in turn.pairs] == [(member.id,) for member in report.members]
            assert [pair.score for pair in turn.pairs] == [member.fitness for member in report.members]

    def test_reproduces_in_every_turn(self, toy_variant: Variant) -> None:
        turns = list(assemble(toy_variant("one")))
        assert [turn.reports[0].generation for turn in turns] == list(range(5))

    def test_needs_no_turn_for_the_final_pair(self, toy_variant: Variant) -> None:
        coevolution = assemble(toy_variant("one"))
        assert len(list(coevolution)) == coevolution.length + 1
        assert coevolution.fittest_pair().score == max(
            m.fitness or 0 for m in coevolution.populations[0].members
        )


class TestThreePopulations:
    def test_the_first_meetings_cover_all_pairs_of_individuals(self, toy_variant: Variant) -> None:
        turn = next(iter(assemble(toy_variant("three"))))
        sizes = (6, 5, 4)
        for one in range(3):
            for other in range(one):
                met = {(pair.genomes[one], pair.genomes[other]) for pair in turn.pairs}
                assert len(met) == sizes[one] * sizes[other]

    def test_take_turns_by_their_weights(self, toy_variant: Variant) -> None:
        turns = list(assemble(toy_variant("three archive")))
        assert [turn.reports[0].population for turn in turns[1:]] == ["a", "b", "c", "c"] * 4
        assert turns[-1].reports[0].generation == 8


class TestTiming:
    def test_with_parallel_timing_all_reproduce_in_each_turn(self, toy_variant: Variant) -> None:
        turns = list(assemble(toy_variant("parallel")))
        assert [[r.population for r in turn.reports] for turn in turns[:5]] == [["a", "b"]] * 5
        assert [[r.generation for r in turn.reports] for turn in turns[:5]] == [[n, n] for n in range(5)]

    def test_parallel_collaborators_are_the_fittest_of_the_generation_before(
        self, toy_variant: Variant
    ) -> None:
        turns = [turn for turn in assemble(toy_variant("parallel", "run.generations=12")) if turn.reports]
        for before, turn in itertools.pairwise(turns):
            for column, report in enumerate(turn.reports):
                other = before.reports[1 - column]
                fittest = sorted(other.members, key=lambda member: -(member.fitness or 0))[:2]
                expected = {member.id for member in fittest}
                for member in report.members:
                    met = {
                        pair.genomes[1 - column] for pair in turn.pairs if pair.genomes[column] == member.id
                    }
                    assert expected <= met
        assert len(turns) == 13

    def test_parallel_collaborators_need_not_be_members_any_more(self, toy_variant: Variant) -> None:
        config = toy_variant("parallel", "collaboration=toy-last", "run.generations=8")
        absent = 0
        for turn in assemble(config):
            for column, report in enumerate(turn.reports):
                members = {member.id for member in report.members}
                absent += sum(pair.genomes[column] not in members for pair in turn.pairs)
        assert absent > 0  # the least fit do not survive

    def test_parallel_strategies_see_the_fitness_of_the_generation_before(
        self, toy_variant: Variant, monkeypatch: pytest.MonkeyPatch
    ) -> None:

        seen: list[Any] = []
        select = toys.First.select

        def noted(self: toys.First, members: Any, rng: Any) -> Any:
            seen.append(tuple(members))
            return select(self, members, rng)

        monkeypatch.setattr(toys.First, "select", noted)
        before: list[Any] = []
        for turn in assemble(toy_variant("parallel")):
            if before and turn.reports:
                assert seen == [before[1], before[0]]
            seen.clear()
            before = [report.members for report in turn.reports]

    def test_with_asynchronous_timing_the_order_depends_on_the_seed_only(self, toy_variant: Variant) -> None:
        def order(*overrides: str) -> list[str]:
            config = toy_variant("asynchronous", "run.generations=20", *overrides)
            return [turn.reports[0].population for turn in list(assemble(config))[1:41]]

        assert order() == order()
        assert order() != order("run.seed=4")
        assert order() != ["a", "b"] * 20
        assert set(order()) == {"a", "b"}

    def test_asynchronous_populations_with_more_turns_reproduce_more_often(
        self, toy_variant: Variant
    ) -> None:
        config = toy_variant("asynchronous", "run.generations=30", "populations.b.turns=3")
        turns = list(assemble(config))[1:121]
        count = sum(turn.reports[0].population == "b" for turn in turns)
        assert 75 <= count <= 105  # 6 pairs of a turn of b for 6 of a, and three of its turns for one

    def test_weighted_populations_take_several_turns_in_succession(self, toy_variant: Variant) -> None:
        turns = list(assemble(toy_variant("weighted")))
        assert [turn.reports[0].population for turn in turns[1:]] == ["a", "a", "b"] * 3
