"""One worker process: its start, its tasks and its end."""

from __future__ import annotations

import contextlib
import errno
import os
import signal
import subprocess
import sys
import threading
from collections.abc import Callable, Iterator, Sequence
from typing import Any

import chores
import pytest

from evoframe.workers import process
from evoframe.workers.channel import Channel
from evoframe.workers.child import Begun, Result, Start
from evoframe.workers.process import StartError, Worker, main_program

Make = Callable[[], Worker]


@pytest.fixture
def make() -> Iterator[Make]:
    """Start a worker that nothing requests to stop."""
    reading, writing = os.pipe()
    made: list[Worker] = []

    def worker() -> Worker:
        made.append(Worker(reading, main_program()["sys_path"], lambda: None))
        return made[-1]

    yield worker
    for each in made:
        each.kill()
        each.finish()
    os.close(reading)
    os.close(writing)


def start(initializer: Callable[..., object] | None = None, *arguments: Any) -> Start:
    return Start(main_program(), initializer, arguments)


def squared(worker: Worker, number: int) -> Any:
    messages: list[Any] = []
    result = worker.execute((Channel.pack((chores.square, (number,))), False), None, messages.append)
    assert messages == [Begun()]
    return result


def test_a_worker_executes_tasks_and_exits_when_it_is_finished(make: Make) -> None:
    worker = make()
    worker.prepare(start())
    assert [squared(worker, number) for number in range(3)] == [Result(0), Result(1), Result(4)]
    assert not worker.ended
    worker.finish()
    assert worker.ended
    assert worker.ending() == "exit code 0"
    assert not worker.killed


@pytest.mark.parametrize(
    ("number", "killed"), [(signal.SIGKILL, True), (signal.SIGTERM, True), (signal.SIGSEGV, False)]
)
def test_the_end_of_a_worker_is_noticed(make: Make, number: int, killed: bool) -> None:
    worker = make()
    worker.prepare(start())
    os.kill(worker._process.pid, number)
    with pytest.raises(EOFError):
        squared(worker, 2)
    assert worker.ending() == f"the signal {signal.Signals(number).name}"
    assert worker.killed == killed


def test_the_end_of_a_worker_is_noticed_if_a_fork_keeps_its_connection(make: Make) -> None:
    worker = make()
    worker.prepare(start())
    with pytest.raises(EOFError):
        worker.execute((Channel.pack((chores.fork_and_end, (3,))), False), None, lambda _: None)
    assert worker.ending() == "exit code 3"


@pytest.mark.parametrize(
    ("initializer", "argument", "cause", "killed"),
    [
        (chores.fail, 1, "ZeroDivisionError: item 1", False),
        (chores.fail_with_output, b"a cause", "exit code 4: a cause", False),
        (chores.end_process, -signal.SIGKILL, "the signal SIGKILL", True),
    ],
)
def test_a_start_that_fails_has_a_cause(
    make: Make,
    initializer: Callable[[Any], object],
    argument: object,
    cause: str,
    killed: bool,
    capfd: pytest.CaptureFixture[str],
) -> None:
    with pytest.raises(StartError) as caught:
        make().prepare(start(initializer, argument))
    assert str(caught.value) == cause
    assert caught.value.killed == killed
    assert capfd.readouterr() == ("", "")


def test_a_start_that_takes_too_long_is_ended(make: Make, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(process, "_START_LIMIT", 0.2)
    worker = make()
    with pytest.raises(StartError, match=r"0\.2 s"):
        worker.prepare(start(chores.hang, "for long"))
    assert worker.ending() == "the signal SIGKILL"


def test_a_worker_that_cannot_be_started_leaves_no_open_files(
    make: Make, monkeypatch: pytest.MonkeyPatch
) -> None:
    def refused(*_: object, **__: object) -> None:
        raise OSError(errno.EAGAIN, "no process left")

    def no_thread(_: threading.Thread) -> None:
        raise RuntimeError("can't start new thread")

    descriptors = len(os.listdir("/proc/self/fd"))  # noqa: PTH208 - names only
    with monkeypatch.context() as patch:
        patch.setattr(subprocess, "Popen", refused)
        with pytest.raises(OSError, match="no process left"):
            make()
    with monkeypatch.context() as patch:
        patch.setattr(threading.Thread, "start", no_thread)
        with pytest.raises(RuntimeError, match="thread"):
            make()
    assert len(os.listdir("/proc/self/fd")) == descriptors  # noqa: PTH208


def test_a_worker_gets_the_options_of_the_interpreter_but_not_its_secret(
    make: Make, monkeypatch: pytest.MonkeyPatch
) -> None:
    commands: list[Sequence[str]] = []
    popen = subprocess.Popen

    def noted(command: Sequence[str], **options: Any) -> Any:
        commands.append(command)
        return popen(command, **options)

    monkeypatch.setattr(subprocess, "Popen", noted)
    worker = make()
    [[executable, *options, unsafe_path, _, _]] = commands
    assert os.fsdecode(executable) == sys.executable
    assert unsafe_path == "-P"
    assert all(option.startswith("-") for option in options)
    assert "authkey" not in main_program()
    with contextlib.suppress(StartError):
        worker.prepare(start())
