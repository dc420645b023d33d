"""Processes that make the runs of a study, one run at a time each."""

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
from evoframe.study.worker import Order, Talk, perform
from evoframe.workers import WorkerProcesses

__all__ = ["End", "News", "Pool", "end_of"]

News: TypeAlias = tuple[Path, int, float | None]
"""Directory, latest turn, best score so far."""


@attrs.frozen
class End:
    """How work on a run ended.

    Attributes:
        state: ``finished``; ``stopped`` on demand; ``elsewhere`` where another process is at it; ``failed``.
        cause: Why it failed.
        score: That of its best pair, if it is finished.
    """

    state: Literal["finished", "stopped", "elsewhere", "failed"]
    cause: str = ""
    score: float | None = None


class Pool:
    """Workers that are ready.

    Workers and this process share no lock: one that is killed while it has it would stop all others.

    Attributes:
        workers: How many there are.
    """

    def __init__(self, workers: int) -> None:
        self.workers = workers
        context = WorkerProcesses.context
        self._news, self._tell = context.Pipe(duplex=False)
        self._asked, self._stop = context.Pipe(duplex=False)
        self._orders: list[Order] = []
        self._processes = self._started()

    def start(self, order: Order) -> Future[End]:
        """Let a worker make a run as soon as one is free."""
        if not self._processes.active:  # all of them were lost at once
            self._processes.close()
            self._processes = self._started()
        self._orders.append(order)
        return self._processes.schedule(_work, [len(self._orders) - 1, order])

    def _started(self) -> WorkerProcesses:
        return WorkerProcesses(self.workers, _begin, [self._tell, self._asked])

    def news(self) -> Iterator[News]:
        """Yield what the workers have told since the last time."""
        while self._news.poll():
            number, turn, best = self._news.recv()
            yield self._orders[number].directory, turn, best

    def ask_to_stop(self) -> None:
        """Let all workers stop after the turn in progress."""
        if not self._stop.closed:
            self._stop.send(None)  # nobody receives it, so everybody sees that there is something
            self._stop.close()

    def close(self) -> None:
        """End the workers, whatever they are doing: what they have saved stays."""
        self._processes.close()
        for end in (self._news, self._tell, self._asked, self._stop):
            end.close()


def end_of(future: Future[End]) -> End:
    """Return how work ended, also where it took its process along."""
    try:
        return future.result()
    except pebble.ProcessExpired as error:
        return End("failed", f"its process ended with {WorkerProcesses.ending(error)}")
    except BrokenProcessPool:
        return End("failed", "there was no process to make it: all of them were ended, or cannot be started")


_ends: list[tuple[Connection, Connection]] = []
"""Of the pipes of this process, if it is a worker: where it tells, and where it is asked to stop."""


def _begin(tell: Connection, asked: Connection) -> None:
    _ends.append((tell, asked))


def _talk(number: int) -> Talk:
    """Return how the worker talks about one of the orders.

    All workers write to one pipe: a message that is so short is written whole or not at all.
    """
    tell, asked = _ends[0]
    return Talk(lambda turn, best: tell.send((number, turn, best)), asked.poll)


def _work(number: int, order: Order) -> End:
    try:
        run = perform(order, _talk(number))
        return End("stopped") if run is None else End("finished", score=run.summary()["best_pair_score"])
    except LockedError:
        return End("elsewhere")
    except Exception as error:  # noqa: BLE001 - the other runs of a study go on, and this one says why not
        return End("failed", cause_of(error))
