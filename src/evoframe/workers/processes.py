"""Processes that work for this one: they end with it, and it notices whenever one of them does."""

from __future__ import annotations

import contextlib
import multiprocessing
import os
import signal
import sys
import threading
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Future, InvalidStateError
from concurrent.futures.process import BrokenProcessPool
from multiprocessing.connection import wait
from multiprocessing.context import SpawnContext, SpawnProcess
from typing import Any, TypeVar

import pebble

if sys.platform == "linux":
    import fcntl

__all__ = ["WorkerProcesses"]

R = TypeVar("R")

_SILENT = 256  # stands for an exit code of 0, which pebble would take for the end of a worker's work


class _Process(SpawnProcess):
    """A process of which nobody expects that it ends by itself."""

    @property
    def exitcode(self) -> int | None:
        return _SILENT if super().exitcode == 0 else super().exitcode


class _Spawning(SpawnContext):
    """Starts processes afresh: a copy of this process would have its locks."""

    Process = _Process


class WorkerProcesses:
    """Workers; their processes start with the first order, and do not hear Ctrl-C.

    What becomes of an order that has no result: :class:`TimeoutError` if it took too long and its worker was
    ended; :class:`pebble.ProcessExpired` if its worker ended by itself, see :meth:`ending`;
    :class:`concurrent.futures.process.BrokenProcessPool` if there are no workers.

    Args:
        workers: How many.
        initializer: Called in each process before its first order.
        initargs: Its arguments, which may be locks and queues of :attr:`context`.
    """

    context = _Spawning()

    def __init__(
        self, workers: int, initializer: Callable[..., object] | None = None, initargs: Sequence[Any] = ()
    ) -> None:
        self._outstanding: set[Future[Any]] = set()
        self._pool = pebble.ProcessPool(
            workers, initializer=_begin, initargs=[initializer, *initargs], context=self.context
        )

    @property
    def active(self) -> bool:
        """Whether there are workers, or will be."""
        return self._pool.active

    def schedule(
        self, function: Callable[..., R], arguments: Sequence[Any], time_limit: float | None = None
    ) -> Future[R]:
        """Let a worker call a function.

        Args:
            function: Can be imported by its name.
            arguments: Its arguments.
            time_limit: Seconds after which the worker is ended.
        """
        with _interrupts_held_back():  # processes inherit that; Ctrl-C is for the one that a person started
            future = self._pool.schedule(function, arguments, timeout=time_limit)
        self._outstanding.add(future)
        future.add_done_callback(self._outstanding.discard)
        return future

    def close(self) -> None:
        """End the workers, whatever they are doing; orders without a result have lost theirs."""
        self._pool.stop()  # type: ignore[no-untyped-call]
        self._pool.join()
        for future in list(self._outstanding):
            with contextlib.suppress(InvalidStateError):  # done
                future.set_exception(BrokenProcessPool())  # pebble forgets what it has not yet sent

    @staticmethod
    def ending(error: pebble.ProcessExpired) -> str:
        """Return what a worker ended with, in words."""
        code = error.exitcode
        if code >= 0:
            return f"exit code {0 if code == _SILENT else code}"
        return f"the signal {signal.Signals(-code).name}"


@contextlib.contextmanager
def _interrupts_held_back() -> Iterator[None]:
    """Let no Ctrl-C come to this thread for a moment, where threads can have that."""
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    previous = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, previous)


def _begin(initializer: Callable[..., object] | None, *initargs: Any) -> None:
    _end_with_parent()
    if initializer is not None:
        initializer(*initargs)


def _end_with_parent() -> None:
    """Let this worker process end when the one that started it is gone, whatever it is doing."""
    parent = multiprocessing.parent_process()
    if parent is None:
        raise RuntimeError("this is no worker process")
    if sys.platform == "linux":  # the kernel ends it even where a simulator keeps Python's lock
        fcntl.fcntl(parent.sentinel, fcntl.F_SETOWN, os.getpid())
        flags = fcntl.fcntl(parent.sentinel, fcntl.F_GETFL)
        fcntl.fcntl(parent.sentinel, fcntl.F_SETFL, flags | os.O_ASYNC)
    threading.Thread(target=_end_after, args=[parent.sentinel], daemon=True).start()


def _end_after(sentinel: int) -> None:
    wait([sentinel])
    os._exit(1)
