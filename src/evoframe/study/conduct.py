"""The directory of a study, and the execution of its runs."""

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
from evoframe.study.progress import Status, clear_failure, record_failure, status_of, with_remedy
from evoframe.study.rows import Row
from evoframe.study.worker import INTERVAL, Order

__all__ = ["STUDY_FILE", "Watcher", "claim", "execute", "lock_tables", "refuse_another", "survey"]

STUDY_FILE = "study.toml"

_LOCK_FILE = "study.lock"


class Watcher:
    """Receiver of the progress of a study; every method does nothing unless a subclass overrides it."""

    def on_begin(self, study: Study, todo: Sequence[Planned], done: Mapping[Planned, Row]) -> None:
        """Receive the runs to execute or verify, and the rows of those that need no work."""

    def on_run_started(self, planned: Planned) -> None:
        """Receive a run that was started or resumed."""

    def on_turn_finished(self, planned: Planned, turn: int, best: float | None) -> None:
        """Receive a run's latest turn, and its best score since it started or resumed."""

    def on_run_ended(self, planned: Planned, end: End) -> None:
        """Receive the outcome of a run."""

    def on_tick(self) -> None:
        """Update a display; called several times a second."""


def claim(study: Study, directory: Path) -> None:
    """Create the directory of a study, or update its ``study.toml``.

    Raises:
        InputError: As for :func:`refuse_another`, or the directory cannot be created.
        RunError: The directory is not writable.
    """
    try:
        directory.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InputError(
            f"cannot create the directory of a study: {error.strerror}", source=directory
        ) from error
    refuse_another(study, directory)  # before the lock, which writes to the directory
    with lock_tables(directory):
        refuse_another(study, directory)  # again: another process may have been faster
        _renew(directory / STUDY_FILE, tomli_w.dumps(_tables(study)))


def _renew(path: Path, text: str) -> None:
    """Write the file of a study, unless it has the same values, so that its comments and order are kept."""
    if path.is_file():
        there = parsed_toml(read_text(path, LARGEST_DOCUMENT), str(path))
        if there == parsed_toml(text, str(path)):
            return
    write_atomically(path, text.encode())


def lock_tables(directory: Path) -> contextlib.AbstractContextManager[None]:
    """Lock the files that all runs of a study share against other processes.

    Args:
        directory: The directory of the study; :func:`claim` creates it.

    Raises:
        InputError: The directory is not writable.
    """
    return locked_after_others(directory / _LOCK_FILE)


def refuse_another(study: Study, directory: Path) -> None:
    """Check that a directory is empty, or that of this study.

    Runs and values of the grid may be added but not removed; all other settings must be equal.

    Raises:
        InputError: The directory belongs to another study or to something else, or removing runs would lose
            results.
    """
    path = directory / STUDY_FILE
    try:  # a process that starts a study writes the lock and a temporary file before study.toml
        occupied = any(each.name != _LOCK_FILE and not is_leftover(each) for each in directory.iterdir())
    except OSError as error:
        raise InputError(
            f"cannot read the directory of a study: {error.strerror}", source=directory
        ) from error
    if path.is_file():  # checked last: another process writes it before anything else
        there = parsed_toml(read_text(path, LARGEST_DOCUMENT), str(path))
        others = differences(_shared(there), _shared(_tables(study)))
        if others:
            listed = "\n  ".join(others)
            raise InputError(
                f"belongs to a study with other settings; choose another directory with --out:\n  {listed}",
                source=path,
            )
        if gone := [*_removed(there, study)]:
            listed = "\n  ".join(gone)
            raise InputError(
                "runs cannot be removed from a study, so that no result is lost; request all of them, or "
                f"choose another directory with --out:\n  {listed}",
                source=path,
            )
    elif occupied:
        raise InputError(
            f"directory is not empty and has no {STUDY_FILE}; choose another directory with --out",
            source=directory,
        )


def survey(
    study: Study,
    directory: Path,
    imported: Mapping[Planned, Row] | None = None,
    *,
    rows: bool = False,
    known: Mapping[Planned, Status] | None = None,
) -> dict[Planned, Status]:
    """Return the status of each run of a study, in the order of work.

    Args:
        study: The study.
        directory: Its directory.
        imported: Imported rows, which count for runs that are not finished in *directory*.
        rows: Whether to read the row of each finished run too.
        known: Statuses of completed runs from an earlier survey; these runs are not opened again.

    Raises:
        InputError: A run is damaged, or belongs to another study.
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
    """Start or resume runs, as many in parallel as the pool has workers.

    Args:
        orders: The runs in the order of work, each with its order to a worker.
        pool: The workers.
        watcher: Receives the progress.
        stop: Called several times a second; if true, runs in progress stop after their turn.
    """
    waiting = deque(orders)
    running: dict[Future[End], Planned] = {}
    while waiting or running:
        if stop():
            waiting.clear()
            pool.request_stop()
        while waiting and len(running) < pool.workers:
            planned = waiting.popleft()
            clear_failure(planned.directory)
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
                record_failure(planned.directory, end.cause)
            watcher.on_run_ended(planned, end)
        watcher.on_tick()


def _tables(study: Study) -> dict[str, Any]:
    """Return the study as TOML tables that extend no other file."""
    return {"extends": False, "runs": study.runs, **study.layers.merged(), "grid": dict(study.grid)}


def _shared(tables: dict[str, Any]) -> dict[str, Any]:
    """Return the settings that all runs of a study share and that affect their results."""
    return {key: value for key, value in tables.items() if key not in ("runs", "grid", "executor")}


def _removed(there: Mapping[str, Any], study: Study) -> Iterator[str]:
    """Yield a line for each setting whose runs or values in the study's file are missing in *study*."""
    runs, grid = there.get("runs"), there.get("grid")
    if isinstance(runs, int) and study.runs < runs:
        yield f"runs: {runs} before, {study.runs} requested"
    for key, values in grid.items() if isinstance(grid, Mapping) else ():
        now = {shown(value) for value in study.grid.get(key, ())}
        listed = values if isinstance(values, list) else []
        if gone := [shown(value) for value in listed if shown(value) not in now]:
            yield f"grid.{key}: {', '.join(gone)} before, not requested"
