"""Tests of the assembly of a loop: its components and their random streams."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
import toys

from evoframe import Coevolution, Evaluator, RunConfig, assemble
from evoframe.evolution.assembly import evaluator_of
from evoframe.evolution.randomness import stream

Load = Callable[..., RunConfig]


def test_components_are_those_of_the_configuration(toy_config: Load) -> None:
    config = toy_config()
    coevolution = assemble(config)
    assert isinstance(coevolution, Coevolution)
    for collaboration, judge in zip(coevolution.collaborations, coevolution.judges, strict=True):
        assert collaboration.strategy is config.collaboration.component
        assert judge.aggregator is config.aggregator.component
    assert coevolution.evaluator.simulator is config.simulator.component
    assert coevolution.evaluator.objective is config.objective.component
    assert (coevolution.length, coevolution.turn) == (8, -1)


def test_populations_keep_their_order_and_size(toy_config: Load) -> None:
    coevolution = assemble(toy_config())
    assert [population.name for population in coevolution.populations] == ["a", "b"]
    for population, chosen in zip(coevolution.populations, toy_config().populations.values(), strict=True):
        population.reproduce()
        assert len(population.genomes) == chosen.size
        assert population.encoder == chosen.encoder.component


def test_an_evolver_starts_with_the_inputs_and_outputs_of_its_encoder(
    toy_config: Load, monkeypatch: pytest.MonkeyPatch
) -> None:
    started: list[tuple[int, int, int]] = []
    start = toys.Drift.start

    def noted(
        self: toys.Drift, inputs: int, outputs: int, size: int, rng: np.random.Generator
    ) -> toys.DriftRun:
        started.append((inputs, outputs, size))
        return start(self, 1, 1, size, rng)

    monkeypatch.setattr(toys.Drift, "start", noted)
    monkeypatch.setattr(toys.Number, "inputs", 4)
    monkeypatch.setattr(toys.Number, "outputs", 2)
    assemble(toy_config())
    assert started == [(4, 2, 6), (4, 2, 5)]


def test_each_population_has_its_own_random_streams(toy_config: Load) -> None:
    for population in assemble(toy_config("run.seed=8")).populations:
        evolver = population.evolver
        assert isinstance(evolver, toys.DriftRun)
        for used, name in ((evolver.rng, "population"), (population.rng, "collaboration")):
            expected = stream(8, f"{name}/{population.name}")
            assert used.bit_generator.state == expected.bit_generator.state


def test_two_loops_of_one_configuration_share_no_state(toy_config: Load) -> None:
    config = toy_config()
    first, second = assemble(config), assemble(config)
    next(iter(first))
    assert (first.turn, second.turn) == (0, -1)
    assert second.evaluator.simulations == 0


def test_an_evaluator_starts_and_closes_its_workers(toy_config: Load) -> None:
    before = len(toys.CLOSED)
    evaluator = evaluator_of(toy_config())
    assert isinstance(evaluator, Evaluator)
    assert evaluator.evaluate([], 0) == []
    evaluator.close()
    assert len(toys.CLOSED) == before + 1
