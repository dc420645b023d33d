"""Tests of the assignment of fitness: aggregators, credits of whole turns, and goals."""

from __future__ import annotations

import math
import statistics
from collections.abc import Callable, Mapping
from typing import Any

import attrs
import numpy as np
import pytest
import toys
from hypothesis import given, strategies as st
from numpy.typing import NDArray

from evoframe import Member, RunConfig, Score, ScoredMeetings, Turn, assemble
from evoframe.errors import ComponentError
from evoframe.evolution.credit import Judge, scored_meetings
from evoframe.evolution.population import Population

Variant = Callable[..., RunConfig]
Scores = dict[tuple[int, ...], Score]


def population_of(name: str, size: int, start: int = 1) -> Population:
    rng = np.random.default_rng(0)
    population = Population(name, toys.Number(name), toys.DriftRun(0.1, size, rng), rng)
    population.members = tuple(Member(id=start + i, fitness=None) for i in range(size))
    return population


A, B = population_of("a", 3), population_of("b", 4, 11)

values = st.none() | st.floats(-1e6, 1e6)
tables = st.lists(st.lists(values, min_size=2, max_size=2), min_size=3, max_size=3)


def scores_of(table: list[list[float | None]]) -> Scores:
    """Return the scores of each member of A with the first members of B."""
    return {
        (row, column): Score(value, None if value is not None else 1)
        for row, each in enumerate(table)
        for column, value in enumerate(each)
    }


def fitness(
    judge: Judge, scores: Scores, population: Population = A, column: int = 0, *, first: bool = False
) -> list[float | None]:
    return judge.fitness(
        population, column, scores, lambda: scored_meetings(1, [A, B], scores, judge.sign), first=first
    )


class TestAggregators:
    @given(table=tables, sign=st.sampled_from([1.0, -1.0]))
    def test_receive_the_scores_of_each_member_times_the_sign(
        self, table: list[list[float | None]], sign: float
    ) -> None:
        found = fitness(Judge("aggregator", toys.Mean(), sign), scores_of(table))
        for row, value in zip(table, found, strict=True):
            if None in row:
                assert value is None
            else:
                assert value == toys.Mean().aggregate(sign * np.array(row, dtype=np.float64))

    @given(table=tables)
    def test_are_replaced_by_the_arithmetic_mean_in_the_initial_turn(
        self, table: list[list[float | None]]
    ) -> None:
        found = fitness(Judge("aggregator", Greatest()), scores_of(table), first=True)
        assert found == [None if None in row else statistics.fmean(row) for row in table]  # type: ignore[arg-type]

    @given(table=tables, sign=st.sampled_from([1.0, -1.0]))
    def test_the_floor_is_the_worst_score_of_the_turn(
        self, table: list[list[float | None]], sign: float
    ) -> None:
        known = [sign * value for row in table for value in row if value is not None]
        floor = Judge("aggregator", toys.Mean(), sign).floor(scores_of(table))
        assert floor == (min(known) if known else None)

    def test_that_fail_are_named_with_the_individual(self) -> None:
        with pytest.raises(ComponentError, match="ZeroDivisionError") as caught:
            fitness(Judge("populations.a.aggregator", Failing()), scores_of([[1.0, 2.0]] * 3))
        assert (caught.value.component, caught.value.concerns) == ("populations.a.aggregator", "a 1")

    def test_apply_to_measures_too(self) -> None:
        scores: Scores = {
            (row, column): Score(1.0, measures={"energy": float(10 * row + column)})
            for row in range(3)
            for column in range(2)
        }
        scores[2, 1] = Score(None, 4)
        judge = Judge("aggregator", Greatest())
        assert judge.measure(A, 0, scores, "energy", first=False) == [1.0, 11.0, None]
        assert judge.measure(A, 0, scores, "energy", first=True) == [0.5, 10.5, None]
        assert Judge("aggregator", toys.Share()).measure(A, 0, scores, "energy", first=False) == [
            0.5,
            10.5,
            None,
        ]


@attrs.frozen
class Greatest(toys.Mean):
    def aggregate(self, scores: NDArray[np.float64]) -> float:
        return float(scores.max())


@attrs.frozen
class Failing(toys.Mean):
    def aggregate(self, scores: NDArray[np.float64]) -> float:
        raise ZeroDivisionError


@attrs.frozen
class Given:
    """Returns a given fitness."""

    found: Any

    def check(self, n: int) -> None:
        pass

    def credit(self, meetings: ScoredMeetings, population: int) -> Any:
        return self.found


TABLE: list[list[float | None]] = [[1.0, 2.0], [3.0, None], [5.0, 6.0]]


class TestCredit:
    def test_receives_the_meetings_of_the_turn(self) -> None:
        seen: list[tuple[ScoredMeetings, int]] = []

        @attrs.frozen
        class Noting(Given):
            def credit(self, meetings: ScoredMeetings, population: int) -> Any:
                seen.append((meetings, population))
                return np.zeros(3)

        fitness(Judge("aggregator", Noting(None), -1.0), scores_of(TABLE))
        [(meetings, population)] = seen
        assert (meetings.turn, meetings.populations, meetings.present, population) == (
            1,
            ("a", "b"),
            (3, 4),
            0,
        )
        assert meetings.members == (A.members, B.members)
        assert meetings.meetings.tolist() == [[0, 0], [0, 1], [1, 0], [1, 1], [2, 0], [2, 1]]
        np.testing.assert_array_equal(meetings.scores, [-1.0, -2.0, -3.0, math.nan, -5.0, -6.0])

    def test_of_individuals_with_a_diverged_simulation_is_ignored(self) -> None:
        found = fitness(Judge("aggregator", Given([0.5, math.nan, 0.25])), scores_of(TABLE))
        assert found == [0.5, None, 0.25]

    def test_is_also_used_in_the_initial_turn(self) -> None:
        assert fitness(Judge("aggregator", Given([3.0, 2.0, 1.0])), scores_of(TABLE), first=True) == [
            3.0,
            None,
            1.0,
        ]

    @pytest.mark.parametrize(
        ("found", "shape"), [([1.0, 2.0], "(2,)"), (1.0, "()"), ([[1.0, 2.0, 3.0]], "(1, 3)")]
    )
    def test_of_another_shape_is_refused(self, found: Any, shape: str) -> None:
        with pytest.raises(ComponentError) as caught:
            fitness(Judge("populations.a.aggregator", Given(found)), scores_of(TABLE))
        assert f"shape {shape}, expected (3,)" in caught.value.problem
        assert (caught.value.component, caught.value.concerns) == ("populations.a.aggregator", "population a")

    @pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf])
    def test_that_is_not_finite_is_refused_with_the_individual(self, value: float) -> None:
        with pytest.raises(ComponentError, match=r"scores \[5\.0, 6\.0\]") as caught:
            fitness(Judge("aggregator", Given([1.0, 2.0, value])), scores_of(TABLE))
        assert repr(value) in caught.value.problem
        assert (caught.value.component, caught.value.concerns) == ("aggregator", "a 3")

    @pytest.mark.parametrize("found", ["many", [1.0, [2.0], 3.0], None])
    def test_that_is_not_an_array_of_numbers_is_refused(self, found: Any) -> None:
        with pytest.raises(ComponentError) as caught:
            fitness(Judge("aggregator", Given(found)), scores_of(TABLE))
        assert (caught.value.component, caught.value.concerns) == ("aggregator", "population a")


class TestScoredMeetings:
    @given(
        st.lists(st.tuples(st.integers(0, 2), st.integers(0, 3)), unique=True, max_size=12),
        st.sampled_from([0, 1]),
    )
    def test_list_the_meetings_of_each_member(self, met: list[tuple[int, ...]], population: int) -> None:
        seen = scored_meetings(0, [A, B], {meeting: Score(1.0) for meeting in met}, 1.0)
        rows = seen.of(population)
        assert len(rows) == (3, 4)[population]
        for member, indices in enumerate(rows):
            assert indices.tolist() == [i for i, each in enumerate(met) if each[population] == member]


def shares(turn: Turn, column: int, sign: float) -> dict[int, float]:
    """Return the share of each individual of all scores of a turn, as :class:`toys.Share` computes it."""
    scores = np.array([sign * (pair.score or 0.0) for pair in turn.pairs])
    ids = np.array([pair.genomes[column] for pair in turn.pairs])
    return {int(key): float(scores[ids == key].sum() / scores.sum()) for key in np.unique(ids)}


class TestRuns:
    @pytest.mark.parametrize("goal", ["maximize", "minimize"])
    def test_fitness_equals_the_credit_of_the_pairs_of_the_turn(
        self, toy_variant: Variant, goal: str
    ) -> None:
        config = toy_variant("sequential", "aggregator=toy-share", f"populations.a.goal={goal}")
        for turn in assemble(config):
            for report in turn.reports:
                column = "ab".index(report.population)
                sign = -1.0 if (goal, column) == ("minimize", 0) else 1.0
                expected = shares(turn, column, sign)
                for member in report.members:
                    assert member.fitness == pytest.approx(expected[member.id], rel=1e-9, abs=1e-12)

    def test_diverged_individuals_get_the_lowest_credit(self, toy_variant: Variant) -> None:
        marked = 0
        for turn in assemble(
            toy_variant("sequential", "aggregator=toy-share", "simulator.limit=0.15", "run.generations=10")
        ):
            for report in turn.reports:
                clean = [member.fitness for member in report.members if not member.diverged]
                for member in report.members:
                    if member.diverged and clean:
                        marked += 1
                        assert member.fitness == min(clean)  # type: ignore[type-var]
        assert marked > 0

    @pytest.mark.parametrize("name", ["parallel", "sequential"])
    def test_no_credit_sees_fitness_of_the_same_turn(
        self, toy_variant: Variant, monkeypatch: pytest.MonkeyPatch, name: str
    ) -> None:
        """Credits do not depend on the order of the populations, which are all judged by one turn."""
        seen: list[tuple[int, list[float | None]]] = []
        credit = toys.Share.credit

        def noted(self: toys.Share, meetings: ScoredMeetings, population: int) -> Any:
            there = meetings.members[population][: meetings.present[population]]
            other = meetings.members[1 - population][: meetings.present[1 - population]]
            seen.append(
                (meetings.turn, [m.fitness for m in (*there, *(other if name == "parallel" else ()))])
            )
            return credit(self, meetings, population)

        monkeypatch.setattr(toys.Share, "credit", noted)
        list(assemble(toy_variant(name, "aggregator=toy-share")))
        assert len(seen) > 8
        assert all(set(fitness) == {None} for _, fitness in seen)  # toy-drift forgets it when it reproduces

    @pytest.mark.parametrize(
        "settings",
        [
            [],
            ["run.timing=parallel"],
            ["collaboration=toy-archiving", "run.timing=asynchronous"],
            ["aggregator=toy-share"],
        ],
    )
    def test_minimizing_negative_scores_equals_maximizing(
        self, toy_variant: Variant, settings: list[str]
    ) -> None:
        loading = [f"populations.{role}.evolver={{name='toy-wanting', wants=['age']}}" for role in "ab"]
        plain = list(assemble(toy_variant("sequential", *loading, *settings)))
        negated = toy_variant("sequential", *loading, *settings, "objective=toy-negated")
        minimizing = {  # which a configuration cannot, because of the champion
            role: attrs.evolve(population, goal="minimize")
            for role, population in negated.populations.items()
        }
        mirrored = list(assemble(attrs.evolve(negated, populations=minimizing)))
        assert len(plain) == len(mirrored)
        for one, other in zip(plain, mirrored, strict=True):
            assert one.reports == other.reports
            assert one.pairs == tuple(
                attrs.evolve(pair, score=-pair.score if pair.score else pair.score) for pair in other.pairs
            )

    def test_with_opposite_goals_populations_compete(self, toy_variant: Variant) -> None:
        """Each evolves towards the other end: the fitness of one is minus that of the other."""
        turn = next(iter(assemble(toy_variant("sequential", "populations.b.goal=minimize"))))
        mean = {
            report.population: statistics.fmean(member.fitness or 0.0 for member in report.members)
            for report in turn.reports
        }
        assert mean["a"] == pytest.approx(-mean["b"], rel=1e-12)
        assert mean["a"] != 0


def test_scores_of_nobody_are_an_empty_turn() -> None:
    empty: Mapping[tuple[int, ...], Score] = {}
    seen = scored_meetings(3, [A, B], empty, 1.0)
    assert (seen.meetings.shape, seen.scores.shape, seen.turn) == ((0, 2), (0,), 3)
