"""Processes that make the runs of a study, one run at a time each."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from concurrent.futures import Future
from concurrent.futures.process import BrokenProcessPool
from multiprocessing.queues import SimpleQueue
from typing import Any, Literal, TypeAlias

import attrs
import pebble

from evoframe.errors import EvoframeError, LockedError
from evoframe.processes import WorkerProcesses
from evoframe.study.worker import Order, Talk, perform

__all__ = ["End", "News", "Pool", "end_of"]

News: TypeAlias = tuple[str, int, float | None]
"""Directory, latest turn, best score so far."""


@attrs.frozen
class End:
    """How work on a run ended.

    Attributes:
        state: ``finished``; ``stopped`` on demand; ``elsewhere`` where another process is at it; ``failed``.
        cause: Why it failed.
    """

    state: Literal["finished", "stopped", "elsewhere", "failed"]
    cause: str = ""


class Pool:
    """Workers that are ready."""

    def __init__(self, workers: int) -> None:
        context = WorkerProcesses.context
        self._news: SimpleQueue[News] = context.SimpleQueue()
        self._stop = context.Event()
        self._workers = workers
        self._processes = self._started()

    def start(self, order: Order) -> Future[End]:
        """Let a worker make a run as soon as one is free."""
        if not self._processes.active:  # all of them were lost at once
            self._processes.close()
            self._processes = self._started()
        return self._processes.schedule(_work, [order])

    def _started(self) -> WorkerProcesses:
        return WorkerProcesses(self._workers, _begin, [self._news, self._stop])

    def news(self) -> Iterator[News]:
        """Yield what the workers have told since the last time."""
        while not self._news.empty():
            yield self._news.get()

    def ask_to_stop(self) -> None:
        """Let all workers stop after the turn in progress."""
        self._stop.set()

    def close(self) -> None:
        """End the workers, whatever they are doing: what they have saved stays."""
        self._processes.close()


def end_of(future: Future[End]) -> End:
    """Return how work ended, also where it took its process along."""
    try:
        return future.result()
    except pebble.ProcessExpired as error:
        return End("failed", f"its process ended with {WorkerProcesses.ending(error)}")
    except BrokenProcessPool:
        return End("failed", "there was no process to make it: all of them were ended, or cannot be started")


_talk: list[Talk] = []
"""Of this process, if it is a worker: set once, before its first run."""


def _begin(news: Any, stop: Any) -> None:
    tell: Callable[[News], None] = news.put
    _talk.append(Talk(tell, stop.is_set))


def _work(order: Order) -> End:
    try:
        return End("finished" if perform(order, _talk[0]) else "stopped")
    except LockedError:
        return End("elsewhere")
    except EvoframeError as error:
        return End("failed", str(error))
    except Exception as error:  # noqa: BLE001 - the other runs of a study go on, and this one says why not
        return End("failed", f"{type(error).__name__}: {error}")
