"""The rows of a study: those of the runs in its directory, and those imported from other sessions."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import TypeAlias

from evoframe.errors import InputError
from evoframe.record import bit_generations_of, open_run
from evoframe.study.conduct import STUDY_FILE
from evoframe.study.plan import Planned, Study, shown
from evoframe.study.progress import Status, with_remedy
from evoframe.study.rows import CURVES_FILE, ROWS_FILE, Row, digest, read_rows, row_of, write_rows

__all__ = ["IMPORTED", "TABLES", "gather", "import_rows", "imported_rows", "mixed_generations"]

_REPEATABLE = ("fitness", "score", "fittest_pair_score", "pairs", "champion")  # equal on every machine

_Key: TypeAlias = tuple[frozenset[tuple[str, str]], int]  # settings and number of a run

IMPORTED = "imported"
"""Folder in the directory of a study that holds the imported rows."""

TABLES = (
    STUDY_FILE,
    *(f"{folder}{name}" for folder in ("", f"{IMPORTED}/") for name in (ROWS_FILE, CURVES_FILE)),
)
"""The files that contain the data of a study, apart from its runs."""


def import_rows(study: Study, directory: Path, paths: Iterable[Path]) -> dict[Planned, Row]:
    """Import rows of other sessions; they count as finished runs of a study.

    Args:
        study: The study.
        directory: Its directory; no other process may import rows at the same time.
        paths: Paths of ``rows.csv`` of other sessions; ``curves.csv`` in the same folder is optional.

    Returns:
        All imported rows, as :func:`imported_rows`.

    Raises:
        InputError: A row belongs to no run of this study, or contradicts another row of the same run.
    """
    planned = _by_key(study, directory)
    rows = _joined(planned, directory, paths)
    folder = directory / IMPORTED
    folder.mkdir(exist_ok=True)
    write_rows(rows, folder / ROWS_FILE)
    return _of_runs(rows, planned, directory)


def _joined(planned: Mapping[_Key, Planned], directory: Path, paths: Iterable[Path]) -> list[Row]:
    """Return the rows imported before, and those of more tables."""
    before = directory / IMPORTED / ROWS_FILE
    kept = {_key(row): row for row in (read_rows(before) if before.is_file() else ())}
    for path in paths:
        for row in read_rows(path):
            run = planned.get(_key(row))
            if run is None:
                raise InputError(
                    "this study has no such run; check the study's grid and number of runs",
                    source=path,
                    key=_named(row),
                )
            _refuse_another(row, run, path)
            earlier = kept.get(_key(row), row)
            if differing := [name for name in _REPEATABLE if getattr(earlier, name) != getattr(row, name)]:
                if earlier.bit_generations != row.bit_generations:
                    differing.append("bit_generations")
                raise InputError(
                    "contradicts the row imported before: "
                    + "; ".join(f"{n} was {_shown(earlier, n)}, is {_shown(row, n)}" for n in differing),
                    source=path,
                    key=_named(row),
                )
            kept[_key(row)] = earlier if earlier.fitness_curve else row  # the new row may have curves
    return list(kept.values())


def _shown(row: Row, name: str) -> str:
    return str(getattr(row, name)) or "1"  # the bit generation of all components


def imported_rows(study: Study, directory: Path, more: Iterable[Path] = ()) -> dict[Planned, Row]:
    """Return the imported rows by run; rows of cells that the study does not have are skipped.

    Args:
        study: The study.
        directory: Its directory.
        more: Further tables to read without importing them.

    Raises:
        InputError: A table is damaged, or a row has another configuration or seed than this study.
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
    """Return the planned runs by the keys of their rows."""
    settings = {cell: frozenset((key, shown(value)) for key, value in cell.settings) for cell in study.cells}
    return {(settings[run.cell], run.index): run for run in study.planned(directory)}


def _named(row: Row) -> str:
    return ", ".join([*(f"{key}={value}" for key, value in row.settings.items()), f"run {row.run}"])


def gather(statuses: Mapping[Planned, Status], imported: Mapping[Planned, Row]) -> dict[Planned, Row]:
    """Return the rows of all finished or imported runs, in the order of work.

    Args:
        statuses: Status of each run; rows that the survey has not read are read now.
        imported: The imported rows.

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


def mixed_generations(rows: Mapping[Planned, Row], to_run: Iterable[Planned] = ()) -> list[str]:
    """Return a line for each component whose results in a study have several bit generations.

    Args:
        rows: The rows of the finished runs.
        to_run: Runs to execute now, with the present generations.
    """
    found: dict[str, set[int]] = {}
    for planned in [*rows, *to_run]:
        chosen, row = dict(planned.cell.config.components()), rows.get(planned)
        for key, now in bit_generations_of(planned.cell.config).items():
            number = now if row is None else row.bit_generation(key)
            found.setdefault(f"{key} '{chosen[key].name}'", set()).add(number)
    return [
        f"{component}: {' and '.join(map(str, sorted(numbers)))}"
        for component, numbers in found.items()
        if len(numbers) > 1
    ]


def _refuse_another(row: Row, run: Planned, path: Path) -> None:
    if row.seed != run.seed or row.configuration != digest(run):
        raise InputError(
            f"has configuration {row.configuration} and seed {row.seed}; this study has configuration "
            f"{digest(run)} and seed {run.seed}",
            source=path,
            key=_named(row),
        )
