"""The executor ``threads``."""

from __future__ import annotations

import concurrent.futures
import contextlib
import math
import queue
import threading
import time
from collections.abc import Callable, Iterable
from concurrent.futures import Future
from typing import Any, Generic, TypeVar

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
        batch = _Batch(function)
        try:
            self._hand_out(batch, items)
            return [self._result(task) for task in batch.tasks]
        except (KeyboardInterrupt, SystemExit):
            self._pool.abandoned = True  # whoever wants to leave now does not wait for the others
            raise
        finally:
            for task in batch.tasks:
                task.future.cancel()  # unless a thread has begun it
            if not self._pool.abandoned:
                # Nothing goes on behind the caller's back.
                concurrent.futures.wait([task.future for task in batch.tasks])

    def _hand_out(self, batch: _Batch[T, R], items: Iterable[T]) -> None:
        """Let the threads begin with an item while the next is made; then help, until one has failed."""
        try:
            for item in items:
                self._pool.give(batch.add(item))
                if batch.failed < math.inf:
                    return
        except Exception:
            for task in batch.tasks:
                self._result(task)  # an item before the one that could not be made may have failed
            raise
        if self._limit is None:
            self._pool.help()

    def _new_pool(self) -> _Pool:
        return _Pool(self.workers - 1 if self._limit is None else self.workers)

    def _result(self, task: _Task[T, R]) -> R:
        """Return the result of a task whose predecessors are done, so that a thread begins it if none has."""
        if self._limit is not None:
            task.begun.wait()
            done, _ = concurrent.futures.wait(
                [task.future], max(0.0, task.since + self._limit - time.monotonic())
            )
            if not done:
                self._pool.abandoned = True
                raise WorkerError(overdue(self._limit), task.item)
        return task.future.result()

    def close(self) -> None:
        self._pool.close()


class _Batch(Generic[T, R]):
    """The tasks of one call, in the order of their items."""

    def __init__(self, function: Callable[[T], R]) -> None:
        self.function = function
        self.tasks: list[_Task[T, R]] = []
        self.failed = math.inf  # the place of a task that has failed; those behind it need not begin

    def add(self, item: T) -> _Task[T, R]:
        task = _Task(self, len(self.tasks), item)
        self.tasks.append(task)
        return task


class _Task(Generic[T, R]):
    """An item, when work on it began, and its result."""

    def __init__(self, batch: _Batch[T, R], place: int, item: T) -> None:
        self.item = item
        self.begun = threading.Event()
        self.since = math.inf
        self.future: Future[R] = Future()
        self._batch = batch
        self._place = place

    def work(self) -> None:
        """Work on the item in this thread, unless it is no longer wanted.

        Raises:
            KeyboardInterrupt: So did the work; the future has it too.
        """
        if self._batch.failed < self._place:
            self.future.cancel()
        if not self.future.set_running_or_notify_cancel():
            return
        self.since = time.monotonic()
        self.begun.set()
        try:
            result = self._batch.function(self.item)
        except BaseException as error:
            self._batch.failed = min(self._batch.failed, self._place)
            self.future.set_exception(error)
            if isinstance(error, KeyboardInterrupt):
                raise
        else:
            self.future.set_result(result)


class _Pool:
    """Threads that take tasks in their order.

    Python waits at its end for those of :mod:`concurrent.futures`; these can be abandoned.
    """

    def __init__(self, size: int) -> None:
        self.abandoned = False
        self._tasks: queue.SimpleQueue[_Task[Any, Any] | None] = queue.SimpleQueue()
        self._threads = [
            threading.Thread(target=self._serve, name=f"evoframe-{i}", daemon=True) for i in range(size)
        ]
        for thread in self._threads:
            thread.start()

    def give(self, task: _Task[Any, Any]) -> None:
        self._tasks.put(task)

    def help(self) -> None:
        """Work in this thread too, until all tasks have begun or a Ctrl-C comes."""
        with contextlib.suppress(queue.Empty):
            while (task := self._tasks.get_nowait()) is not None:
                task.work()

    def close(self) -> None:
        for _ in self._threads:
            self._tasks.put(None)
        if not self.abandoned:
            for thread in self._threads:
                thread.join()

    def _serve(self) -> None:
        while (task := self._tasks.get()) is not None:
            with contextlib.suppress(KeyboardInterrupt):  # is for the thread that asks
                task.work()
