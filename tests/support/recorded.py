"""What runs have left in their directories."""

from __future__ import annotations

import contextlib
import sqlite3
from pathlib import Path
from typing import Any

TABLES = ("turns", "individuals", "pairs", "best_pairs", "state", "meta")
"""All but the workload, which is measured in seconds too."""


def rows(directory: Path, table: str) -> list[tuple[Any, ...]]:
    with contextlib.closing(sqlite3.connect(directory / "run.db")) as database:
        return database.execute(f'SELECT * FROM "{table}"').fetchall()  # noqa: S608


def assert_same_result(first: Path, second: Path) -> None:
    for table in TABLES:
        assert rows(first, table) == rows(second, table), table
    assert (first / "champion.json").read_bytes() == (second / "champion.json").read_bytes()
