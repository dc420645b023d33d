"""The directory of a study, and the work that is done there."""

from __future__ import annotations

import concurrent.futures
import contextlib
from collections import deque
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import FIRST_COMPLETED, Future
from pathlib import Path
from typing import Any

import tomli_w

from evoframe.documents import differences
from evoframe.errors import InputError
from evoframe.files import (
    LARGEST_DOCUMENT,
    is_leftover,
    locked_after_others,
    parsed_toml,
    read_text,
    write_atomically,
)
from evoframe.study.plan import Planned, Study, shown
from evoframe.study.pool import End, Pool, end_of
from evoframe.study.progress import Status, forget_failure, note_failure, status_of, with_remedy
from evoframe.study.rows import Row
from evoframe.study.worker import INTERVAL, Order

__all__ = ["STUDY_FILE", "Watcher", "claim", "execute", "lock_tables", "refuse_another", "survey"]

STUDY_FILE = "study.toml"

_LOCK_FILE = "study.lock"


class Watcher:
    """Receives the progress of a study, and ignores it: override what you need."""

    def on_begin(self, study: Study, todo: Sequence[Planned], done: Mapping[Planned, Row]) -> None:
        """Receive what will be run or verified, and the rows of what needs no work."""

    def on_run_started(self, planned: Planned) -> None:
        """Receive a run on which work begins."""

    def on_turn_finished(self, planned: Planned, turn: int, best: float | None) -> None:
        """Receive a run's latest turn, and its best score since work on it began."""

    def on_run_ended(self, planned: Planned, end: End) -> None:
        """Receive how work on a run has ended."""

    def on_tick(self) -> None:
        """Update a display; called several times a second."""


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
    with lock_tables(directory):
        refuse_another(study, directory)  # again: another process may have been faster
        write_atomically(directory / STUDY_FILE, tomli_w.dumps(_tables(study)).encode())


def lock_tables(directory: Path) -> contextlib.AbstractContextManager[None]:
    """Keep other processes from writing the files that all runs of a study share.

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
    try:  # processes that begin a study leave more than nothing before its file
        occupied = any(each.name != _LOCK_FILE and not is_leftover(each) for each in directory.iterdir())
    except OSError as error:
        raise InputError(f"{directory}: cannot be used for a study: {error.strerror}") from error
    if path.is_file():  # only now: another process makes it before anything else
        there = parsed_toml(read_text(path, LARGEST_DOCUMENT), str(path))
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


def survey(
    study: Study,
    directory: Path,
    imported: Mapping[Planned, Row] | None = None,
    *,
    rows: bool = False,
    known: Mapping[Planned, Status] | None = None,
) -> dict[Planned, Status]:
    """Return how far each run of a study is, in the order of work.

    Args:
        study: The study.
        directory: Its directory.
        imported: Rows that came from elsewhere, which count where the run is not finished here.
        rows: Whether to read the row of each finished run, too, while the run is open.
        known: What was found before of runs on which nothing is left to do; these are not opened again.

    Raises:
        InputError: One of them is damaged, or of another study.
    """
    imported, known, found = imported or {}, known or {}, {}
    for planned in study.planned(directory):
        with with_remedy():
            status = known.get(planned) or status_of(planned, with_row=rows)
        if planned in imported and not status.is_done:
            status = Status("imported", row=imported[planned])
        found[planned] = status
    return found


def execute(orders: Mapping[Planned, Order], pool: Pool, watcher: Watcher, stop: Callable[[], bool]) -> None:
    """Make runs, or go on with them, as many at a time as there are workers.

    Args:
        orders: The runs, in the order of work, and what is said to the workers about each.
        pool: The workers.
        watcher: Receives the progress.
        stop: Asked again and again whether to stop; what is running stops after its turn.
    """
    waiting = deque(orders)
    running: dict[Future[End], Planned] = {}
    while waiting or running:
        if stop():
            waiting.clear()
            pool.ask_to_stop()
        while waiting and len(running) < pool.workers:
            planned = waiting.popleft()
            forget_failure(planned.directory)
            running[pool.start(orders[planned])] = planned
            watcher.on_run_started(planned)
        ended, _ = concurrent.futures.wait(running, INTERVAL, FIRST_COMPLETED)
        by_directory = {planned.directory: planned for planned in running.values()}
        for directory, turn, best in pool.news():
            if directory in by_directory:
                watcher.on_turn_finished(by_directory[directory], turn, best)
        for future in ended:
            planned, end = running.pop(future), end_of(future)
            if end.state == "failed":
                note_failure(planned.directory, end.cause)
            watcher.on_run_ended(planned, end)
        watcher.on_tick()


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
