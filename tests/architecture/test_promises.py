"""Tests of stability: scripts that use components without the command line continue to work."""

from __future__ import annotations

import numpy as np
import pytest

import evoframe


@pytest.fixture(scope="module")
def config() -> evoframe.RunConfig:
    return evoframe.load_config("quick", overrides=["simulator.duration=0.08", "executor=serial"])


@pytest.fixture(scope="module")
def design() -> evoframe.Design:
    """Two rows of voxels, one of them contractile."""
    cells = np.zeros((6, 2, 2), np.uint8)
    cells[:, 0], cells[:, 1] = evoframe.PASSIVE, evoframe.CONTRACTILE
    return evoframe.Design({"morphology": cells, "controller": np.zeros(cells.shape)})


def test_designs_are_simulated_and_scored(config: evoframe.RunConfig, design: evoframe.Design) -> None:
    simulator, objective = config.simulator.component, config.objective.component
    phases = np.linspace(0.0, 1.0, 24).reshape(6, 2, 2)
    outcomes = simulator.simulate([design, design.with_role("controller", phases)], objective.record)
    scores = [objective.score(outcome) for outcome in outcomes]
    assert all(np.isfinite(scores))
    assert scores[0] != scores[1]


def test_a_simulator_accepts_a_record(config: evoframe.RunConfig, design: evoframe.Design) -> None:
    simulator = config.simulator.component
    [outcome] = simulator.simulate([design], evoframe.Record(tracks=simulator.tracks, every=0.01))
    assert isinstance(outcome, evoframe.Outcome)
    assert outcome.diverged_at is None
    assert {name: track.shape for name, track in outcome.tracks.items()} == dict.fromkeys(
        simulator.tracks, (len(outcome.times), 3)
    )


def test_an_objective_has_a_record(config: evoframe.RunConfig) -> None:
    record = config.objective.component.record
    assert isinstance(record, evoframe.Record)
    config.simulator.component.check(record)  # does not raise


def test_populations_decode_designs_in_sequence(config: evoframe.RunConfig) -> None:
    with evoframe.assemble(config) as coevolution:
        for population in coevolution.populations:
            population.reproduce()
        design = evoframe.Design({})
        for population in coevolution.populations:
            design = population.decode(0, design)
        assert design.roles.keys() >= set(config.simulator.component.requires)
        [outcome] = config.simulator.component.simulate([design], config.objective.component.record)
        assert isinstance(outcome, evoframe.Outcome)


def test_a_loop_can_be_iterated_manually(config: evoframe.RunConfig) -> None:
    with evoframe.assemble(config) as coevolution:
        turn = next(iter(coevolution))
    assert (turn.index, {report.population for report in turn.reports}) == (0, set(config.populations))
