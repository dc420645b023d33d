"""Worker processes, which end with their parent process; the end of a worker is always detected."""

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

from evoframe.streams import make_unfailing

if sys.platform == "linux":
    import fcntl

__all__ = ["WorkerProcesses"]

R = TypeVar("R")

_SILENT = 256  # instead of the exit code 0, which pebble would treat as a normal end


class _Process(SpawnProcess):
    """A process that is not expected to end by itself."""

    @property
    def exitcode(self) -> int | None:
        return _SILENT if super().exitcode == 0 else super().exitcode


class _Spawning(SpawnContext):
    """A context that spawns processes: a forked process would inherit locks."""

    Process = _Process


class WorkerProcesses:
    """A pool of worker processes, which start with the first task and ignore Ctrl-C.

    A task without a result raises :class:`TimeoutError` if it exceeded its time limit and its worker was
    stopped; :class:`pebble.ProcessExpired` if its worker ended by itself, see :meth:`ending`; and
    :class:`concurrent.futures.process.BrokenProcessPool` if the pool was closed or could not start workers.

    Args:
        workers: Number of processes.
        initializer: Function that each process calls before its first task.
        initargs: Arguments of *initializer*, which may be locks and queues of :attr:`context`.
    """

    context = _Spawning()

    def __init__(
        self, workers: int, initializer: Callable[..., object] | None = None, initargs: Sequence[Any] = ()
    ) -> None:
        self._outstanding: set[Future[Any]] = set()
        self._pool = pebble.ProcessPool(
            workers, initializer=_initialize, initargs=[initializer, *initargs], context=self.context
        )

    @property
    def active(self) -> bool:
        """True if the pool accepts tasks."""
        return self._pool.active

    def schedule(
        self, function: Callable[..., R], arguments: Sequence[Any], time_limit: float | None = None
    ) -> Future[R]:
        """Schedule the call of a function in a worker.

        Args:
            function: A function that can be imported by name.
            arguments: Arguments of the function.
            time_limit: Time after which the worker is stopped, s.
        """
        with _sigint_blocked():  # inherited by new processes: only the parent handles Ctrl-C
            future = self._pool.schedule(function, arguments, timeout=time_limit)
        self._outstanding.add(future)
        future.add_done_callback(self._outstanding.discard)
        return future

    def close(self) -> None:
        """Stop the workers immediately; tasks without a result raise BrokenProcessPool."""
        self._pool.stop()  # type: ignore[no-untyped-call]
        self._pool.join()
        for future in list(self._outstanding):
            with contextlib.suppress(InvalidStateError):  # done
                future.set_exception(BrokenProcessPool())  # pebble drops tasks that it has not sent

    @staticmethod
    def ending(error: pebble.ProcessExpired) -> str:
        """Return the exit code or signal that ended a worker, as text."""
        code = error.exitcode
        if code >= 0:
            return f"exit code {0 if code == _SILENT else code}"
        return f"the signal {signal.Signals(-code).name}"


@contextlib.contextmanager
def _sigint_blocked() -> Iterator[None]:
    """Block SIGINT in this thread, if the platform supports it."""
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    previous = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, previous)


def _initialize(initializer: Callable[..., object] | None, *initargs: Any) -> None:
    _end_with_parent()
    make_unfailing()
    if initializer is not None:
        initializer(*initargs)


def _end_with_parent() -> None:
    """End this worker process when its parent process has ended, even during a computation."""
    parent = multiprocessing.parent_process()
    if parent is None:
        raise RuntimeError("this process is not a worker process")
    if sys.platform == "linux":  # the kernel ends the worker even if a simulator holds the GIL
        fcntl.fcntl(parent.sentinel, fcntl.F_SETOWN, os.getpid())
        flags = fcntl.fcntl(parent.sentinel, fcntl.F_GETFL)
        fcntl.fcntl(parent.sentinel, fcntl.F_SETFL, flags | os.O_ASYNC)
    threading.Thread(target=_end_after, args=[parent.sentinel], daemon=True).start()


def _end_after(sentinel: int) -> None:
    wait([sentinel])
    os._exit(1)
