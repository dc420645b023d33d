"""The rows of a study: of the runs in its directory, and of those that were made elsewhere."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import TypeAlias

from evoframe.errors import InputError
from evoframe.record import open_run
from evoframe.study.plan import Planned, Study, shown
from evoframe.study.progress import Status, with_remedy
from evoframe.study.rows import ROWS_FILE, Row, digest, read_rows, row_of, write_rows

__all__ = ["IMPORTED", "gather", "import_rows", "imported_rows"]

_REPEATABLE = ("fitness", "score", "fittest_pair_score", "pairs", "champion")  # the same whoever made a run

_Key: TypeAlias = tuple[frozenset[tuple[str, str]], int]  # settings and number of a run

IMPORTED = "imported"
"""Folder in the directory of a study with the rows that came from elsewhere."""


def import_rows(study: Study, directory: Path, paths: Iterable[Path]) -> dict[Planned, Row]:
    """Keep rows from elsewhere as those of finished runs of a study.

    Args:
        study: The study.
        directory: Its directory; no other process may import rows at the same time.
        paths: Tables as a study writes them, each perhaps with its curves beside it.

    Returns:
        All rows that were imported, as :func:`imported_rows`.

    Raises:
        InputError: A row is of no run of this study, or contradicts another of the same run; says which.
    """
    planned = _by_key(study, directory)
    rows = _joined(planned, directory, paths)
    folder = directory / IMPORTED
    folder.mkdir(exist_ok=True)
    write_rows(rows, folder / ROWS_FILE)
    return _of_runs(rows, planned, directory)


def _joined(planned: Mapping[_Key, Planned], directory: Path, paths: Iterable[Path]) -> list[Row]:
    """Return the rows that were imported before, and those of more tables."""
    before = directory / IMPORTED / ROWS_FILE
    kept = {_key(row): row for row in (read_rows(before) if before.is_file() else ())}
    for path in paths:
        for row in read_rows(path):
            run = planned.get(_key(row))
            if run is None:
                raise InputError(f"{path}: {_named(row)}: is no run of this study")
            _refuse_another(row, run, path)
            earlier = kept.get(_key(row), row)
            if differing := [name for name in _REPEATABLE if getattr(earlier, name) != getattr(row, name)]:
                what = " and ".join(differing)
                raise InputError(f"{path}: {_named(row)}: another {what} than in the rows imported before")
            kept[_key(row)] = earlier if earlier.fitness_curve else row  # which may have curves
    return list(kept.values())


def imported_rows(study: Study, directory: Path, more: Iterable[Path] = ()) -> dict[Planned, Row]:
    """Return the rows that were imported, by the run that they are of; those of other cells wait.

    Args:
        study: The study.
        directory: Its directory.
        more: Tables that could be imported too.

    Raises:
        InputError: They are damaged, or were made otherwise than this study makes them.
    """
    planned = _by_key(study, directory)
    return _of_runs(_joined(planned, directory, more), planned, directory)


def _of_runs(rows: Iterable[Row], planned: Mapping[_Key, Planned], directory: Path) -> dict[Planned, Row]:
    found = {}
    for row in rows:
        run = planned.get(_key(row))
        if run is not None:
            _refuse_another(row, run, directory / IMPORTED / ROWS_FILE)
            found[run] = row
    return found


def _key(row: Row) -> _Key:
    return frozenset(row.settings.items()), row.run


def _by_key(study: Study, directory: Path) -> dict[_Key, Planned]:
    """Return the runs that are planned, by the keys of their rows."""
    settings = {cell: frozenset((key, shown(value)) for key, value in cell.settings) for cell in study.cells}
    return {(settings[run.cell], run.index): run for run in study.planned(directory)}


def _named(row: Row) -> str:
    return ", ".join([*(f"{key}={value}" for key, value in row.settings.items()), f"run {row.run}"])


def gather(statuses: Mapping[Planned, Status], imported: Mapping[Planned, Row]) -> dict[Planned, Row]:
    """Return the rows of all runs that are done, in the order of work.

    Args:
        statuses: How far each run is; rows that the survey has not read are read now.
        imported: The rows that came from elsewhere.

    Raises:
        InputError: The directory of a run is damaged.
    """
    rows = {}
    for planned, status in statuses.items():
        if status.row is not None:
            rows[planned] = status.row
        elif status.state == "imported":
            rows[planned] = imported[planned]
        elif status.is_done:
            with with_remedy(), open_run(planned.directory) as run:
                rows[planned] = row_of(planned, run)
    return rows


def _refuse_another(row: Row, run: Planned, path: Path) -> None:
    if row.seed != run.seed or row.configuration != digest(run):
        raise InputError(
            f"{path}: {_named(row)}: was made with another configuration or seed than this study has"
        )
