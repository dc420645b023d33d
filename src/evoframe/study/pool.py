"""Worker processes that execute the runs of a study, each one run at a time."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from concurrent.futures import Future
from pathlib import Path
from queue import SimpleQueue
from typing import Literal, TypeAlias

import attrs

from evoframe.errors import LockedError, RunError
from evoframe.messages import cause_of
from evoframe.registry import discover
from evoframe.study.worker import Channel, Order, perform
from evoframe.workers import WorkerProcesses, begin, report, stop_requested

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

    If a worker ends, another one resumes its run. The run fails if five workers crash, or 20 are killed, in a
    row without a turn in between.

    Args:
        modules: Local plugins, which each worker loads before its first run.

    Attributes:
        workers: Number of workers.
    """

    def __init__(self, workers: int, modules: Sequence[str] = ()) -> None:
        self.workers = workers
        self._modules = tuple(modules)
        self._news: SimpleQueue[News] = SimpleQueue()
        self._processes = self._new_processes()

    def start(self, order: Order) -> Future[End]:
        """Queue a run for the next free worker."""
        if not self._processes.active:  # it could not start workers
            self._processes.close()
            self._processes = self._new_processes()
        return self._processes.schedule(
            _work,
            [order],
            on_report=lambda progress: self._news.put((order.directory, *progress)),
            begins_itself=True,
        )

    def _new_processes(self) -> WorkerProcesses:
        return WorkerProcesses(self.workers, discover, [self._modules])

    def news(self) -> Iterator[News]:
        """Yield the progress that the workers have sent since the last call."""
        for _ in range(self._news.qsize()):
            yield self._news.get()

    def request_stop(self) -> None:
        """Request all workers to stop after the turn in progress."""
        self._processes.request_stop()

    def close(self) -> None:
        """Terminate the workers, also in the middle of a turn; saved turns are kept."""
        self._processes.close()


def end_of(future: Future[End]) -> End:
    """Return the outcome of an order, also if its worker process was lost."""
    try:
        return future.result()
    except RunError as error:  # its workers ended, or none could be started
        return End("failed", cause_of(error))


def _work(order: Order) -> End:
    try:
        run = perform(order, Channel(lambda turn, best: report((turn, best)), stop_requested, begin))
        return End("stopped") if run is None else End("finished", score=run.summary()["best_pair_score"])
    except LockedError:
        return End("elsewhere")
    except Exception as error:  # noqa: BLE001 - a failure, with its cause, must not stop the other runs
        return End("failed", cause_of(error))
