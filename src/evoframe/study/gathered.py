"""The rows of a study: of the runs in its directory, and of those that were made elsewhere."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path

from evoframe.errors import InputError
from evoframe.study.plan import Planned, Study, shown
from evoframe.study.rows import ROWS_FILE, Row, digest, read_rows, row_of, write_rows

__all__ = ["IMPORTED", "gather", "import_rows", "imported_rows"]

IMPORTED = "imported"
"""Folder in the directory of a study with the rows that came from elsewhere."""


def import_rows(study: Study, directory: Path, paths: Iterable[Path]) -> None:
    """Keep rows from elsewhere as those of finished runs of a study.

    Args:
        study: The study.
        directory: Its directory.
        paths: Tables as a study writes them, each perhaps with its curves beside it.

    Raises:
        InputError: A row is of no run of this study, or contradicts another of the same run; says which.
    """
    planned = list(study.planned(directory))
    rows = imported_rows(study, directory)
    for path in paths:
        for row in read_rows(path):
            run = _run_of(row, planned, path)
            if run in rows and rows[run].champion != row.champion:
                raise InputError(f"{path}: {run.label}: another champion than in the rows imported before")
            rows[run] = row
    folder = directory / IMPORTED
    folder.mkdir(exist_ok=True)
    write_rows([rows[run] for run in planned if run in rows], folder / ROWS_FILE)


def imported_rows(study: Study, directory: Path) -> dict[Planned, Row]:
    """Return the rows that were imported, by the run that they are of.

    Raises:
        InputError: They are damaged, or of no runs of this study.
    """
    path = directory / IMPORTED / ROWS_FILE
    if not path.is_file():
        return {}
    planned = list(study.planned(directory))
    return {_run_of(row, planned, path): row for row in read_rows(path)}


def gather(study: Study, directory: Path, finished: Sequence[Planned]) -> list[Row]:
    """Return the rows of all finished runs, in the order of work.

    What a run's own directory says comes before what was imported.

    Raises:
        InputError: The directory of a run is damaged.
    """
    elsewhere = imported_rows(study, directory)
    return [elsewhere[run] if _is_elsewhere(run, elsewhere) else row_of(run) for run in finished]


def _is_elsewhere(run: Planned, elsewhere: Mapping[Planned, Row]) -> bool:
    return run in elsewhere and not run.directory.is_dir()


def _run_of(row: Row, planned: Iterable[Planned], path: Path) -> Planned:
    """Return the run that a row is of."""
    named = ", ".join(f"{key}={value}" for key, value in row.settings.items())
    for run in planned:
        settings = {key: shown(value) for key, value in run.cell.settings}
        if run.index == row.run and settings == dict(row.settings):
            break
    else:
        raise InputError(f"{path}: {named}, run {row.run}: is no run of this study")
    if row.seed != run.seed or row.configuration != digest(run):
        raise InputError(
            f"{path}: {named}, run {row.run}: was made with another configuration or seed than this study has"
        )
    return run
