"""Simulations that never end: the run stops, names them, and can be resumed."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from recorded import assert_same_result

import evoframe_executors
from evoframe import Plugins, RunConfig, load_run, resume, run
from evoframe.contract.config import Source
from evoframe.errors import ComponentError

# The limits are much longer than the first batch takes on a busy computer, which imports the simulator.
THREADS = "executor={name='threads', workers=2, batch_time_limit=2.0}"
PROCESSES = "executor={name='processes', workers=2, batch_time_limit=8.0}"
ERROR = (
    r"'toy-hanging' \(plugin 'toys' of toy-box 1\.0\): .*executor\.batch_time_limit.* {}.* "
    r"\(turn \d, a \d+ with b \d+.*\)"
)

Load = Callable[..., RunConfig]


@pytest.fixture
def hanging(toy_config: Load, toy_plugins: Plugins, tmp_path: Path) -> Load:
    """Return a loader of configurations whose simulations hang while the file ``fixed`` is missing."""
    toy_plugins.add(evoframe_executors, Source("tools", "1.0", "executors"))

    def load(executor: str, *, once: bool = False) -> RunConfig:
        fixed, flag = tmp_path / "fixed", str(once).lower()
        return toy_config(f"simulator={{name='toy-hanging', fixed='{fixed}', once={flag}}}", executor)

    return load


def undisturbed(hanging: Load, directory: Path, *, once: bool = False) -> Path:
    (directory / "fixed").touch()
    finished = run(hanging("executor='serial'", once=once), out=directory / "undisturbed")
    (directory / "fixed").unlink()
    return finished.directory


@pytest.mark.parametrize(("executor", "limit"), [(THREADS, r"2\.0"), (PROCESSES, r"8\.0.*twice")])
def test_the_run_stops_and_can_be_resumed_after_a_fix(
    hanging: Load, toy_plugins: Plugins, tmp_path: Path, executor: str, limit: str
) -> None:
    expected = undisturbed(hanging, tmp_path)
    with pytest.raises(ComponentError, match=ERROR.format(limit)) as caught:
        run(hanging(executor), out=tmp_path / "run")
    assert caught.value.component == "simulator"
    assert load_run(tmp_path / "run").last_turn() is not None
    (tmp_path / "fixed").touch()
    resume(tmp_path / "run", plugins=toy_plugins)
    assert_same_result(expected, tmp_path / "run")


def test_a_process_that_hangs_once_does_not_stop_the_run(hanging: Load, tmp_path: Path) -> None:
    expected = undisturbed(hanging, tmp_path, once=True)
    run(hanging(PROCESSES, once=True), out=tmp_path / "run")
    assert (tmp_path / "fixed").exists()  # created by the simulation that hung
    assert_same_result(expected, tmp_path / "run")
