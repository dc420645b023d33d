"""The program of a worker process, and what its tasks can ask of the process that started it."""

from __future__ import annotations

import contextlib
import multiprocessing.spawn
import os
import signal
import socket
import sys
import threading
import traceback
from collections.abc import Callable, Iterator
from multiprocessing.connection import wait
from typing import Any

import attrs

from evoframe.streams import make_unfailing
from evoframe.workers.channel import Channel

if sys.platform == "linux":
    import fcntl

__all__ = [
    "Begun",
    "Failed",
    "Ready",
    "Report",
    "Result",
    "Start",
    "begin",
    "is_preparing",
    "main",
    "report",
    "serve",
    "stop_requested",
]


@attrs.frozen
class Start:
    """First message to a worker: its preparation.

    Attributes:
        program: Description of the main program, from :mod:`multiprocessing.spawn`.
        initializer: Function to call before the first task.
        initargs: Its arguments.
    """

    program: dict[str, Any]
    initializer: Callable[..., object] | None
    initargs: tuple[Any, ...]


@attrs.frozen
class Ready:
    """Answer of a worker that is prepared."""


@attrs.frozen
class Failed:
    """Answer of a worker that cannot be prepared; it ends.

    Attributes:
        cause: Type and text of the exception.
    """

    cause: str


@attrs.frozen
class Begun:
    """Message that a task is loaded: from now on, the end of its worker can be its own fault."""


@attrs.frozen
class Report:
    """Message of a task in progress.

    Attributes:
        value: Value for the callback of the task.
    """

    value: Any


@attrs.frozen
class Result:
    """Answer to a task.

    Attributes:
        value: The value that the function returned.
        error: The exception that it raised instead.
    """

    value: Any = None
    error: BaseException | None = None


@attrs.define
class _State:
    """State of this process, if it is a worker.

    Attributes:
        channel: Connection to the process that started it.
        stop: File descriptor that becomes readable when a stop is requested.
        preparing: Whether the main program is being imported.
    """

    channel: Channel | None = None
    stop: int = -1
    preparing: bool = False


_state = _State()


def begin() -> None:
    """Report that the task in progress, which begins itself, is loaded."""
    _parent().send(Begun())


def report(value: object) -> None:
    """Send a value to the process that scheduled the task in progress."""
    _parent().send(Report(value))


def stop_requested() -> bool:
    """Return whether the process that started this worker requested a stop."""
    return _state.stop >= 0 and bool(wait([_state.stop], 0))


def is_preparing() -> bool:
    """Return whether this process is a worker that imports the main program: it must start no others."""
    return _state.preparing


def _parent() -> Channel:
    if _state.channel is None:
        raise RuntimeError("this process is not a worker process")
    return _state.channel


def main(connection: int, stop: int) -> None:
    """Execute tasks until the connection is closed.

    Args:
        connection: File descriptor of the connection. Standard input is a pipe that closes when the parent
            process ends; standard output is where errors go once the worker is prepared.
        stop: File descriptor that becomes readable when a stop is requested.
    """
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # blocked so far; only the parent handles Ctrl-C
    signal.pthread_sigmask(signal.SIG_UNBLOCK, {signal.SIGINT})
    make_unfailing()
    _end_with_parent()
    _state.channel, _state.stop = Channel(socket.socket(fileno=connection)), stop
    with contextlib.suppress(EOFError):  # the pool was closed
        if _prepare(_state.channel):
            serve(_state.channel)


def serve(channel: Channel) -> None:
    """Execute the tasks that arrive."""
    while True:
        packed, begins_itself = channel.receive()
        channel.send_packed(_answer(channel, packed, begins_itself=begins_itself))


def _answer(channel: Channel, packed: bytes, *, begins_itself: bool) -> bytes:
    """Execute a packed task, and return its packed result."""
    try:
        function, arguments = Channel.unpack(packed)  # imports their modules
        if not begins_itself:
            channel.send(Begun())
        return Channel.pack(Result(function(*arguments)))
    except BaseException as error:  # noqa: BLE001 - raised in the process that scheduled the task
        return _packed_error(error)


def _packed_error(error: BaseException) -> bytes:
    """Return the result for an exception; for its text if it cannot be pickled and recreated."""
    try:
        Channel.unpack(packed := Channel.pack(Result(error=error)))
    except Exception:  # noqa: BLE001 - many exceptions cannot be recreated from their arguments
        return Channel.pack(Result(error=RuntimeError(_text(error))))
    return packed


def _prepare(channel: Channel) -> bool:
    """Prepare this process as multiprocessing does, so that tasks find the objects of the main program."""
    try:
        start: Start = channel.receive()
        with _preparing():
            multiprocessing.spawn.prepare(start.program)
        if start.initializer is not None:
            start.initializer(*start.initargs)
    except EOFError:
        raise
    except Exception as error:  # noqa: BLE001 - reported by the process that started this one
        channel.send(Failed(_text(error)))
        return False
    sys.stdout.flush()
    sys.stderr.flush()
    os.dup2(1, 2)  # the start succeeded: errors are no longer collected, but shown
    channel.send(Ready())
    return True


@contextlib.contextmanager
def _preparing() -> Iterator[None]:
    _state.preparing = True
    try:
        yield
    finally:
        _state.preparing = False


def _text(error: BaseException) -> str:
    return "".join(traceback.format_exception_only(error)).strip()


def _end_with_parent() -> None:
    """End this process when its parent process has ended, even during a computation."""
    parent = os.dup(0)
    nothing = os.open(os.devnull, os.O_RDONLY)
    os.dup2(nothing, 0)
    os.close(nothing)
    if sys.platform == "linux":  # the kernel ends the worker even if a simulator holds the GIL
        fcntl.fcntl(parent, fcntl.F_SETOWN, os.getpid())
        fcntl.fcntl(parent, fcntl.F_SETFL, fcntl.fcntl(parent, fcntl.F_GETFL) | os.O_ASYNC)
    threading.Thread(target=_end_after, args=[parent], daemon=True).start()


def _end_after(parent: int) -> None:
    wait([parent])
    os._exit(1)
