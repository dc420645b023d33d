"""What missing runs are thought to take."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from evoframe import load_run
from evoframe.study.estimate import Estimate, estimate_cost
from evoframe.study.plan import Planned, Study

Read = Callable[..., Study]


def test_that_of_finished_runs_goes_with_the_pairs(made: tuple[Study, Path, list[Planned]]) -> None:
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
    assert found.measured == "2 finished runs"


def test_a_trial_writes_nothing_and_counts_all_workers(toy_study: Read, tmp_path: Path) -> None:
    delay = 'grid.simulator=[{name="toy-slow", delay=0.01}]'
    study = toy_study(delay, "grid.collaboration.n=[1]", "executor={name='toy-many', workers=1}")
    before = set(tmp_path.rglob("*"))
    missing = list(study.planned(tmp_path / "there"))
    one, all_of_them = estimate_cost(missing[:1], {}), estimate_cost(missing, {})
    assert one.measured == "the first turn of one run"
    assert one.seconds > 0.01 * missing[0].cell.pairs / 4  # at most four of them in a batch
    assert all_of_them.megabytes == pytest.approx(3 * one.megabytes)
    assert set(tmp_path.rglob("*")) == before


def test_nothing_takes_nothing() -> None:
    assert estimate_cost((), {}) == Estimate(0.0, 0.0, "the first turn of one run")
