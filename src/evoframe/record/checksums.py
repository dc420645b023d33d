"""Checksums of a run's tables. SQLite keeps none, so damaged rows would be read as results."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import Any

__all__ = ["CHAINED", "SINGLE", "Checksums"]

Row = Sequence[Any]

CHAINED = ("turns", "individuals", "measures", "pairs", "best_pairs", "workload", "resumes")
"""Append-only tables: one checksum for all rows, in the order of their keys."""

SINGLE = ("meta", "state")
"""Tables whose rows can be replaced: one checksum per row, by its key."""


class Checksums:
    """Running checksums of the append-only tables."""

    def __init__(self) -> None:
        self._hashes = {table: _new_hash() for table in CHAINED}

    def add(self, table: str, rows: Iterable[Row]) -> None:
        """Append *rows*, which follow the earlier ones in the order of their keys."""
        self._hashes[table].update(_text(rows, _json))

    def of(self, table: str) -> tuple[str, str]:
        """Return the name and the checksum of an append-only table."""
        return table, self._hashes[table].hexdigest()

    @staticmethod
    def of_row(table: str, row: Row) -> tuple[str, str]:
        """Return the name and the checksum of a replaceable row."""
        return f"{table}:{row[0]}", _checksum([row], _json)

    @staticmethod
    def of_rows(table: str, rows: Iterable[Row]) -> Iterator[tuple[str, str]]:
        """Yield the names and checksums of all *rows* of a table, as read from a database."""
        if table in SINGLE:
            yield from ((f"{table}:{row[0]}", _checksum([row], _json_of_anything)) for row in rows)
        elif table in CHAINED:
            yield table, _checksum(rows, _json_of_anything)


def _new_hash() -> hashlib.blake2b:
    return hashlib.blake2b(digest_size=16)


def _checksum(rows: Iterable[Row], json_of: Callable[[list[Row]], str]) -> str:
    checksum = _new_hash()
    checksum.update(_text(rows, json_of))
    return checksum.hexdigest()


def _text(rows: Iterable[Row], json_of: Callable[[list[Row]], str]) -> bytes:
    """Return rows as text that, joined over several calls, equals that of one call with all rows."""
    listed = list(rows)
    return f"{json_of(listed)[1:-1]},".encode() if listed else b""


_json: Callable[[list[Row]], str] = json.JSONEncoder(separators=(",", ":")).encode

# A damaged database can contain bytes, which JSON cannot represent.
_json_of_anything: Callable[[list[Row]], str] = json.JSONEncoder(separators=(",", ":"), default=repr).encode
