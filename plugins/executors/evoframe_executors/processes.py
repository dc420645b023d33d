"""The executor ``processes``."""

from __future__ import annotations

import concurrent.futures
from collections.abc import Callable, Iterable
from concurrent.futures import FIRST_COMPLETED, Future
from typing import Any, Generic, TypeVar

import attrs

from evoframe import ExecutorRun, RunError, WorkerError, WorkerProcesses, available_cores
from evoframe_executors.options import overdue, time_limit, worker_count
from evoframe_executors.worker import Answer, Call, execute, pack, unpack

__all__ = ["Processes"]

T = TypeVar("T")
R = TypeVar("R")

_IN_PROGRESS = 2  # items per worker: the current one, and the next one


@attrs.frozen
class Processes:
    """Separate processes; they can be terminated if they hang, and a crash does not end the run.

    If a worker ends, at any moment, it is replaced and its batch is repeated. If five workers crash during
    the same batch, or 20 are killed, the run stops. A batch that exceeds the time limit is repeated once.
    Simulators and objectives must come from installed plugins, since workers import them
    by name.

    Attributes:
        workers: Number of processes, at most 1024; 0 uses one for each core available to this process.
        batch_time_limit: Time after which a worker that is still busy with a batch is terminated, s; no limit
            by default. A worker's first batch includes the import of the simulator, so choose a much larger
            limit than that takes.
    """

    workers: int = worker_count()
    batch_time_limit: float | None = time_limit()

    def start(self) -> ExecutorRun:
        """Return the workers; their processes start with the first item."""
        return _ProcessWorkers(self.workers or available_cores(), self.batch_time_limit)


@attrs.frozen(eq=False)
class _Task(Generic[T]):
    """An item, the call for a worker, and the future answer."""

    item: T
    call: Call
    future: Future[Answer]

    def has_failed(self) -> bool:
        """Return whether the function raised an exception; ``False`` if it exceeded the time limit."""
        return self.future.exception() is None and not self.future.result().succeeded


class _ProcessWorkers:
    """The workers of ``processes``."""

    def __init__(self, workers: int, limit: float | None) -> None:
        self.workers = workers
        self._limit = limit
        self._pool = WorkerProcesses(workers)

    def map(self, function: Callable[[T], R], items: Iterable[T]) -> list[R]:
        tasks: list[_Task[T]] = []
        try:
            self._submit(function, items, tasks)
            return [self._result(task) for task in tasks]
        except BaseException:
            self._restart()  # no work continues after map() has returned
            raise

    def close(self) -> None:
        self._pool.close()

    def _submit(self, function: Callable[[T], R], items: Iterable[T], tasks: list[_Task[T]]) -> None:
        """Schedule each item while the generator creates the next, until a task has failed."""
        in_progress: set[_Task[T]] = set()
        try:
            for item in items:
                call = pack(function, item)
                tasks.append(task := _Task(item, call, self._schedule(call)))
                in_progress.add(task)
                done = self._done(in_progress)
                if any(task.has_failed() for task in done):
                    return
                in_progress -= done
        except Exception:
            for task in tasks:
                self._result(task)  # raises if an earlier item has failed
            raise

    def _done(self, in_progress: set[_Task[T]]) -> set[_Task[T]]:
        """Return the finished tasks; wait for at least one if all workers have enough items."""
        if len(in_progress) >= _IN_PROGRESS * self.workers:
            concurrent.futures.wait([task.future for task in in_progress], return_when=FIRST_COMPLETED)
        return {task for task in in_progress if task.future.done()}

    def _result(self, task: _Task[Any]) -> Any:
        """Return the result of a task; repeat it once if it exceeded the time limit."""
        try:
            try:
                answer = task.future.result()
            except TimeoutError:
                answer = self._schedule(task.call).result()
        except TimeoutError as error:
            raise WorkerError(f"{overdue(self._limit)}, twice", task.item) from error
        except WorkerError as error:
            raise WorkerError(error.problem, task.item) from error
        except RunError as error:
            raise RunError(error.problem, key="executor") from error
        return unpack(answer)

    def _schedule(self, call: Call) -> Future[Answer]:
        if not self._pool.active:  # it could not start workers
            self._restart()
        try:
            return self._pool.schedule(execute, [call], self._limit)
        except RunError as error:  # no more threads or files
            raise RunError(error.problem, key="executor") from error

    def _restart(self) -> None:
        self.close()
        self._pool = WorkerProcesses(self.workers)
