"""Workers that crash or hang, and tasks that cannot be sent to them."""

from __future__ import annotations

import os
import signal
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import chores
import pytest
from processes import Program, ended, eventually, surroundings

from evoframe import ExecutorRun, RunError, WorkerError
from evoframe.testing import ExecutorContract
from evoframe_executors import Processes

LONG = 5.0  # s; enough to start a process and import its modules on a busy computer


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
def two_with_time_limit() -> Iterator[ExecutorRun]:
    run = Processes(workers=2, batch_time_limit=LONG).start()
    yield run
    run.close()


def test_workers_are_separate_processes(two: ExecutorRun) -> None:
    used = set(two.map(chores.process, range(20)))
    assert os.getpid() not in used
    assert 1 <= len(used) <= 2


def test_a_hanging_worker_is_terminated_and_its_item_retried(
    two_with_time_limit: ExecutorRun, tmp_path: Path
) -> None:
    items = [tmp_path / "there", tmp_path / "missing", tmp_path / "there"]
    items[0].touch()
    assert two_with_time_limit.map(chores.hang_once, items) == ["done"] * 3


def test_a_worker_that_hangs_twice_is_reported_with_its_item(two_with_time_limit: ExecutorRun) -> None:
    with pytest.raises(WorkerError, match=r"executor\.batch_time_limit = 5\.0 .*twice$") as caught:
        two_with_time_limit.map(chores.hang, [-1, "this"])
    assert caught.value.item == "this"
    assert two_with_time_limit.map(chores.square, [3]) == [9]


def test_the_item_of_a_crashed_worker_is_repeated(two: ExecutorRun, tmp_path: Path) -> None:
    items = [tmp_path / "there", tmp_path / "missing"]
    items[0].touch()
    assert two.map(chores.end_process_once, items) == ["done"] * 2


@pytest.mark.parametrize(
    ("code", "ending"),
    [(3, "exit code 3"), (-signal.SIGSEGV, "SIGSEGV"), (-signal.SIGKILL, "SIGKILL")],
)
def test_a_batch_whose_workers_end_again_and_again_is_reported_with_its_item(
    two: ExecutorRun, code: int, ending: str
) -> None:
    with pytest.raises(WorkerError, match=ending) as caught:
        two.map(chores.end_process, [0, 0, code, 0])
    assert caught.value.item == code
    assert two.map(chores.square, [3]) == [9]


def test_a_worker_that_exits_with_code_0_is_reported(two: ExecutorRun) -> None:
    with pytest.raises(WorkerError, match="exit code 0"):
        two.map(chores.end_process_silently, [0, 1, 0])


def test_workers_ignore_ctrl_c(two: ExecutorRun) -> None:
    workers = set(two.map(chores.process, range(20)))
    for worker in workers:
        os.kill(worker, signal.SIGINT)
    assert set(two.map(chores.process, range(20))) & workers


def test_an_error_has_its_traceback_as_a_note(two: ExecutorRun) -> None:
    with pytest.raises(ZeroDivisionError) as caught:
        two.map(chores.fail, [0, 1])
    assert str(caught.value) == "item 1"
    [note] = caught.value.__notes__
    assert "worker process" in note.splitlines()[0]
    assert 'raise ZeroDivisionError("item 1")' in note


def test_an_error_that_cannot_be_pickled_is_raised_as_text(two: ExecutorRun) -> None:
    with pytest.raises(RunError, match=r"^UnusualError: item 2$"):
        two.map(chores.fail, [2])


def test_an_exception_that_would_end_the_worker_is_raised(two: ExecutorRun) -> None:
    with pytest.raises(SystemExit, match="item 3"):
        two.map(chores.fail, [3])


def test_after_a_failure_no_work_continues(two: ExecutorRun, tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError):
        two.map(chores.mark, [tmp_path / str(n) if n != 4 else None for n in range(1000)])
    so_far = list(tmp_path.iterdir())
    assert 4 <= len(so_far) < 100
    time.sleep(0.3)
    assert list(tmp_path.iterdir()) == so_far


@pytest.mark.parametrize(
    ("function", "item", "cause"),
    [
        (lambda item: item, 1, "send a .*lambda"),
        (chores.square, chores.UnknownElsewhere(), "load a .*: ModuleNotFoundError"),
        (chores.give_a_lock, 1, "return a .*: TypeError"),
    ],
    ids=["function", "item", "result"],
)
def test_a_failed_transfer_is_reported(two: ExecutorRun, function: object, item: object, cause: str) -> None:
    with pytest.raises(RunError, match=f"'processes' .*{cause}.*--set executor=threads$") as caught:
        two.map(function, [item])  # type: ignore[arg-type]
    assert caught.value.key == "executor"


def written(path: Path) -> str:
    """Wait until a file has content, and return it."""
    eventually(lambda: path.exists() and path.read_text(), f"{path} was not written")
    return path.read_text()


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


def start(program: str, directory: Path) -> Program:
    script = directory / "program.py"
    script.write_text(program)
    paths = os.pathsep.join(filter(None, sys.path))
    command = [sys.executable, str(script), str(directory / "process")]
    return Program(command, env={**surroundings(), "PYTHONPATH": paths})


@pytest.mark.parametrize("chore", ["write_process_and_hang", "keep_the_lock"])
def test_workers_end_with_the_process_that_started_them(tmp_path: Path, chore: str) -> None:
    with start(
        PROGRAM.replace("CHORE", chore) + "\nif __name__ == '__main__':\n    main()\n", tmp_path
    ) as program:
        worker = int(written(tmp_path / "process"))
        assert is_alive(worker)
        program.kill()
    eventually(lambda: not is_alive(worker), "the worker still runs")


def test_a_program_that_starts_workers_when_imported_fails_with_advice(tmp_path: Path) -> None:
    with start(PROGRAM.replace("CHORE", "write_process_and_hang") + "\nmain()\n", tmp_path) as program:
        assert ended(program) == 1
    message = program.log[-1].rstrip()
    assert message.startswith("evoframe.errors.RunError: executor: ")
    assert "if __name__ == '__main__':" in message
