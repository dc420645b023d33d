"""A study at work: what is missing is run, by as many processes as there are cores."""

from __future__ import annotations

import concurrent.futures
import contextlib
import tomllib
from collections import deque
from collections.abc import Callable, Collection, Iterator, Mapping
from concurrent.futures import FIRST_COMPLETED, Future
from pathlib import Path
from typing import Any, Protocol

import attrs
import tomli_w

from evoframe.documents.trees import differences
from evoframe.errors import InputError
from evoframe.files.locks import locked_after_others
from evoframe.files.reading import read_text
from evoframe.files.writing import is_leftover, write_atomically
from evoframe.study.plan import Planned, Study, shown
from evoframe.study.pool import End, Pool, end_of
from evoframe.study.progress import REMEDY, Status, forget_failure, note_failure, status
from evoframe.study.worker import INTERVAL, Order

__all__ = ["STUDY_FILE", "Watcher", "alone", "claim", "conduct", "refuse_another", "survey"]

STUDY_FILE = "study.toml"

_LOCK_FILE = "study.lock"


class Watcher(Protocol):
    """Is told how a study goes on."""

    def began(self, planned: Planned) -> None:
        """Work on a run begins."""

    def told(self, planned: Planned, turn: int, best: float | None) -> None:
        """A run has finished a turn; *best* is its best score since work on it began."""

    def ended(self, planned: Planned, end: End) -> None:
        """Work on a run has ended."""

    def looked(self) -> None:
        """Some time has passed."""


def claim(study: Study, directory: Path) -> None:
    """Make the directory of a study, or note there what the study is now.

    Raises:
        InputError: As :func:`refuse_another`, or it cannot be made.
        RunError: It cannot be written.
    """
    try:
        directory.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InputError(f"{directory}: cannot be used for a study: {error.strerror}") from error
    refuse_another(study, directory)  # what is somebody else's gets no lock
    with alone(directory):
        refuse_another(study, directory)  # again: another process may have been faster
        write_atomically(directory / STUDY_FILE, tomli_w.dumps(_tables(study)).encode())


def alone(directory: Path) -> contextlib.AbstractContextManager[None]:
    """Return what keeps other processes from writing the files that all runs of a study share.

    Args:
        directory: The directory of the study; :func:`claim` makes it.

    Raises:
        InputError: It cannot be written.
    """
    return locked_after_others(directory / _LOCK_FILE)


def refuse_another(study: Study, directory: Path) -> None:
    """Make sure that a directory is empty, or that of this study.

    More runs and more values of the grid are welcome, fewer are not; all other settings must be those that it
    has.

    Raises:
        InputError: It is the directory of another study, or of something else, or has more.
    """
    path = directory / STUDY_FILE
    occupied = _is_occupied(directory)
    if path.is_file():  # only now: another process makes it before anything else
        there = _read(path)
        others = differences(_shared(there), _shared(_tables(study)))
        if others:
            listed = "\n  ".join(others)
            raise InputError(f"{path}: is another study; choose another directory:\n  {listed}")
        if gone := [*_gone(there, study)]:
            listed = "\n  ".join(gone)
            raise InputError(
                f"{path}: has more than what is asked for, and would forget it; ask for all of it, or choose "
                f"another directory with --out:\n  {listed}"
            )
    elif occupied:
        raise InputError(f"{directory}: is not empty, and not the directory of a study; choose another")


def _is_occupied(directory: Path) -> bool:
    """Return whether there is more than what the processes that begin a study leave before its file."""
    try:
        return any(path.name != _LOCK_FILE and not is_leftover(path) for path in directory.iterdir())
    except OSError as error:
        raise InputError(f"{directory}: cannot be used for a study: {error.strerror}") from error


def survey(study: Study, directory: Path, imported: Collection[Planned] = ()) -> dict[Planned, Status]:
    """Return how far each run of a study is, in the order of work.

    Args:
        study: The study.
        directory: Its directory.
        imported: Runs whose rows came from elsewhere, which counts where they are not finished here.

    Raises:
        InputError: One of them is damaged, or of another study.
    """
    try:
        own = {planned: status(planned) for planned in study.planned(directory)}
    except InputError as error:
        raise InputError(f"{error}; {REMEDY}") from error
    return {
        planned: Status("imported") if planned in imported and not found.is_done else found
        for planned, found in own.items()
    }


def conduct(
    orders: Mapping[Planned, Order], workers: int, watcher: Watcher, stop: Callable[[], bool]
) -> None:
    """Make runs, or go on with them, as many at a time as there are workers.

    Args:
        orders: The runs, in the order of work, and what is said to the workers about each.
        workers: The number of processes.
        watcher: Is told how it goes on.
        stop: Asked again and again whether to stop; what is running stops after its turn.
    """
    with contextlib.closing(Pool(workers)) as pool:
        _Conduct(orders, workers, watcher, pool).work(stop)


@attrs.define
class _Conduct:
    orders: Mapping[Planned, Order]
    workers: int
    watcher: Watcher
    pool: Pool
    running: dict[Future[End], Planned] = attrs.field(factory=dict, init=False)

    def work(self, stop: Callable[[], bool]) -> None:
        waiting = deque(self.orders)
        while waiting or self.running:
            if stop():
                waiting.clear()
                self.pool.ask_to_stop()
            while waiting and len(self.running) < self.workers:
                self._start(waiting.popleft())
            done, _ = concurrent.futures.wait(self.running, INTERVAL, FIRST_COMPLETED)
            self._pass_on()
            for future in done:
                self._end(self.running.pop(future), end_of(future))
            self.watcher.looked()

    def _start(self, planned: Planned) -> None:
        forget_failure(planned.directory)
        self.running[self.pool.start(self.orders[planned])] = planned
        self.watcher.began(planned)

    def _pass_on(self) -> None:
        running = {planned.directory: planned for planned in self.running.values()}
        for directory, turn, best in self.pool.news():
            if directory in running:
                self.watcher.told(running[directory], turn, best)

    def _end(self, planned: Planned, end: End) -> None:
        if end.state == "failed":
            note_failure(planned.directory, end.cause)
        self.watcher.ended(planned, end)


def _tables(study: Study) -> dict[str, Any]:
    """Return the study as TOML tables that need no other file."""
    return {"extends": False, "runs": study.runs, **study.layers.merged(), "grid": dict(study.grid)}


def _shared(tables: dict[str, Any]) -> dict[str, Any]:
    """Return what all runs of a study share, and what decides them."""
    return {key: value for key, value in tables.items() if key not in ("runs", "grid", "executor")}


def _gone(there: Mapping[str, Any], study: Study) -> Iterator[str]:
    """Say what a study's file has and the study has not."""
    runs, grid = there.get("runs"), there.get("grid")
    if isinstance(runs, int) and study.runs < runs:
        yield f"runs: {runs} there, {study.runs} now"
    for key, values in grid.items() if isinstance(grid, Mapping) else ():
        now = {shown(value) for value in study.grid.get(key, ())}
        listed = values if isinstance(values, list) else []
        if gone := [shown(value) for value in listed if shown(value) not in now]:
            yield f"grid.{key}: {', '.join(gone)} there, not now"


def _read(path: Path) -> dict[str, Any]:
    try:
        return tomllib.loads(read_text(path, 16))
    except (ValueError, RecursionError) as error:
        raise InputError(f"{path}: not valid TOML: {error}") from error
