"""Pools of worker processes: results, replacement of workers that end, failures and shutdown."""

from __future__ import annotations

import contextlib
import functools
import logging
import os
import re
import signal
import threading
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from queue import SimpleQueue
from typing import Any

import chores
import pytest
from chatter import chatter
from processes import LIMIT, eventually, is_ended, python

from evoframe import RunError, WorkerError, WorkerProcesses
from evoframe.workers import processes
from evoframe.workers.process import Worker

SUPPORT = str(Path(__file__).parents[1] / "support")


@pytest.fixture(scope="module")
def workers() -> Iterator[WorkerProcesses]:
    made = WorkerProcesses(2)
    yield made
    made.close()


def test_tasks_run_in_other_processes(workers: WorkerProcesses) -> None:
    squares = [workers.schedule(chores.square, [number]) for number in range(8)]
    assert [future.result(LIMIT) for future in squares] == [number**2 for number in range(8)]
    assert workers.schedule(chores.process, [None]).result(LIMIT) != os.getpid()


def test_an_exception_of_a_task_is_raised_in_the_parent(workers: WorkerProcesses) -> None:
    with pytest.raises(ZeroDivisionError, match="item 1"):
        workers.schedule(chores.fail, [1]).result(LIMIT)


def test_a_task_beyond_its_time_limit_is_stopped_and_others_complete(workers: WorkerProcesses) -> None:
    late = workers.schedule(chores.hang, ["for long"], 0.3)
    with pytest.raises(TimeoutError):
        late.result(LIMIT)
    assert workers.schedule(chores.square, [3]).result(LIMIT) == 9


@pytest.mark.parametrize(
    ("task", "code", "ending", "times"),
    [
        (chores.end_process, 3, "exit code 3", 5),
        (chores.end_process, -signal.SIGSEGV, "the signal SIGSEGV", 5),
        (chores.end_process, -signal.SIGRTMIN - 3, f"the signal {signal.SIGRTMIN + 3}", 5),
        (chores.end_process, -signal.SIGKILL, "the signal SIGKILL", 20),
        (chores.end_process_silently, 1, "exit code 0", 5),
    ],
)
def test_a_task_that_ends_its_workers_fails_after_several(
    workers: WorkerProcesses, task: Callable[[int], int], code: int, ending: str, times: int
) -> None:
    with pytest.raises(WorkerError) as caught:
        workers.schedule(task, [code]).result(LIMIT)
    assert caught.value.item == (code,)
    assert f"ended with {ending};" in caught.value.problem
    assert re.findall(r"\d+", caught.value.problem)[-1] == str(times)
    assert workers.schedule(chores.square, [3]).result(LIMIT) == 9


def test_a_warning_says_that_work_is_repeated(
    workers: WorkerProcesses, caplog: pytest.LogCaptureFixture, tmp_path: Path
) -> None:
    assert (
        workers.schedule(chores.advance_and_end, [tmp_path]).result(LIMIT) == 9
    )  # it reports before each end
    assert [record for record in caplog.records if record.levelno == logging.WARNING] == []
    with pytest.raises(WorkerError):
        workers.schedule(chores.end_process, [3]).result(LIMIT)
    [warning] = [record for record in caplog.records if record.levelno == logging.WARNING]
    assert "exit code 3" in warning.message


@pytest.fixture
def started(monkeypatch: pytest.MonkeyPatch) -> SimpleQueue[int]:
    """The process ids of all workers, as soon as each exists."""
    ids: SimpleQueue[int] = SimpleQueue()

    class Noted(Worker):
        def __init__(self, stop: int, path: Sequence[str], on_end: Callable[[], object]) -> None:
            super().__init__(stop, path, on_end)
            ids.put(self._process.pid)

    monkeypatch.setattr(processes, "Worker", Noted)
    return ids


def test_workers_that_are_killed_before_they_are_ready_are_replaced(started: SimpleQueue[int]) -> None:
    with contextlib.closing(WorkerProcesses(2)) as made:
        sizes = [made.schedule(chores.size, [bytes(200_000)]) for _ in range(20)]  # exceeds buffers
        for _ in range(30):
            os.kill(started.get(timeout=LIMIT), signal.SIGKILL)
        assert [future.result(LIMIT) for future in sizes] == [200_000] * 20


def test_an_idle_worker_that_is_killed_is_replaced(started: SimpleQueue[int]) -> None:
    with contextlib.closing(WorkerProcesses(1)) as made:
        for number in range(3):
            assert made.schedule(chores.square, [number]).result(LIMIT) == number**2
            os.kill(started.get(timeout=LIMIT), signal.SIGKILL)
        assert started.get(timeout=LIMIT) > 0  # without any further task


def test_work_of_others_is_not_affected_by_a_worker_that_is_killed_while_it_reports() -> None:
    with contextlib.closing(WorkerProcesses(2)) as made:
        reports: SimpleQueue[tuple[int, int]] = SimpleQueue()
        tasks = [made.schedule(chatter, [number], on_report=reports.put) for number in range(2)]
        killed: set[int] = set()
        while len(killed) < 8:
            number, process = reports.get(timeout=LIMIT)
            if number == 0 and process not in killed:
                os.kill(process, signal.SIGKILL)
                killed.add(process)
        made.request_stop()
        made.request_stop()
        assert [task.result(LIMIT) for task in tasks] == [0, 1]
    of_the_other = {process for number, process in iter_now(reports) if number == 1}
    assert len(of_the_other) <= 1


def iter_now(queue: SimpleQueue[tuple[int, int]]) -> Iterator[tuple[int, int]]:
    while not queue.empty():
        yield queue.get()


def test_a_worker_that_is_stopped_is_killed_at_its_time_limit(started: SimpleQueue[int]) -> None:
    with contextlib.closing(WorkerProcesses(1)) as made:
        assert made.schedule(chores.square, [2]).result(LIMIT) == 4
        os.kill(process := started.get(timeout=LIMIT), signal.SIGSTOP)
        for argument in (b"", bytes(5_000_000)):  # the second cannot even be sent
            late = made.schedule(chores.size, [argument], 0.2)
            with pytest.raises(TimeoutError):
                late.result(LIMIT)
            eventually(functools.partial(is_ended, process), "the stopped worker was not killed")
            assert made.schedule(chores.square, [3]).result(LIMIT) == 9
            os.kill(process := started.get(timeout=LIMIT), signal.SIGSTOP)


def test_a_worker_that_is_stopped_for_a_while_continues(started: SimpleQueue[int]) -> None:
    with contextlib.closing(WorkerProcesses(1)) as made:
        squares = [made.schedule(chores.square, [number]) for number in range(10)]
        os.kill(process := started.get(timeout=LIMIT), signal.SIGSTOP)
        threading.Timer(0.3, os.kill, [process, signal.SIGCONT]).start()
        assert [future.result(LIMIT) for future in squares] == [number**2 for number in range(10)]
    assert started.empty()


@pytest.mark.parametrize(
    ("initializer", "argument", "cause"),
    [
        (chores.exit_in_initializer, 0, "exit code 0"),
        (chores.exit_in_initializer, 7, "exit code 7"),
        (chores.end_process, -signal.SIGABRT, "SIGABRT"),
        (chores.fail, 1, "ZeroDivisionError: item 1"),
        (chores.use_memory, 100_000_000, "MemoryError"),
    ],
)
def test_workers_that_never_start_are_reported_with_the_cause(
    initializer: Callable[[int], object], argument: int, cause: str, capfd: pytest.CaptureFixture[str]
) -> None:
    with contextlib.closing(WorkerProcesses(2, initializer, [argument])) as made:
        tasks = [made.schedule(chores.square, [number]) for number in range(3)]
        for task in tasks:
            with pytest.raises(RunError, match="cannot be started") as caught:
                task.result(LIMIT)
            assert cause in caught.value.problem
        assert not made.active
        with pytest.raises(RunError, match="shut down"):
            made.schedule(chores.square, [1])
    assert capfd.readouterr() == ("", "")


LIMITED = """
import resource
import chores
from evoframe import RunError, WorkerProcesses
if __name__ == "__main__":
    workers = WorkerProcesses(2)
    resource.setrlimit(resource.LIMIT, (VALUE, resource.getrlimit(resource.LIMIT)[1]))
    try:
        print(workers.schedule(chores.square, [3]).result(120))
    except RunError as error:
        print(error)
    workers.close()
"""


@pytest.mark.parametrize(
    ("limit", "value"),
    [("RLIMIT_AS", 1 << 20), ("RLIMIT_AS", 12 << 20), ("RLIMIT_AS", 40 << 20), ("RLIMIT_NOFILE", 9)],
)
def test_a_limit_that_prevents_all_starts_is_an_error(tmp_path: Path, limit: str, value: int) -> None:
    (tmp_path / "limited.py").write_text(LIMITED.replace("LIMIT", limit).replace("VALUE", str(value)))
    ended = python(tmp_path / "limited.py", PYTHONPATH=SUPPORT)
    assert (ended.returncode, ended.stderr) == (0, "")
    assert "cannot be started" in ended.stdout


def test_text_that_workers_print_goes_to_standard_error(capfd: pytest.CaptureFixture[str]) -> None:
    with contextlib.closing(WorkerProcesses(1, chores.write, [2, b"initializer "])) as made:
        for descriptor in (1, 2):
            made.schedule(chores.write, [descriptor, b"to %d " % descriptor]).result(LIMIT)
    assert capfd.readouterr() == ("", "initializer to 1 to 2 ")


CLOSED = """
import os, sys
import chores
from evoframe import WorkerProcesses
if __name__ == "__main__":
    os.closerange(0, 3)
    workers = WorkerProcesses(2)
    result = workers.schedule(chores.square, [3]).result(120)
    workers.close()
    os._exit(result)
"""


def test_standard_streams_may_be_closed(tmp_path: Path) -> None:
    (tmp_path / "closed.py").write_text(CLOSED)
    assert python(tmp_path / "closed.py", PYTHONPATH=SUPPORT).returncode == 9


def test_modules_in_the_working_directory_do_not_replace_others(tmp_path: Path) -> None:
    (tmp_path / "socket.py").write_text("raise SystemExit('not this one')")
    (tmp_path / "programs").mkdir()
    (tmp_path / "programs" / "program.py").write_text(LIMITED.replace("    resource.setrlimit", "    #"))
    ended = python("programs/program.py", directory=tmp_path, PYTHONPATH=SUPPORT)
    assert (ended.stdout, ended.stderr) == ("9\n", "")


def test_a_pool_without_a_working_directory_is_an_error(tmp_path: Path) -> None:
    (tmp_path / "gone").mkdir()
    program = LIMITED.replace("    resource.setrlimit", "    import os; os.rmdir(os.getcwd()) #")
    (tmp_path / "program.py").write_text(program)
    ended = python(tmp_path / "program.py", directory=tmp_path / "gone", PYTHONPATH=SUPPORT)
    assert ended.returncode == 0, ended.stderr
    assert "cannot be started" in ended.stdout


def test_tasks_without_a_result_fail_when_the_pool_is_closed() -> None:
    made = WorkerProcesses(1)
    tasks = [made.schedule(chores.hang, [number]) for number in range(3)]
    assert made.active
    made.close()
    assert not made.active
    for task in tasks:
        with pytest.raises(RunError, match="shut down"):
            task.result(LIMIT)
    made.close()
    WorkerProcesses(1).close()  # never used


def test_a_cancelled_task_is_not_executed(tmp_path: Path) -> None:
    with contextlib.closing(WorkerProcesses(1)) as made:
        first = made.schedule(chores.square, [2])
        second = made.schedule(chores.mark, [tmp_path / "second"])
        assert second.cancel()
        assert made.schedule(chores.square, [3]).result(LIMIT) == 9
        assert first.result(LIMIT) == 4
    assert not (tmp_path / "second").exists()


def test_a_callback_that_fails_fails_its_task_only() -> None:
    def refuse(_: Any) -> None:
        raise KeyError("callback")

    with contextlib.closing(WorkerProcesses(1)) as made:
        with pytest.raises(KeyError, match="callback"):
            made.schedule(chatter, [1], on_report=refuse).result(LIMIT)
        assert made.schedule(chores.square, [3]).result(LIMIT) == 9


def test_a_process_is_initialized_before_its_first_task(tmp_path: Path) -> None:
    made = WorkerProcesses(1, chores.mark, [tmp_path / "prepared"])
    try:
        assert made.schedule(chores.square, [2]).result(LIMIT) == 4
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
    ended = python(tmp_path / "parent.py", tmp_path / "worker", PYTHONPATH=SUPPORT)
    assert ended.returncode == -signal.SIGKILL, ended.stderr
    worker = int((tmp_path / "worker").read_text())
    eventually(functools.partial(is_ended, worker), "the worker still runs")
