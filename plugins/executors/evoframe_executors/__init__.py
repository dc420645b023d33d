"""Ways to spread simulations over the cores of this computer: ``serial`` and ``threads``."""

from __future__ import annotations

import os
import threading
from collections.abc import Callable, Iterable, Mapping, Sequence
from concurrent.futures import FIRST_EXCEPTION, Future, ThreadPoolExecutor, wait
from typing import ClassVar, Generic, TypeVar

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
    """The workers of ``threads``; the last is the thread that asks, as soon as all items are handed out."""

    def __init__(self, workers: int) -> None:
        self.workers = workers
        self._pool = ThreadPoolExecutor(workers - 1, thread_name_prefix="evoframe")

    def map(self, function: Callable[[T], R], items: Iterable[T]) -> list[R]:
        tasks: list[_Task[T, R]] = []
        try:
            self._hand_out(_Watched(function), items, tasks)
            return _results(tasks)
        finally:
            _drop(tasks)
            wait([task.future for task in tasks])  # nothing goes on behind the caller's back

    def _hand_out(self, function: _Watched[T, R], items: Iterable[T], tasks: list[_Task[T, R]]) -> None:
        """Let the threads begin with an item while the next is made; then help, until one has failed."""
        try:
            for item in items:
                tasks.append(_Task(item, self._pool.submit(function, item)))
                if function.failed.is_set():
                    return
        except Exception:
            _results(tasks)  # an item before the one that could not be made may have failed
            raise
        for task in tasks:
            if function.failed.is_set():
                return
            task.take_over(function)

    def close(self) -> None:
        self._pool.shutdown(cancel_futures=True)


class _Watched(Generic[T, R]):
    """A function that remembers whether it has failed."""

    def __init__(self, function: Callable[[T], R]) -> None:
        self.failed = threading.Event()
        self._function = function

    def __call__(self, item: T) -> R:
        try:
            return self._function(item)
        except BaseException:
            self.failed.set()
            raise


@attrs.define
class _Task(Generic[T, R]):
    """An item, and what becomes of it."""

    item: T
    future: Future[R]

    def take_over(self, function: Callable[[T], R]) -> None:
        """Work on the item in this thread, if no other has begun."""
        if self.future.cancel():
            self.future = _worked_on(function, self.item)


def _worked_on(function: Callable[[T], R], item: T) -> Future[R]:
    """Return what comes of an item as a future, as that of an item which a thread has worked on."""
    future: Future[R] = Future()
    try:
        future.set_result(function(item))
    except Exception as error:  # noqa: BLE001 - raised where the results are asked for
        future.set_exception(error)
    return future


def _results(tasks: Sequence[_Task[T, R]]) -> list[R]:
    """Wait for all results, or raise what the first failed item raised.

    What stands before a failed item is finished: its own failure is the one that is raised, as if the items
    had been worked on one by one.
    """
    wait([task.future for task in tasks], return_when=FIRST_EXCEPTION)
    _drop(tasks[_first_failed(tasks) :])
    return [task.future.result() for task in tasks]


def _first_failed(tasks: Sequence[_Task[T, R]]) -> int:
    """Return the position of the first item known to have failed, or the end."""
    done = ((i, task.future) for i, task in enumerate(tasks) if task.future.done())
    return next((i for i, future in done if future.exception() is not None), len(tasks))


def _drop(tasks: Iterable[_Task[T, R]]) -> None:
    """Take back what no worker has begun."""
    for task in tasks:
        task.future.cancel()


def _available_cores() -> int:
    """Return the number of cores that this process may use, which a container or a job may have limited."""
    process_cpu_count: Callable[[], int | None] | None = getattr(os, "process_cpu_count", None)
    if process_cpu_count is not None:  # Python 3.13 and later
        return process_cpu_count() or 1
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1
