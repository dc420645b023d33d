"""Contents of run directories."""

from __future__ import annotations

import contextlib
import sqlite3
from pathlib import Path
from typing import Any

from evoframe.record.checksums import CHAINED, SINGLE, Checksums

TABLES = ("turns", "individuals", "pairs", "best_pairs", "state", "meta")
"""All tables except the workload, which contains measured times."""


def rows(directory: Path, table: str) -> list[tuple[Any, ...]]:
    with contextlib.closing(sqlite3.connect(directory / "run.db")) as database:
        return database.execute(f'SELECT * FROM "{table}"').fetchall()  # noqa: S608


def assert_same_result(first: Path, second: Path) -> None:
    for table in TABLES:
        assert rows(first, table) == rows(second, table), table
    kept, others = (written(directory) for directory in (first, second))
    assert kept.keys() == others.keys() >= {"champion.json"}
    for name in kept:
        assert kept[name] == others[name], name


def written(directory: Path) -> dict[str, bytes]:
    """Return the result files of a run except its database, by name."""
    results = [*directory.glob("champion.*"), *directory.glob("verification.*")]
    return {path.name: path.read_bytes() for path in results}


def rewritten(directory: Path, statement: str, *values: Any) -> None:
    """Change rows and recompute all checksums, as a deliberate forgery would."""
    with contextlib.closing(sqlite3.connect(directory / "run.db")) as database, database:
        assert database.execute(statement, values).rowcount > 0
        database.execute("DELETE FROM checksums")
        for table in (*CHAINED, *SINGLE):
            rows = database.execute(f"SELECT * FROM {table}").fetchall()  # noqa: S608
            if rows:
                database.executemany("INSERT INTO checksums VALUES (?, ?)", Checksums.of_rows(table, rows))
