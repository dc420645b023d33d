"""The executor ``processes``."""

from __future__ import annotations

import concurrent.futures
from collections.abc import Callable, Iterable
from concurrent.futures import FIRST_COMPLETED, Future, TimeoutError as TookTooLong
from concurrent.futures.process import BrokenProcessPool
from typing import Any, Generic, TypeVar

import attrs
import pebble

from evoframe import ExecutorRun, RunError, WorkerError, WorkerProcesses, available_cores
from evoframe_executors.options import overdue, time_limit, worker_count
from evoframe_executors.worker import Answer, answered, packed, unpacked

__all__ = ["Processes"]

T = TypeVar("T")
R = TypeVar("R")

_IN_HAND = 2  # items for each worker: one that it works on, and one that it finds when it is done
_LOST = (TookTooLong, pebble.ProcessExpired, BrokenProcessPool)


@attrs.frozen
class Processes:
    """Processes of their own, which can be ended when they hang, and may crash without harm to the run.

    What a worker was doing that had to be ended, or that crashed, is done once more; if that fails as well,
    the run stops. Simulators and objectives must come from installed plugins, since workers import them by
    name.

    Attributes:
        workers: Number of processes, at most 1024; 0 takes one for each core that this process may use.
        batch_time_limit: Seconds after which a batch of simulations is given up and its worker ended. The
            first batch of a worker includes the import of the simulator: take far more than that needs.
    """

    workers: int = worker_count()
    batch_time_limit: float | None = time_limit()

    def start(self) -> ExecutorRun:
        """Return the workers; their processes start with the first item."""
        return _InProcesses(self.workers or available_cores(), self.batch_time_limit)


@attrs.frozen(eq=False)
class _Task(Generic[T]):
    """An item, the parcel that it makes together with its function, and what becomes of that."""

    item: T
    parcel: bytes
    future: Future[Answer]

    def has_failed(self) -> bool:
        """Return whether the function raised something; where a worker was lost there is a second attempt."""
        return self.future.exception() is None and not self.future.result().succeeded


class _InProcesses:
    """The workers of ``processes``."""

    def __init__(self, workers: int, limit: float | None) -> None:
        self.workers = workers
        self._limit = limit
        self._pool = WorkerProcesses(workers)

    def map(self, function: Callable[[T], R], items: Iterable[T]) -> list[R]:
        tasks: list[_Task[T]] = []
        try:
            self._hand_out(function, items, tasks)
            return [self._result(task) for task in tasks]
        except BaseException:
            self._renew()  # nothing goes on behind the caller's back
            raise

    def close(self) -> None:
        self._pool.close()

    def _hand_out(self, function: Callable[[T], R], items: Iterable[T], tasks: list[_Task[T]]) -> None:
        """Let the workers begin with an item while the next are made, until one has failed."""
        in_hand: set[_Task[T]] = set()
        try:
            for item in items:
                parcel = packed(function, item)
                tasks.append(task := _Task(item, parcel, self._schedule(parcel)))
                in_hand.add(task)
                done = self._done(in_hand)
                if any(task.has_failed() for task in done):
                    return
                in_hand -= done
        except Exception:
            for task in tasks:
                self._result(task)  # an item before the one that could not be made may have failed
            raise

    def _done(self, in_hand: set[_Task[T]]) -> set[_Task[T]]:
        """Return the tasks that are done: at least one, if the workers have all that they can take."""
        if len(in_hand) >= _IN_HAND * self.workers:
            concurrent.futures.wait([task.future for task in in_hand], return_when=FIRST_COMPLETED)
        return {task for task in in_hand if task.future.done()}

    def _result(self, task: _Task[Any]) -> Any:
        """Return the result of a task; of a second attempt, if its worker was lost."""
        try:
            answer = task.future.result()
        except _LOST:
            answer = self._second_attempt(task)
        return unpacked(answer)

    def _second_attempt(self, task: _Task[T]) -> Answer:
        try:
            return self._schedule(task.parcel).result()
        except TookTooLong as error:
            raise WorkerError(f"{overdue(self._limit)}, twice", task.item) from error
        except pebble.ProcessExpired as error:
            raise WorkerError(
                f"ended its process with {WorkerProcesses.ending(error)}, twice", task.item
            ) from error
        except BrokenProcessPool as error:
            raise RunError(
                "processes to work in cannot be started, or end at once; a program that uses them does so "
                "below \"if __name__ == '__main__':\", since they import it"
            ) from error

    def _schedule(self, parcel: bytes) -> Future[Answer]:
        if not self._pool.active:  # all of its processes were lost
            self._renew()
        return self._pool.schedule(answered, [parcel], self._limit)

    def _renew(self) -> None:
        self.close()
        self._pool = WorkerProcesses(self.workers)
