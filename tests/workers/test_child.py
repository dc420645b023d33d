"""The program of a worker process, in threads of this process; as a process it is tested with its pool."""

from __future__ import annotations

import os
import socket
import threading
from collections.abc import Iterator
from typing import Any

import chores
import pytest

from evoframe.workers import begin, child, report, stop_requested
from evoframe.workers.channel import Channel
from evoframe.workers.child import Begun, Report, Result, is_preparing, serve


@pytest.fixture
def served(monkeypatch: pytest.MonkeyPatch) -> Iterator[Channel]:
    """The parent's end of a connection whose other end executes tasks."""
    here, there = map(Channel, socket.socketpair())
    monkeypatch.setattr(child._state, "channel", there)
    thread = threading.Thread(target=until_closed, args=[there])
    thread.start()
    yield here
    here.shutdown()
    thread.join()
    here.close()
    there.close()


def until_closed(channel: Channel) -> None:
    with pytest.raises(EOFError):
        serve(channel)


def messages(channel: Channel, task: object, *arguments: Any, begins_itself: bool = False) -> list[Any]:
    """Return the messages of a task, up to its result."""
    channel.send((Channel.pack((task, arguments)), begins_itself))
    received = [channel.receive()]
    while not isinstance(received[-1], Result):
        received.append(channel.receive())
    return received


def test_a_task_begins_and_has_a_result(served: Channel) -> None:
    assert messages(served, chores.square, 3) == [Begun(), Result(9)]


def advance(value: int) -> int:
    begin()
    report(value)
    return value + 1


def test_a_task_can_begin_itself_and_report(served: Channel) -> None:
    assert messages(served, advance, 1, begins_itself=True) == [Begun(), Report(1), Result(2)]


@pytest.mark.parametrize(("item", "error"), [(1, ZeroDivisionError), (2, RuntimeError), (3, SystemExit)])
def test_an_exception_is_a_result(served: Channel, item: int, error: type[BaseException]) -> None:
    [_, result] = messages(served, chores.fail, item)
    assert type(result.error) is error
    assert f"item {item}" in str(result.error)
    assert messages(served, chores.square, 3)[-1] == Result(9)


@pytest.mark.parametrize(
    ("task", "argument", "text"),
    [(chores.square, chores.UnknownElsewhere(), "my_simulator"), (chores.give_a_lock, 1, "pickle")],
)
def test_a_failed_transfer_is_a_result(
    served: Channel, task: object, argument: object, text: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    packed = Channel.pack((task, (argument,)))
    monkeypatch.setattr(os, "getpid", lambda: 0)  # for UnknownElsewhere, which the same process knows
    served.send((packed, True))
    assert text in str(served.receive().error)


def test_only_a_task_of_a_worker_reports() -> None:
    for action in (begin, lambda: report(1)):
        with pytest.raises(RuntimeError, match="not a worker"):
            action()


def test_a_stop_is_requested_by_closing_a_pipe(monkeypatch: pytest.MonkeyPatch) -> None:
    assert not stop_requested()
    reading, writing = os.pipe()
    monkeypatch.setattr(child._state, "stop", reading)
    assert not stop_requested()
    os.close(writing)
    assert stop_requested()
    assert stop_requested()
    os.close(reading)


def test_a_program_that_is_not_a_worker_may_start_workers() -> None:
    assert not is_preparing()
