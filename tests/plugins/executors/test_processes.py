"""Workers that crash, hang or cannot be sent what they shall do."""

from __future__ import annotations

import multiprocessing
import os
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from pathlib import Path

import chores
import pytest
from processes import surroundings

from evoframe import ExecutorRun, RunError, WorkerError
from evoframe.testing import ExecutorContract
from evoframe_executors import Processes

LONG = 5.0  # enough to start a process and to import what it needs, on a busy computer


class TestOneProcess(ExecutorContract):
    component = Processes(workers=1)


class TestTwoProcesses(ExecutorContract):
    component = Processes(workers=2)


@pytest.fixture(scope="module")
def two() -> Iterator[ExecutorRun]:
    run = Processes(workers=2).start()
    yield run
    run.close()


@pytest.fixture(scope="module")
def two_that_may_not_take_long() -> Iterator[ExecutorRun]:
    run = Processes(workers=2, batch_time_limit=LONG).start()
    yield run
    run.close()


def test_they_are_other_processes(two: ExecutorRun) -> None:
    used = set(two.map(chores.process, range(20)))
    assert os.getpid() not in used
    assert 1 <= len(used) <= 2


def test_one_that_hangs_is_ended_and_its_item_done_once_more(
    two_that_may_not_take_long: ExecutorRun, tmp_path: Path
) -> None:
    items = [tmp_path / "there", tmp_path / "missing", tmp_path / "there"]
    items[0].touch()
    assert two_that_may_not_take_long.map(chores.hang_once, items) == ["done"] * 3


def test_one_that_hangs_twice_is_lost_with_its_item(two_that_may_not_take_long: ExecutorRun) -> None:
    message = r"^took longer than executor\.batch_time_limit = 5\.0 seconds, twice$"
    with pytest.raises(WorkerError, match=message) as caught:
        two_that_may_not_take_long.map(chores.hang, [-1, "this"])
    assert caught.value.item == "this"
    assert two_that_may_not_take_long.map(chores.square, [3]) == [9]


def test_one_that_crashes_has_its_item_done_once_more(two: ExecutorRun, tmp_path: Path) -> None:
    items = [tmp_path / "there", tmp_path / "missing"]
    items[0].touch()
    assert two.map(chores.end_process_once, items) == ["done"] * 2


@pytest.mark.parametrize(
    ("code", "ending"),
    [(3, "exit code 3"), (-signal.SIGSEGV, "the signal SIGSEGV"), (-signal.SIGKILL, "the signal SIGKILL")],
)
def test_one_that_crashes_twice_is_lost_with_its_item(two: ExecutorRun, code: int, ending: str) -> None:
    with pytest.raises(WorkerError, match=f"^ended its process with {ending}, twice$") as caught:
        two.map(chores.end_process, [0, 0, code, 0])
    assert caught.value.item == code
    assert two.map(chores.square, [3]) == [9]


def test_one_that_says_that_all_is_well_and_ends_is_lost_too(two: ExecutorRun) -> None:
    with pytest.raises(WorkerError, match=r"^ended its process with exit code 0, twice$"):
        two.map(chores.end_process_silently, [0, 1, 0])


def test_when_all_are_killed_as_they_start_nothing_is_lost_or_waited_for() -> None:
    items = [bytes(200_000)] * 20  # more than a pipe holds
    killed = threading.Thread(target=kill_the_first_two)
    killed.start()
    run = Processes(workers=2).start()
    try:
        assert run.map(chores.size, items) == [200_000] * 20
    finally:
        run.close()
        killed.join()


def kill_the_first_two() -> None:
    until, pids = time.monotonic() + 30, set[int]()
    while len(pids) < 2 and time.monotonic() < until:
        for child in multiprocessing.active_children():
            if child.pid is not None and child.pid not in pids:
                pids.add(child.pid)
                os.kill(child.pid, signal.SIGKILL)
        time.sleep(0.005)


def test_they_do_not_hear_ctrl_c(two: ExecutorRun) -> None:
    two.map(chores.square, range(4))
    for child in multiprocessing.active_children():
        assert child.pid is not None
        os.kill(child.pid, signal.SIGINT)
    assert two.map(chores.square, range(4)) == [0, 1, 4, 9]


def test_an_error_brings_the_traceback_with_it(two: ExecutorRun) -> None:
    with pytest.raises(ZeroDivisionError) as caught:
        two.map(chores.fail, [0, 1])
    assert str(caught.value) == "item 1"
    [note] = caught.value.__notes__
    assert note.startswith("In a worker process:\n")
    assert 'raise ZeroDivisionError("item 1")' in note


def test_an_error_that_cannot_travel_comes_as_text(two: ExecutorRun) -> None:
    with pytest.raises(RunError, match=r"^UnusualError: item 2$"):
        two.map(chores.fail, [2])


def test_what_would_end_the_worker_is_raised(two: ExecutorRun) -> None:
    with pytest.raises(SystemExit, match="item 3"):
        two.map(chores.fail, [3])


def test_after_a_failure_nothing_goes_on(two: ExecutorRun, tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError):
        two.map(chores.mark, [tmp_path / str(n) if n != 4 else None for n in range(1000)])
    so_far = list(tmp_path.iterdir())
    assert 4 <= len(so_far) < 100
    time.sleep(0.3)
    assert list(tmp_path.iterdir()) == so_far


@pytest.mark.parametrize(
    ("function", "item", "cause"),
    [
        (lambda item: item, 1, "what a worker shall do cannot be sent to it: .*lambda"),
        (
            chores.square,
            chores.UnknownElsewhere(),
            "a worker does not know what it shall do: ModuleNotFoundError",
        ),
        (chores.give_a_lock, 1, "a result cannot be sent back: TypeError"),
    ],
    ids=["function", "item", "result"],
)
def test_what_cannot_travel_is_said(two: ExecutorRun, function: object, item: object, cause: str) -> None:
    with pytest.raises(RunError, match=f"^executor 'processes': {cause}.*work with 'threads' only$"):
        two.map(function, [item])  # type: ignore[arg-type]


def written(path: Path) -> str:
    """Wait until a file has content, and return it."""
    until = time.monotonic() + 60
    while time.monotonic() < until:
        if path.exists() and (content := path.read_text()):
            return content
        time.sleep(0.02)
    raise AssertionError(f"{path} was not written")


def is_alive(process: int) -> bool:
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    return True


PROGRAM = """
import sys
from pathlib import Path
import chores
from evoframe_executors import Processes

def main():
    run = Processes(workers=1).start()
    run.map(chores.CHORE, [Path(sys.argv[1])])
"""


def start(program: str, directory: Path) -> subprocess.Popen[str]:
    script = directory / "program.py"
    script.write_text(program)
    paths = os.pathsep.join(filter(None, sys.path))
    return subprocess.Popen(
        [sys.executable, str(script), str(directory / "process")],
        env={**surroundings(), "PYTHONPATH": paths},
        stderr=subprocess.PIPE,
        text=True,
    )


@pytest.mark.parametrize("chore", ["write_process_and_hang", "keep_the_lock"])
def test_they_end_with_the_process_that_started_them(tmp_path: Path, chore: str) -> None:
    with start(
        PROGRAM.replace("CHORE", chore) + "\nif __name__ == '__main__':\n    main()\n", tmp_path
    ) as program:
        worker = int(written(tmp_path / "process"))
        assert is_alive(worker)
        program.kill()
    until = time.monotonic() + 60
    while is_alive(worker) and time.monotonic() < until:
        time.sleep(0.02)
    assert not is_alive(worker)


def test_a_program_that_starts_them_when_it_is_imported_is_told_so(tmp_path: Path) -> None:
    with start(PROGRAM.replace("CHORE", "write_process_and_hang") + "\nmain()\n", tmp_path) as program:
        said = program.communicate(timeout=120)[1]
    assert program.returncode == 1
    assert said.splitlines()[-1].startswith(
        "evoframe.errors.RunError: processes to work in cannot be started, or end at once; "
    )
