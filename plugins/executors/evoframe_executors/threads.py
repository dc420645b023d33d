"""The executor ``threads``."""

from __future__ import annotations

import concurrent.futures
import math
import queue
import threading
import time
from collections.abc import Callable, Iterable
from concurrent.futures import CancelledError, Future
from typing import Any, Generic, TypeAlias, TypeVar

import attrs

from evoframe import ExecutorRun, WorkerError, available_cores
from evoframe_executors.options import overdue, time_limit, worker_count
from evoframe_executors.serial import InThisThread

__all__ = ["Threads"]

T = TypeVar("T")
R = TypeVar("R")


@attrs.frozen
class Threads:
    """Threads of this process; they run at once where a simulator lets go of Python's lock, as ``vox`` does.

    A thread cannot be ended from outside. One that takes too long is left alone, and the run stops; one that
    keeps Python's lock all the while is not even noticed. ``processes`` can end both.

    Attributes:
        workers: Number of threads, at most 1024; 0 takes one for each core that this process may use.
        batch_time_limit: Seconds after which a batch of simulations counts as lost, and the run stops. Take
            far more than a batch needs on a busy computer.
    """

    workers: int = worker_count()
    batch_time_limit: float | None = time_limit()

    def start(self) -> ExecutorRun:
        """Make the threads ready; a single worker without a time limit needs none."""
        workers = self.workers or available_cores()
        if workers == 1 and self.batch_time_limit is None:
            return InThisThread()
        return _InThreads(workers, self.batch_time_limit)


class _InThreads:
    """The workers of ``threads``.

    Without a time limit the last is the thread that asks, as soon as all items are handed out; with one it
    watches the others.
    """

    def __init__(self, workers: int, limit: float | None) -> None:
        self.workers = workers
        self._limit = limit
        self._pool = self._new_pool()

    def map(self, function: Callable[[T], R], items: Iterable[T]) -> list[R]:
        if self._pool.abandoned:
            self._pool = self._new_pool()
        tasks: list[_Task[T, R]] = []
        try:
            self._hand_out(_Watched(function), items, tasks)
            return [self._result(task) for task in tasks]
        except (KeyboardInterrupt, SystemExit):
            self._pool.abandoned = True  # whoever wants to leave now does not wait for the others
            raise
        finally:
            for task in tasks:
                task.future.cancel()  # what no thread has begun
            if not self._pool.abandoned:
                # Nothing goes on behind the caller's back.
                concurrent.futures.wait([task.future for task in tasks])

    def _hand_out(self, function: _Watched[T, R], items: Iterable[T], tasks: list[_Task[T, R]]) -> None:
        """Let the threads begin with an item while the next is made; then help, until one has failed."""
        try:
            for item in items:
                task: _Task[T, R] = _Task(item)
                tasks.append(task)
                self._pool.give(task, function)
                if function.failed.is_set():
                    return
        except Exception:
            for task in tasks:
                self._result(task)  # an item before the one that could not be made may have failed
            raise
        if self._limit is None:
            for task in tasks:
                task.work(function)
                task.pass_interrupt_on()

    def _new_pool(self) -> _Pool:
        return _Pool(self.workers - 1 if self._limit is None else self.workers)

    def _result(self, task: _Task[T, R]) -> R:
        """Return the result of a task whose predecessors are done, so that a thread begins it if none has."""
        if self._limit is not None:
            task.begun.wait()
            done, _ = concurrent.futures.wait([task.future], max(0.0, task.since + self._limit - _now()))
            if not done:
                self._pool.abandoned = True
                raise WorkerError(overdue(self._limit), task.item)
        return task.future.result()

    def close(self) -> None:
        self._pool.close()


_now = time.monotonic


class _Watched(Generic[T, R]):
    """A function that remembers whether it has failed, and then does nothing any more.

    Items are begun in their order: what has not begun when one fails stands after it.
    """

    def __init__(self, function: Callable[[T], R]) -> None:
        self.failed = threading.Event()
        self._function = function

    def __call__(self, item: T) -> R:
        if self.failed.is_set():
            raise CancelledError
        try:
            return self._function(item)
        except BaseException:
            self.failed.set()
            raise


class _Task(Generic[T, R]):
    """An item, when work on it began, and what becomes of it."""

    def __init__(self, item: T) -> None:
        self.item = item
        self.begun = threading.Event()
        self.since = math.inf
        self.future: Future[R] = Future()
        self._lock = threading.Lock()

    def work(self, function: Callable[[T], R]) -> None:
        """Work on the item in this thread, unless another has begun."""
        if not self._begin():
            return
        try:
            result = function(self.item)
        except BaseException as error:  # noqa: BLE001 - raised where the results are asked for
            self.future.set_exception(error)
        else:
            self.future.set_result(result)

    def pass_interrupt_on(self) -> None:
        """Raise now what came of a Ctrl-C while this thread worked on the item."""
        if self.future.done() and isinstance(error := self.future.exception(), KeyboardInterrupt):
            raise error

    def _begin(self) -> bool:
        with self._lock:  # a future's own state raises an error, and logs it, at a second beginning
            if self.begun.is_set() or not self.future.set_running_or_notify_cancel():
                return False
            self.since = _now()
            self.begun.set()
            return True


_Order: TypeAlias = tuple[_Task[Any, Any], Callable[[Any], Any]]


class _Pool:
    """Threads that take tasks in their order.

    Python waits at its end for those of :mod:`concurrent.futures`; these can be abandoned.
    """

    def __init__(self, size: int) -> None:
        self.abandoned = False
        self._orders: queue.SimpleQueue[_Order | None] = queue.SimpleQueue()
        self._threads = [
            threading.Thread(target=self._serve, name=f"evoframe-{i}", daemon=True) for i in range(size)
        ]
        for thread in self._threads:
            thread.start()

    def give(self, task: _Task[T, R], function: Callable[[T], R]) -> None:
        self._orders.put((task, function))

    def close(self) -> None:
        for _ in self._threads:
            self._orders.put(None)
        if not self.abandoned:
            for thread in self._threads:
                thread.join()

    def _serve(self) -> None:
        while (order := self._orders.get()) is not None:
            task, function = order
            task.work(function)
