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
    """Threads of this process; they run in parallel if the simulator releases the GIL, as ``vox`` does.

    Threads cannot be terminated. If one exceeds the time limit, the run stops and abandons it; if one never
    releases the GIL, the time limit has no effect. The executor ``processes`` terminates its workers in both
    cases.

    Attributes:
        workers: Number of threads, at most 1024; 0 uses one for each core available to this process.
        batch_time_limit: Time after which an unfinished batch counts as lost and the run stops, s; no limit
            by default. Choose a much larger limit than a batch takes on a busy computer.
    """

    workers: int = worker_count()
    batch_time_limit: float | None = time_limit()

    def start(self) -> ExecutorRun:
        """Start the threads; a single worker without a time limit needs none."""
        workers = self.workers or available_cores()
        if workers == 1 and self.batch_time_limit is None:
            return InThisThread()
        return _ThreadWorkers(workers, self.batch_time_limit)


class _ThreadWorkers:
    """The workers of ``threads``.

    Without a time limit, the calling thread is the last worker, once all items are submitted; with a time
    limit, it monitors the others.
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
            self._submit(batch, items)
            return [self._result(task) for task in batch.tasks]
        except (KeyboardInterrupt, SystemExit):
            self._pool.abandoned = True  # exit without waiting for the other threads
            raise
        finally:
            for task in batch.tasks:
                task.future.cancel()  # unless a thread has started it
            if not self._pool.abandoned:
                # No work continues after map() has returned.
                concurrent.futures.wait([task.future for task in batch.tasks])

    def _submit(self, batch: _Batch[T, R], items: Iterable[T]) -> None:
        """Submit each item while the generator creates the next; then help, until a task has failed."""
        try:
            for item in items:
                self._pool.submit(batch.add(item))
                if batch.failed < math.inf:
                    return
        except Exception:
            for task in batch.tasks:
                self._result(task)  # raises if an earlier item has failed
            raise
        if self._limit is None:
            self._pool.help()

    def _new_pool(self) -> _Pool:
        return _Pool(self.workers - 1 if self._limit is None else self.workers)

    def _result(self, task: _Task[T, R]) -> R:
        """Return the result of a task whose predecessors are done, so that a thread will start it."""
        if self._limit is not None:
            task.started.wait()
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
        self.failed = math.inf  # the first place of a failed task; tasks after it are not started

    def add(self, item: T) -> _Task[T, R]:
        task = _Task(self, len(self.tasks), item)
        self.tasks.append(task)
        return task


class _Task(Generic[T, R]):
    """An item, the start time of its processing, and its result."""

    def __init__(self, batch: _Batch[T, R], place: int, item: T) -> None:
        self.item = item
        self.started = threading.Event()
        self.since = math.inf
        self.future: Future[R] = Future()
        self._batch = batch
        self._place = place

    def work(self) -> None:
        """Process the item in this thread, unless the task was canceled or an earlier one has failed.

        Raises:
            KeyboardInterrupt: The function raised it; the future contains it too.
        """
        if self._batch.failed < self._place:
            self.future.cancel()
        if not self.future.set_running_or_notify_cancel():
            return
        self.since = time.monotonic()
        self.started.set()
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
    """Threads that take tasks in order.

    They can be abandoned, unlike the threads of :mod:`concurrent.futures`, for which Python waits at exit.
    """

    def __init__(self, size: int) -> None:
        self.abandoned = False
        self._tasks: queue.SimpleQueue[_Task[Any, Any] | None] = queue.SimpleQueue()
        self._threads = [
            threading.Thread(target=self._serve, name=f"evoframe-{i}", daemon=True) for i in range(size)
        ]
        for thread in self._threads:
            thread.start()

    def submit(self, task: _Task[Any, Any]) -> None:
        self._tasks.put(task)

    def help(self) -> None:
        """Process tasks in this thread too, until all tasks have started or Ctrl-C is pressed."""
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
            with contextlib.suppress(KeyboardInterrupt):  # the calling thread handles it
                task.work()
