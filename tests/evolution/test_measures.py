"""Tests of the measures that evolvers want besides the fitness."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Any

import attrs
import numpy as np
import pytest
import toy_capabilities
import toys
from hypothesis import given, strategies as st
from numpy.typing import NDArray

from evoframe import Design, Member, Outcome, RunConfig, assemble
from evoframe.errors import ComponentError
from evoframe.evolution.measures import Measures
from evoframe.evolution.population import Population

Variant = Callable[..., RunConfig]

numbers = st.lists(st.floats(-1e3, 1e3), min_size=2, max_size=24)


def population_of(size: int) -> Population:
    rng = np.random.default_rng(0)
    population = Population("a", toys.Number(), toys.DriftRun(0.1, size, rng), rng)
    population.members = tuple(
        Member(id=i + 1, fitness=None, genome_size=2 * i, age=size - i) for i in range(size)
    )
    return population


def novelty(arrays: list[NDArray[Any]]) -> list[float]:
    found = Measures({}).of(population_of(len(arrays)), "novelty", [Design({"a": each}) for each in arrays])
    assert found is not None
    return found


class TestOfTheCore:
    def test_age_and_size_are_those_of_the_members(self) -> None:
        assert Measures({}).of(population_of(3), "age", []) == [3.0, 2.0, 1.0]
        assert Measures({}).of(population_of(3), "genome-size", []) == [0.0, 2.0, 4.0]

    def test_others_are_supplied_by_simulations(self) -> None:
        assert Measures({"populations.a.encoder": toys.Number()}).of(population_of(3), "energy", []) is None


class TestNovelty:
    def test_of_two_bodies_is_the_share_of_different_voxels(self) -> None:
        one, other = np.zeros((2, 2, 2), np.uint8), np.zeros((2, 2, 2), np.uint8)
        other[0, 0] = 3
        assert novelty([one, other]) == [0.25, 0.25]

    def test_of_numbers_is_the_mean_absolute_difference(self) -> None:
        assert novelty([np.array([0.0, 0.0]), np.array([1.0, 3.0])]) == [2.0, 2.0]

    def test_is_the_mean_distance_to_the_others(self) -> None:
        assert novelty([np.array([x]) for x in (0.0, 1.0, 4.0)]) == [2.5, 2.0, 3.5]

    def test_considers_the_nearest_fifteen(self) -> None:
        alone = [np.array([float(x)]) for x in range(20)]
        assert novelty(alone)[0] == sum(range(1, 16)) / 15
        assert novelty(alone)[19] == sum(range(1, 16)) / 15

    def test_considers_only_the_roles_of_the_population(self) -> None:
        designs = [Design({"a": np.ones(1), "b": np.array([float(x)])}) for x in range(3)]
        assert Measures({}).of(population_of(3), "novelty", designs) == [0.0, 0.0, 0.0]

    @given(numbers)
    def test_is_not_negative_and_zero_for_equals(self, values: list[float]) -> None:
        found = novelty([np.array([value]) for value in values])
        assert all(value >= 0 for value in found)
        assert novelty([np.array([values[0]])] * len(values)) == [0.0] * len(values)

    @given(numbers, st.randoms(use_true_random=False))
    def test_does_not_depend_on_the_order(self, values: list[float], random: Any) -> None:
        order = list(range(len(values)))
        random.shuffle(order)
        found = novelty([np.array([value]) for value in values])
        assert novelty([np.array([values[i]]) for i in order]) == [found[i] for i in order]

    @given(numbers, st.floats(0.1, 10.0))
    def test_scales_with_the_distances(self, values: list[float], factor: float) -> None:
        found = novelty([np.array([value]) for value in values])
        scaled = novelty([np.array([factor * value]) for value in values])
        assert scaled == pytest.approx([factor * value for value in found], rel=1e-9, abs=1e-9)


class TestOfEncoders:
    designs = tuple(Design({"a": np.array([x])}) for x in (-1.0, 2.0, -3.0))

    def of(self, encoder: Any) -> list[float] | None:
        return Measures({"populations.a.encoder": encoder}).of(population_of(3), "size-of-a", self.designs)

    def test_are_those_of_each_design(self) -> None:
        assert self.of(toy_capabilities.Typed("a")) == [1.0, 2.0, 3.0]

    @pytest.mark.parametrize(
        ("measured", "problem"),
        [
            ({"size-of-a": math.nan}, "nan for the measure 'size-of-a'"),
            ({"size-of-a": math.inf}, "inf for the measure 'size-of-a'"),
            ({"size-of-a": "big"}, "ValueError"),
            ({}, "KeyError"),
            (None, "TypeError"),
        ],
    )
    def test_that_are_invalid_are_named_with_the_individual(
        self, monkeypatch: pytest.MonkeyPatch, measured: Any, problem: str
    ) -> None:
        monkeypatch.setattr(toy_capabilities.Typed, "measure", lambda *_: measured)
        with pytest.raises(ComponentError) as caught:
            self.of(toy_capabilities.Typed("a"))
        assert problem in caught.value.problem
        assert (caught.value.component, caught.value.concerns) == ("populations.a.encoder", "a 1")


class TestRuns:
    def test_evolvers_receive_those_that_they_want(
        self, toy_variant: Variant, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        told: list[dict[str, Any]] = []
        tell = toy_capabilities.WantingRun.tell

        def noted(self: Any, fitness: Any, measures: Mapping[str, NDArray[np.float64]]) -> None:
            told.append({name: values.tolist() for name, values in measures.items()})
            tell(self, fitness, measures)

        monkeypatch.setattr(toy_capabilities.WantingRun, "tell", noted)
        turns = [turn for turn in assemble(toy_variant("measures")) if turn.reports]
        reports = [report for turn in turns for report in turn.reports]
        assert [list(each) for each in told] == [list(report.measures) for report in reports]
        for each, report in zip(told, reports, strict=True):
            assert {name: list(values) for name, values in report.measures.items()} == each

    def test_of_simulations_are_aggregated_like_scores(self, toy_variant: Variant) -> None:
        for turn in assemble(toy_variant("measures")):
            for report in turn.reports:
                if report.population != "a":
                    continue
                for member, smallness in zip(report.members, report.measures["smallness"], strict=True):
                    met = [-abs(pair.score or 0.0) for pair in turn.pairs if pair.genomes[0] == member.id]
                    assert smallness == pytest.approx(sum(met) / len(met), rel=1e-12)

    def test_of_an_encoder_of_another_population_are_those_of_the_first_meeting(
        self, toy_variant: Variant
    ) -> None:
        """The population b wants the size of a's part, of its first collaborator."""
        coevolution = assemble(toy_variant("measures"))
        for turn in coevolution:
            a = coevolution.populations[0]
            sizes = {member.id: abs(genome) for member, genome in zip(a.members, a.genomes, strict=True)}
            for report in turn.reports:
                if report.population == "b":
                    first = [
                        next(pair.genomes[0] for pair in turn.pairs if pair.genomes[1] == member.id)
                        for member in report.members
                    ]
                    assert list(report.measures["size-of-a"]) == [sizes[each] for each in first]

    def test_of_diverged_individuals_are_the_lowest_of_the_others(self, toy_variant: Variant) -> None:
        marked = 0
        for turn in assemble(toy_variant("measures with divergence", "run.generations=10")):
            for report in turn.reports:
                values = list(zip(report.members, report.measures["energy"], strict=True))
                clean = [value for member, value in values if not member.diverged]
                for member, value in values:
                    if member.diverged:
                        marked += 1
                        assert value == (min(clean) if clean else 0.0)
        assert marked > 0

    @pytest.mark.parametrize(
        ("owner", "method", "result", "key", "problem"),
        [
            ("Second", "measure", {}, "objective", "returned None for the measure 'smallness'"),
            ("Second", "measure", {"smallness": math.nan}, "objective", "returned nan"),
            ("Second", "measure", {"smallness": "low"}, "objective", "returned 'low'"),
            ("Measuring", "simulate", {}, "simulator", "returned None for the measure 'energy'"),
            ("Measuring", "simulate", {"energy": math.inf}, "simulator", "returned inf"),
        ],
    )
    def test_that_simulator_or_objective_owe_are_named(
        self,
        toy_variant: Variant,
        monkeypatch: pytest.MonkeyPatch,
        owner: str,
        method: str,
        result: dict[str, Any],
        key: str,
        problem: str,
    ) -> None:
        def outcomes(self: Any, designs: Any, record: Any) -> list[Outcome]:

            return [attrs.evolve(self._outcome(design), measures=result) for design in designs]

        replaced: Any = outcomes if method == "simulate" else lambda *_: result
        monkeypatch.setattr(getattr(toy_capabilities, owner), method, replaced)
        with pytest.raises(ComponentError) as caught:
            list(assemble(toy_variant("measures")))
        assert problem in caught.value.problem
        assert caught.value.component == key
        assert "a 1 with b 1" in caught.value.concerns
