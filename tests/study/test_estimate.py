"""Estimates of time and disk space of missing runs."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from evoframe import load_run
from evoframe.study.estimate import estimate_cost
from evoframe.study.plan import Planned, Study

Read = Callable[..., Study]


def test_costs_of_finished_runs_are_scaled_by_the_number_of_pairs(
    made: tuple[Study, Path, list[Planned]],
) -> None:
    _, _, planned = made
    finished, missing = planned[:2], planned[2:]
    assert missing[0].cell.pairs > finished[0].cell.pairs
    ratio = sum(run.cell.pairs for run in missing) / sum(run.cell.pairs for run in finished)
    took = {run: sum(row["seconds"] for row in load_run(run.directory).workload()) for run in finished}
    found = estimate_cost(missing, took)
    seconds = sum(row["seconds"] for run in finished for row in load_run(run.directory).workload())
    size = sum(path.stat().st_size for run in finished for path in run.directory.iterdir())
    assert found.seconds == pytest.approx(seconds * ratio)
    assert found.megabytes == pytest.approx(size * ratio / 1e6)
    assert found.measured.startswith("2 ")
    assert found.bound == "about"


def test_one_finished_run_is_enough_for_an_estimate(made: tuple[Study, Path, list[Planned]]) -> None:
    finished, *missing = made[2]
    found = estimate_cost(missing, {finished: 3.0})
    ratio = sum(run.cell.pairs for run in missing) / finished.cell.pairs
    assert found.seconds == pytest.approx(3.0 * ratio)
    assert found.bound == "about"
    assert found.measured.startswith("1 ")


def test_a_trial_writes_nothing_and_counts_all_workers(toy_study: Read, tmp_path: Path) -> None:
    delay = 'grid.simulator=[{name="toy-slow", delay=0.01}]'
    study = toy_study(delay, "grid.collaboration.n=[1]", "executor={name='toy-many', workers=1}")
    before = set(tmp_path.rglob("*"))
    missing = list(study.planned(tmp_path / "there"))
    one, all_of_them = estimate_cost(missing[:1], {}), estimate_cost(missing, {})
    assert one.bound == all_of_them.bound == "at most"
    assert one.seconds > 0.01 * missing[0].cell.pairs / 12  # one delay for each batch of at most 12
    assert all_of_them.megabytes == pytest.approx(3 * one.megabytes)
    assert set(tmp_path.rglob("*")) == before


def test_no_runs_take_no_time_and_no_disk_space() -> None:
    nothing = estimate_cost((), {})
    assert (nothing.seconds, nothing.megabytes) == (0.0, 0.0)
