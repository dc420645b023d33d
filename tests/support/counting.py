"""Counters of reads of a run: texts parsed, databases opened, checksums compared."""

from __future__ import annotations

import sqlite3
import tomllib
from collections import Counter
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any
from urllib.parse import unquote

import attrs
import pytest

from evoframe.record.checksums import CHAINED, SINGLE, Checksums

__all__ = ["TABLES", "Reads", "counted"]

TABLES = frozenset((*CHAINED, *SINGLE))


@attrs.define
class Reads:
    """Numbers of reads of the run in a directory.

    Attributes:
        parsed: Number of times that its configuration was parsed.
        opened: Number of times that its database was opened, under any name.
        checked: Table -> number of times that its rows were compared with their checksums.
    """

    parsed: int = 0
    opened: int = 0
    checked: Counter[str] = attrs.field(factory=Counter)


def counted(directory: Path, monkeypatch: pytest.MonkeyPatch) -> Reads:
    """Return the numbers of reads from now until the end of the test."""
    text = (directory / "config.toml").read_text()
    reads, parse, connect, of_rows = Reads(), tomllib.loads, sqlite3.connect, Checksums.of_rows

    def parsing(given: str, /, **options: Any) -> dict[str, Any]:
        reads.parsed += given == text
        return parse(given, **options)

    def connecting(database: Any, *arguments: Any, **options: Any) -> sqlite3.Connection:
        reads.opened += str(directory / "run.db") in unquote(str(database))  # which may be a URI
        opened: sqlite3.Connection = connect(database, *arguments, **options)
        return opened

    def checking(table: str, rows: Iterable[Any]) -> Iterator[tuple[str, str]]:
        reads.checked[table] += 1
        return of_rows(table, rows)

    monkeypatch.setattr(tomllib, "loads", parsing)
    monkeypatch.setattr(sqlite3, "connect", connecting)
    monkeypatch.setattr(Checksums, "of_rows", staticmethod(checking))
    return reads
