"""Simulation of designs of files and runs: scores and positions of points."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from evoframe import Design, InputError, Plugins, RunConfig, run
from evoframe.designs import read_job, simulate_job, trace_of
from evoframe_simulators import Vox

Load = Callable[..., RunConfig]


def test_a_champion_has_the_same_score_as_in_its_run(
    toy_config: Load, toy_plugins: Plugins, tmp_path: Path
) -> None:
    made = run(toy_config(), out=tmp_path / "run")
    job = read_job(made.directory, None, (), toy_plugins)
    assert [score.value for score in simulate_job(job)] == [made.champion().score]


def test_a_design_that_cannot_be_simulated_is_named_by_its_file(
    toy_config: Load, toy_plugins: Plugins, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    made = run(toy_config(), out=tmp_path / "run")
    job = read_job(made, None, (), toy_plugins)

    def refuses(*_: object) -> None:
        raise InputError("has no voxels")

    monkeypatch.setattr(type(job.config.simulator.component), "simulate", refuses)
    with pytest.raises(InputError, match="has no voxels") as caught:
        simulate_job(job)
    assert caught.value.source == str(made.directory)


def test_a_trace_has_a_row_for_each_step_and_the_state_before_the_first() -> None:
    simulator = Vox(duration=0.001)
    [(_, body), *_] = simulator.published()
    design = Design({**body.roles})
    header, *rows = trace_of(simulator, design)
    assert header[:2] == ["step", "time"]
    assert header[2:] == [f"{name}_{axis}" for name in simulator.tracks for axis in "xyz"]
    assert [int(row[0]) for row in rows] == list(range(len(rows)))
    times = [float(row[1]) for row in rows]
    assert times[0] == 0.0
    assert times == sorted(times)
    assert all(len(row) == len(header) for row in rows)
