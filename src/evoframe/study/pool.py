"""Worker processes that execute the runs of a study, each one run at a time."""

from __future__ import annotations

from collections.abc import Iterator
from concurrent.futures import Future
from concurrent.futures.process import BrokenProcessPool
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Literal, TypeAlias

import attrs
import pebble

from evoframe.errors import LockedError
from evoframe.messages import cause_of
from evoframe.study.worker import Channel, Order, perform
from evoframe.workers import WorkerProcesses

__all__ = ["End", "News", "Pool", "end_of"]

News: TypeAlias = tuple[Path, int, float | None]
"""Directory, latest turn, best score so far."""


@attrs.frozen
class End:
    """Outcome of a worker's order.

    Attributes:
        state: ``finished``; ``stopped`` on request; ``elsewhere`` if another process executes the run;
            ``failed``.
        cause: Cause of the failure.
        score: Score of the best pair of a finished run.
    """

    state: Literal["finished", "stopped", "elsewhere", "failed"]
    cause: str = ""
    score: float | None = None


class Pool:
    """Worker processes of a study.

    Workers and this process share no lock: a worker killed while holding it would block all others.

    Attributes:
        workers: Number of workers.
    """

    def __init__(self, workers: int) -> None:
        self.workers = workers
        context = WorkerProcesses.context
        self._news, self._sender = context.Pipe(duplex=False)
        self._requested, self._stop = context.Pipe(duplex=False)
        self._orders: list[Order] = []
        self._processes = self._start_workers()

    def start(self, order: Order) -> Future[End]:
        """Queue a run for the next free worker."""
        if not self._processes.active:  # all workers were lost at once
            self._processes.close()
            self._processes = self._start_workers()
        self._orders.append(order)
        return self._processes.schedule(_work, [len(self._orders) - 1, order])

    def _start_workers(self) -> WorkerProcesses:
        return WorkerProcesses(self.workers, _initialize, [self._sender, self._requested])

    def news(self) -> Iterator[News]:
        """Yield the progress that the workers have sent since the last call."""
        while self._news.poll():
            number, turn, best = self._news.recv()
            yield self._orders[number].directory, turn, best

    def request_stop(self) -> None:
        """Request all workers to stop after the turn in progress."""
        if not self._stop.closed:
            self._stop.send(None)  # no worker receives it, so that poll() is true in all of them
            self._stop.close()

    def close(self) -> None:
        """Terminate the workers, also in the middle of a turn; saved turns are kept."""
        self._processes.close()
        for end in (self._news, self._sender, self._requested, self._stop):
            end.close()


def end_of(future: Future[End]) -> End:
    """Return the outcome of an order, also if its worker process was lost."""
    try:
        return future.result()
    except pebble.ProcessExpired as error:
        return End("failed", f"its process ended with {WorkerProcesses.ending(error)}")
    except BrokenProcessPool:
        return End("failed", "no worker process left: all of them ended, or none could be started")


_ends: list[tuple[Connection, Connection]] = []
"""Ends of a worker's pipes: the first sends progress, the second receives the request to stop."""


def _initialize(sender: Connection, requested: Connection) -> None:
    _ends.append((sender, requested))


def _channel(number: int) -> Channel:
    """Return the worker's channel for an order.

    All workers write to one pipe: a message this short is written atomically.
    """
    sender, requested = _ends[0]
    return Channel(lambda turn, best: sender.send((number, turn, best)), requested.poll)


def _work(number: int, order: Order) -> End:
    try:
        run = perform(order, _channel(number))
        return End("stopped") if run is None else End("finished", score=run.summary()["best_pair_score"])
    except LockedError:
        return End("elsewhere")
    except Exception as error:  # noqa: BLE001 - a failure, with its cause, must not stop the other runs
        return End("failed", cause_of(error))
