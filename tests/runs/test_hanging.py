"""Simulations that never end: the run says which, is saved, and can go on."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from recorded import assert_same_result

import evoframe_executors
from evoframe import Plugins, RunConfig, RunError, load_run, resume, run
from evoframe.contract.config import Source

THREADS = "executor={name='threads', workers=2, batch_time_limit=0.5}"
PROCESSES = "executor={name='processes', workers=2, batch_time_limit=5.0}"
ERROR = (
    r"simulator: 'toy-hanging' \(plugin 'toys' of toy-box 1\.0\): took longer than "
    r"executor\.batch_time_limit = {} \(turn \d, a \d+ with b \d+.*\)"
)

Load = Callable[..., RunConfig]


@pytest.fixture
def hanging(toy_config: Load, toy_plugins: Plugins, tmp_path: Path) -> Load:
    """Return how the configuration of a run is loaded that hangs where the file ``mended`` is missing."""
    toy_plugins.add(evoframe_executors, Source("tools", "1.0", "executors"))

    def load(executor: str, *, once: bool = False) -> RunConfig:
        mended, flag = tmp_path / "mended", str(once).lower()
        return toy_config(f"simulator={{name='toy-hanging', mended='{mended}', once={flag}}}", executor)

    return load


def undisturbed(hanging: Load, directory: Path, *, once: bool = False) -> Path:
    (directory / "mended").touch()
    finished = run(hanging("executor='serial'", once=once), out=directory / "undisturbed")
    (directory / "mended").unlink()
    return finished.directory


@pytest.mark.parametrize(
    ("executor", "limit"), [(THREADS, r"0\.5 seconds"), (PROCESSES, r"5\.0 seconds, twice")]
)
def test_the_run_stops_and_goes_on_when_it_is_mended(
    hanging: Load, toy_plugins: Plugins, tmp_path: Path, executor: str, limit: str
) -> None:
    expected = undisturbed(hanging, tmp_path)
    with pytest.raises(RunError, match=ERROR.format(limit)):
        run(hanging(executor), out=tmp_path / "run")
    assert load_run(tmp_path / "run").last_turn() is not None
    (tmp_path / "mended").touch()
    resume(tmp_path / "run", plugins=toy_plugins)
    assert_same_result(expected, tmp_path / "run")


def test_a_process_that_hangs_once_does_not_stop_the_run(hanging: Load, tmp_path: Path) -> None:
    expected = undisturbed(hanging, tmp_path, once=True)
    run(hanging(PROCESSES, once=True), out=tmp_path / "run")
    assert (tmp_path / "mended").exists()  # it has hung
    assert_same_result(expected, tmp_path / "run")
