"""Ways to spread simulations over the cores of this computer: ``serial`` and ``threads``."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Mapping, Sequence
from concurrent.futures import FIRST_EXCEPTION, Future, ThreadPoolExecutor, wait
from typing import ClassVar, TypeVar

import attrs
from attrs import validators

from evoframe import Executor, ExecutorRun, hookimpl

__all__ = ["Serial", "Threads"]

T = TypeVar("T")
R = TypeVar("R")


@hookimpl
def evoframe_executors() -> Mapping[str, type[Executor]]:
    """Offer executors that need nothing but this computer."""
    return {"serial": Serial, "threads": Threads}


@attrs.frozen
class Serial:
    """One item after the other, in the thread that asks."""

    def start(self) -> ExecutorRun:
        """Return the one worker."""
        return _InThisThread()


@attrs.frozen
class Threads:
    """Threads of this process; they run at once where a simulator lets go of Python's lock, as ``vox`` does.

    Attributes:
        workers: Number of threads, at most 1024; 0 takes one for each core that this process may use.
    """

    workers: int = attrs.field(default=0, validator=[validators.ge(0), validators.le(1024)])

    def start(self) -> ExecutorRun:
        """Make the threads ready; a single worker needs none."""
        workers = self.workers or _available_cores()
        return _InThreads(workers) if workers > 1 else _InThisThread()


class _InThisThread:
    """The worker of ``serial``."""

    workers: ClassVar[int] = 1

    def map(self, function: Callable[[T], R], items: Iterable[T]) -> list[R]:
        return [function(item) for item in items]

    def close(self) -> None:
        pass


class _InThreads:
    """The workers of ``threads``."""

    def __init__(self, workers: int) -> None:
        self.workers = workers
        self._pool = ThreadPoolExecutor(workers, thread_name_prefix="evoframe")

    def map(self, function: Callable[[T], R], items: Iterable[T]) -> list[R]:
        futures = [self._pool.submit(function, item) for item in list(items)]
        try:
            wait(futures, return_when=FIRST_EXCEPTION)
            # What stands before a failed item is finished: its own failure is the one that is raised, as if
            # the items had been worked on one by one.
            _drop(futures[_first_failed(futures) :])
            return [future.result() for future in futures]
        finally:
            _drop(futures)
            wait(futures)  # nothing goes on behind the caller's back

    def close(self) -> None:
        self._pool.shutdown(cancel_futures=True)


def _first_failed(futures: Sequence[Future[R]]) -> int:
    """Return the position of the first item known to have failed, or the end."""
    failed = (i for i, future in enumerate(futures) if future.done() and future.exception() is not None)
    return next(failed, len(futures))


def _drop(futures: Iterable[Future[R]]) -> None:
    """Take back what no worker has begun."""
    for future in futures:
        future.cancel()


def _available_cores() -> int:
    """Return the number of cores that this process may use, which a container or a job may have limited."""
    process_cpu_count: Callable[[], int | None] | None = getattr(os, "process_cpu_count", None)
    if process_cpu_count is not None:  # Python 3.13 and later
        return process_cpu_count() or 1
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1
