"""Tests of worker processes: results, failures and shutdown."""

from __future__ import annotations

import os
import signal
import time
from collections.abc import Iterator
from concurrent.futures.process import BrokenProcessPool
from pathlib import Path

import chores
import pebble
import pytest
from processes import python

from evoframe import WorkerProcesses

LONG = 60.0


@pytest.fixture(scope="module")
def workers() -> Iterator[WorkerProcesses]:
    made = WorkerProcesses(2)
    yield made
    made.close()


def test_tasks_run_in_other_processes(workers: WorkerProcesses) -> None:
    squares = [workers.schedule(chores.square, [number]) for number in range(8)]
    assert [future.result(LONG) for future in squares] == [number**2 for number in range(8)]
    assert workers.schedule(chores.process, [None]).result(LONG) != os.getpid()


def test_an_exception_of_a_task_is_raised_in_the_parent(workers: WorkerProcesses) -> None:
    with pytest.raises(ZeroDivisionError, match="item 1"):
        workers.schedule(chores.fail, [1]).result(LONG)


def test_a_task_beyond_its_time_limit_is_stopped_and_others_complete(workers: WorkerProcesses) -> None:
    late = workers.schedule(chores.hang, ["for long"], 0.3)
    with pytest.raises(TimeoutError):
        late.result(LONG)
    assert workers.schedule(chores.square, [3]).result(LONG) == 9


@pytest.mark.parametrize(
    ("task", "code", "ending"),
    [
        (chores.end_process, 3, "exit code 3"),
        (chores.end_process, -signal.SIGKILL, "SIGKILL"),
        (chores.end_process_silently, 1, "exit code 0"),
    ],
)
def test_the_end_of_a_worker_is_detected_whatever_its_exit_code(
    workers: WorkerProcesses, task: object, code: int, ending: str
) -> None:
    assert callable(task)
    with pytest.raises(pebble.ProcessExpired) as caught:
        workers.schedule(task, [code]).result(LONG)
    assert WorkerProcesses.ending(caught.value).endswith(ending)


def test_tasks_without_a_result_fail_when_the_pool_is_closed() -> None:
    made = WorkerProcesses(1)
    tasks = [made.schedule(chores.hang, [number]) for number in range(3)]
    assert made.active
    made.close()
    assert not made.active
    for task in tasks:
        with pytest.raises(BrokenProcessPool):
            task.result(LONG)


def test_a_process_is_initialized_before_its_first_task(tmp_path: Path) -> None:
    made = WorkerProcesses(1, chores.mark, [tmp_path / "prepared"])
    try:
        assert made.schedule(chores.square, [2]).result(LONG) == 4
        assert (tmp_path / "prepared").exists()
    finally:
        made.close()


PARENT = """
import os, pathlib, signal, sys, time
import chores
from evoframe import WorkerProcesses
if __name__ == "__main__":
    path = pathlib.Path(sys.argv[1])
    workers = WorkerProcesses(1)
    workers.schedule(chores.write_process_and_hang, [path])
    while not path.exists() or not path.read_text():
        time.sleep(0.02)
    os.kill(os.getpid(), signal.SIGKILL)
"""


def test_a_worker_ends_with_the_process_that_started_it(tmp_path: Path) -> None:
    (tmp_path / "parent.py").write_text(PARENT)
    support = str(Path(__file__).parents[1] / "support")
    ended = python(tmp_path / "parent.py", tmp_path / "worker", PYTHONPATH=support)
    assert ended.returncode == -signal.SIGKILL, ended.stderr
    worker = int((tmp_path / "worker").read_text())
    until = time.monotonic() + 10
    while is_running(worker) and time.monotonic() < until:
        time.sleep(0.02)
    assert not is_running(worker)


def is_running(process: int) -> bool:
    """Return whether a process is running; a zombie does not count."""
    try:
        state = Path(f"/proc/{process}/stat").read_text()
    except OSError:
        return False
    return state.rpartition(")")[2].split()[0] != "Z"
