"""Tests of the choice of collaborators: with a memory, for each individual, and invalid ones."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import pytest
import toy_capabilities
import toys

from evoframe import Archived, Coevolution, Judged, Member, RunConfig, StructureError, assemble
from evoframe.errors import ComponentError
from evoframe.evolution.collaboration import Collaboration

Variant = Callable[..., RunConfig]


def first_turn(config: RunConfig) -> Coevolution:
    """Return a loop after its initial turn."""
    coevolution = assemble(config)
    next(iter(coevolution))
    return coevolution


def teams_of(coevolution: Coevolution, index: int) -> list[Sequence[tuple[int, ...]]]:
    """Return the teams of the individuals of a population, as at the start of its turn."""
    return coevolution.collaborations[index].teams()


class TestTeams:
    def test_of_a_population_alone_are_empty(self, toy_variant: Variant) -> None:
        assert teams_of(first_turn(toy_variant("one")), 0) == [[()]] * 6

    def test_of_two_populations_have_one_collaborator_each(self, toy_variant: Variant) -> None:
        coevolution = first_turn(toy_variant("sequential"))
        b = coevolution.populations[1].members
        fittest = sorted(range(5), key=lambda i: -(b[i].fitness or 0.0))[:2]
        assert teams_of(coevolution, 0) == [[(fittest[0],), (fittest[1],)]] * 6

    def test_of_three_populations_combine_the_choices_by_position(self, toy_variant: Variant) -> None:
        coevolution = first_turn(toy_variant("three"))
        a, _, c = (
            sorted(range(len(p.members)), key=lambda i, m=p.members: -(m[i].fitness or 0.0))[:2]  # type: ignore[misc]
            for p in coevolution.populations
        )
        assert teams_of(coevolution, 1) == [[(a[0], c[0]), (a[1], c[1])]] * 5

    def test_draw_from_the_stream_of_the_own_population(self, toy_variant: Variant) -> None:
        coevolution = first_turn(toy_variant("random choice"))
        states = [population.rng.bit_generator.state for population in coevolution.populations]
        teams_of(coevolution, 1)
        assert coevolution.populations[0].rng.bit_generator.state == states[0]
        assert coevolution.populations[1].rng.bit_generator.state != states[1]

    def test_can_differ_between_individuals(self, toy_variant: Variant) -> None:
        teams = teams_of(first_turn(toy_variant("each")), 0)
        assert len(set(map(tuple, teams))) > 1
        assert all(len(set(team)) == 2 for team in teams)


class TestArchivedIndividuals:
    def test_that_left_the_population_take_part_in_later_turns(self, toy_variant: Variant) -> None:
        coevolution = assemble(toy_variant("archive", "run.generations=20", "populations.a.evolver.step=1.0"))
        absent = 0
        for turn in coevolution:
            for column, population in enumerate(coevolution.populations):
                members = {member.id for member in population.members}
                absent += sum(pair.genomes[column] not in members for pair in turn.pairs)
        assert absent > 0

    def test_are_admitted_once_after_the_members(self, toy_variant: Variant) -> None:
        coevolution = first_turn(toy_variant("archive"))
        b = coevolution.populations[1]
        stranger = Archived(Member(id=99, fitness=1.0), 0.25)
        assert b.admit(stranger) == b.admit(stranger) == len(b.members)
        assert [member.id for member in b.present[len(b.members) :]] == [99]
        assert b.dump(len(b.members)) == 0.25
        assert b.called(len(b.members)) == "b 99"
        b.begin_turn()
        assert b.present == b.members

    def test_that_are_members_keep_their_position(self, toy_variant: Variant) -> None:
        b = first_turn(toy_variant("archive")).populations[1]
        assert b.admit(Archived(b.members[3], 123.0)) == 3
        assert b.present == b.members

    def test_are_dismissed_before_the_final_pair(
        self, toy_variant: Variant, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        """A resumed run has no such guests, and strategies see who is present."""
        seen: list[tuple[int, ...]] = []
        observe = toy_capabilities.ArchivingRun.observe

        def noted(self: Any, meetings: Any, genome: Any) -> None:
            seen.append(tuple(map(len, meetings.members)))
            observe(self, meetings, genome)

        monkeypatch.setattr(toy_capabilities.ArchivingRun, "observe", noted)
        coevolution = assemble(toy_variant("archive and final pair"))
        for turn in coevolution:
            if turn.index == coevolution.length:
                coevolution.populations[0].admit(Archived(Member(id=99, fitness=1.0), 0.25))
        assert not turn.reports
        assert seen[-1] == (6, 5)

    def test_need_an_evolver_that_loads_genomes(self, toy_variant: Variant) -> None:
        drift = ["populations.a.evolver=toy-drift", "populations.b.evolver=toy-drift"]
        config = toy_variant("archive", "run.generations=20", *drift)
        with pytest.raises(ComponentError, match="'load'") as caught:
            list(assemble(config))
        assert caught.value.component == "populations.b.evolver"

    def test_that_the_evolver_cannot_load_are_named(
        self, toy_variant: Variant, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        def failing(self: object, dumped: object) -> float:
            raise ValueError(f"not a genome: {dumped}")

        monkeypatch.setattr(toy_capabilities.WantingRun, "load", failing)
        b = first_turn(toy_variant("archive")).populations[1]
        with pytest.raises(ComponentError, match=r"not a genome: 0\.5") as caught:
            b.admit(Archived(Member(id=77, fitness=None), 0.5))
        assert (caught.value.component, caught.value.concerns) == ("populations.b.evolver", "b 77")


class TestCollaboratorsOfTheLastEvaluation:
    """What a strategy that chooses for each individual learns about it."""

    @pytest.mark.parametrize("name", ["each", "parallel each", "own strategies", "three parallel"])
    def test_are_those_that_were_chosen_for_it(
        self, toy_variant: Variant, monkeypatch: pytest.MonkeyPatch, name: str
    ) -> None:
        chosen: dict[tuple[int, int, int], tuple[int, ...]] = {}
        checked: list[bool] = []
        select = toy_capabilities.Loyal.select_each
        populations: dict[int, int] = {}

        def noted(self: Any, judged: Sequence[Judged], members: Sequence[Member], rng: Any) -> Any:
            rows = select(self, judged, members, rng)
            who = populations[id(rng)], len(members)  # the own population, and the other one by its size
            for each, row in zip(judged, rows.tolist(), strict=True):
                key = (*who, each.member.id)
                if key in chosen:
                    assert set(each.collaborators) == set(chosen[key])
                    checked.append(True)
                elif each.collaborators:
                    assert len(each.collaborators) == len(members)  # all, in the initial turn
                chosen[key] = tuple(members[i].id for i in row)
            return rows

        monkeypatch.setattr(toy_capabilities.Loyal, "select_each", noted)
        coevolution = assemble(toy_variant(name, "run.generations=12"))
        populations.update({id(p.rng): i for i, p in enumerate(coevolution.populations)})
        list(coevolution)
        assert len(checked) > 20

    def test_are_unknown_for_new_individuals(
        self, toy_variant: Variant, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        seen: list[Judged] = []
        select = toy_capabilities.Loyal.select_each

        def noted(self: Any, judged: Sequence[Judged], *rest: Any) -> Any:
            seen.extend(judged)
            return select(self, judged, *rest)

        monkeypatch.setattr(toy_capabilities.Loyal, "select_each", noted)
        turns = iter(assemble(toy_variant("each")))
        initial = {member.id for member in next(turns).reports[0].members}
        next(turns)
        assert {each.member.id for each in seen if each.collaborators} == {
            each.member.id for each in seen
        } & initial
        assert any(not each.collaborators for each in seen)


class TestObservation:
    @pytest.mark.parametrize("name", ["archive", "three archive", "parallel archive", "asynchronous archive"])
    def test_shows_each_turn_once_with_the_fitness_after_it(
        self, toy_variant: Variant, monkeypatch: pytest.MonkeyPatch, name: str
    ) -> None:
        seen: list[tuple[str, str, int]] = []
        coevolution = assemble(toy_variant(name))
        observe = toy_capabilities.ArchivingRun.observe

        def noted(self: Any, meetings: Any, genome: Any) -> None:
            seen.append((self.population, self.other, meetings.turn))
            for population, members in zip(coevolution.populations, meetings.members, strict=True):
                assert members[: len(population.members)] == population.members
                assert population.members[0].fitness is not None
            column = meetings.populations.index(self.other)
            assert [genome(i) for i in range(2)] == list(coevolution.populations[column].genomes[:2])
            observe(self, meetings, genome)

        monkeypatch.setattr(toy_capabilities.ArchivingRun, "observe", noted)
        turns = list(coevolution)
        names = [population.name for population in coevolution.populations]
        expected = [
            (own, other, turn.index) for turn in turns for own in names for other in names if own != other
        ]
        assert seen == expected

    def test_shows_scores_with_the_sign_of_the_own_goal(
        self, toy_variant: Variant, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        scores: dict[str, Any] = {}

        def noted(self: Any, meetings: Any, genome: Any) -> None:
            del genome
            scores[self.population] = meetings.scores

        monkeypatch.setattr(toy_capabilities.ArchivingRun, "observe", noted)
        turn = next(iter(assemble(toy_variant("archive", "populations.b.goal=minimize"))))
        assert scores["a"].tolist() == [pair.score for pair in turn.pairs]
        assert scores["b"].tolist() == [-(pair.score or 0.0) for pair in turn.pairs]


MEMBER = Member(id=50, fitness=1.0)

INVALID: list[tuple[Any, str]] = [
    ([[0, 1]] * 5, "5 individuals, expected 6"),
    ([], "0 individuals, expected 6"),
    ([[0, 0]] * 6, "chose [0, 0], expected 2 of the 5 members of 'b'"),
    ([[0, 5]] * 6, "chose [0, 5]"),
    ([[-1, 0]] * 6, "chose [-1, 0]"),
    ([[0]] * 6, "chose [0], expected 2"),
    ([[0, 1, 2]] * 6, "chose [0, 1, 2], expected 2"),
    ([[True, 0]] * 6, "chose [True, 0]"),
    ([[0, 1.0]] * 6, "chose [0, 1.0]"),
    ([0] * 6, "chose 0, expected 2"),
    ([[Archived(MEMBER, 0.5)] * 2] * 6, "chose [Archived"),
    (5, "TypeError"),
]


@pytest.mark.parametrize(("chosen", "problem"), INVALID)
def test_an_invalid_choice_of_a_strategy_with_a_memory_is_refused(
    toy_variant: Variant, monkeypatch: pytest.MonkeyPatch, chosen: Any, problem: str
) -> None:
    coevolution = first_turn(toy_variant("archive", "populations.a.collaboration=toy-archiving"))
    monkeypatch.setattr(toy_capabilities.ArchivingRun, "choose", lambda *_: chosen)
    with pytest.raises(ComponentError) as caught:
        teams_of(coevolution, 0)
    assert problem in caught.value.problem
    assert caught.value.component == "populations.a.collaboration"


@pytest.mark.parametrize(
    ("chosen", "problem"),
    [([[0, 0]] * 6, "chose [0, 0]"), ([[0, 1], [0]] * 3, "ValueError"), ([0, 1] * 3, "chose 0")],
)
def test_an_invalid_choice_for_each_individual_is_refused(
    toy_variant: Variant, monkeypatch: pytest.MonkeyPatch, chosen: Any, problem: str
) -> None:
    coevolution = first_turn(toy_variant("each"))
    monkeypatch.setattr(toy_capabilities.Loyal, "select_each", lambda *_: chosen)
    with pytest.raises(ComponentError) as caught:
        teams_of(coevolution, 0)
    assert problem in caught.value.problem
    assert caught.value.component == "collaboration"


def test_an_archived_individual_and_the_member_that_it_was_are_the_same(
    toy_variant: Variant, monkeypatch: pytest.MonkeyPatch
) -> None:
    coevolution = first_turn(toy_variant("archive"))
    member = coevolution.populations[1].members[0]
    monkeypatch.setattr(toy_capabilities.ArchivingRun, "choose", lambda *_: [[0, Archived(member, 0.5)]] * 6)
    with pytest.raises(ComponentError, match="expected 2 of the 5 members"):
        teams_of(coevolution, 0)


def test_different_numbers_from_other_populations_are_refused(
    toy_variant: Variant, monkeypatch: pytest.MonkeyPatch
) -> None:
    coevolution = first_turn(toy_variant("three", "collaboration=toy-alternating"))

    def by_size(_: object, judged: Sequence[Judged], members: Sequence[Member], rng: object) -> Any:
        return [[0] if len(members) == 5 else [0, 1]] * len(judged)

    monkeypatch.setattr(toy_capabilities.AlternatingRun, "choose", by_size)
    with pytest.raises(ComponentError, match="different numbers from other populations: 1, 2") as caught:
        teams_of(coevolution, 0)
    assert caught.value.component == "collaboration"


@pytest.mark.parametrize("method", ["start", "choose", "observe", "state", "restore"])
def test_an_error_of_a_strategy_with_a_memory_names_its_key(
    toy_variant: Variant, monkeypatch: pytest.MonkeyPatch, method: str
) -> None:
    def failing(*_: object) -> Any:
        raise ZeroDivisionError("a bug")

    config = toy_variant("own strategies")
    saved = first_turn(config).state()
    owner: Any = toy_capabilities.Archiving if method == "start" else toy_capabilities.ArchivingRun
    monkeypatch.setattr(owner, method, failing)

    def act() -> None:
        coevolution = assemble(config)
        if method == "restore":
            coevolution.restore(saved)
        list(coevolution)

    with pytest.raises(ComponentError, match="ZeroDivisionError: a bug") as caught:
        act()
    assert caught.value.component == "populations.b.collaboration"


def test_a_memory_that_is_not_json_is_attributed_to_its_strategy(
    toy_variant: Variant, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(toy_capabilities.ArchivingRun, "state", lambda _: {1, 2})
    with pytest.raises(ComponentError, match="set") as caught:
        list(assemble(toy_variant("own strategies")))
    assert (caught.value.component, caught.value.concerns) == (
        "populations.b.collaboration",
        "population b",
    )


class TestState:
    def test_is_missing_without_a_memory(self, toy_variant: Variant) -> None:
        for collaboration in first_turn(toy_variant("sequential")).collaborations:
            assert not collaboration.observes
            assert collaboration.state() is None

    def test_contains_whom_individuals_met(self, toy_variant: Variant) -> None:
        coevolution = first_turn(toy_variant("each"))
        a, b = coevolution.populations
        state: Any = coevolution.collaborations[0].state()
        assert state["runs"] == {"b": None}
        assert state["met"] == {"b": [[m.id, [other.id for other in b.members]] for m in a.members]}

    def test_that_is_invalid_is_refused_with_its_key(self, toy_variant: Variant) -> None:
        collaboration: Collaboration = first_turn(toy_variant("each")).collaborations[1]
        with pytest.raises(StructureError) as caught:
            collaboration.restore({"runs": 5, "met": {}})
        assert [fault.path for fault in caught.value.faults] == [("collaboration", "b", "runs")]

    def test_of_a_strategy_without_a_memory_must_be_empty(self, toy_variant: Variant) -> None:
        collaboration = first_turn(toy_variant("each")).collaborations[1]
        with pytest.raises(ComponentError, match="expected no state, found 5"):
            collaboration.restore({"runs": {"a": 5}, "met": {}})


def test_a_choice_among_arrays_of_numpy_is_that_of_their_numbers(
    toy_variant: Variant, monkeypatch: pytest.MonkeyPatch
) -> None:
    coevolution = first_turn(toy_variant("sequential"))
    monkeypatch.setattr(toys.First, "select", lambda *_: np.array([3, 1], dtype=np.intp))
    assert teams_of(coevolution, 0) == [[(3,), (1,)]] * 6
