"""The database of a run, read: it may come from anyone, so nothing in it is trusted."""

from __future__ import annotations

import contextlib
import os
import sqlite3
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import attrs

from evoframe.contract import is_role
from evoframe.errors import InputError
from evoframe.files import LARGEST_DOCUMENT
from evoframe.record.checksums import CHAINED, SINGLE, Checksums
from evoframe.record.layout import CONFIG_FILE, RUN_FORMAT, schema

__all__ = ["Database", "Table"]

# Pages that refer to each other in a made-up database may hold more rows than a computer can count.
_STEPS_PER_BYTE = 20  # of SQLite's machine: some fifty times what a table takes that is read whole
_STEPS = 100_000

_TYPES: Mapping[str, type] = {"INTEGER": int, "REAL": float, "TEXT": str}


@attrs.frozen(eq=False)
class Table:
    """All rows of a table, in the order of their keys.

    Attributes:
        columns: Names of the columns.
        rows: A value for each column.
    """

    columns: tuple[str, ...]
    rows: Sequence[tuple[Any, ...]]

    def records(self) -> list[dict[str, Any]]:
        """Return each row as column -> value."""
        return [dict(zip(self.columns, row, strict=True)) for row in self.rows]


@attrs.define(eq=False)
class Database:
    """A database that is open for reading; all that is read is of one moment.

    Attributes:
        path: Its file.
        closed: Whether it is not open any more.
    """

    path: Path
    _connection: sqlite3.Connection
    closed: bool = attrs.field(default=False, init=False)
    _version: int = attrs.field(default=0, init=False)

    @classmethod
    def opened(cls, path: Path) -> Database:
        """Return the database of a file, to be closed.

        Raises:
            InputError: It cannot be read.
        """
        with _refusing(path):
            connection = sqlite3.connect(
                f"{path.absolute().as_uri()}?mode=ro", uri=True, isolation_level=None
            )
            connection.execute("PRAGMA trusted_schema = OFF")
            connection.setlimit(sqlite3.SQLITE_LIMIT_LENGTH, LARGEST_DOCUMENT << 20)
            connection.setlimit(sqlite3.SQLITE_LIMIT_ATTACHED, 0)
            connection.execute("BEGIN")  # rows and checksums of one moment
        return cls(path, connection)

    def close(self) -> None:
        """Close it; what was read stays."""
        self.closed = True
        self._connection.close()

    def renewed(self) -> bool:
        """Look at the database as it is now, and return whether somebody has written since the last time."""
        with _refusing(self.path):
            self._connection.execute("COMMIT")
            self._connection.execute("BEGIN")
        before, self._version = self._version, self._data_version()
        return before != self._version

    def tables(self) -> list[str]:
        """Return the names of all tables: a view or a trigger is none, whatever it is called."""
        self._version = self._version or self._data_version()
        return [row[0] for row in self._fetched("SELECT name FROM sqlite_master WHERE type = 'table'")]

    def refuse_another(self, config: Mapping[str, Any]) -> None:
        """Make sure that this is the database of a run with a configuration, in the format of this evoframe.

        The format comes first, since another may have other tables. Nothing is asked of a table that is not
        to the letter one of ours: a view may be called like one.

        Raises:
            InputError: It is another, or damaged.
        """
        roles = _roles(config)
        expected = schema(roles)
        statements = [row[0] for row in self._fetched("SELECT sql FROM sqlite_master")]
        ours = [statement for statement in expected if statement in statements and " meta " in statement]
        formats = self._fetched("SELECT value FROM meta WHERE key = 'format'") if ours else []
        if formats != [(str(RUN_FORMAT),)]:
            what = f"the format {formats[0][0]!r}" if formats else "no format"
            raise InputError(
                f"{self.path.parent}: has {what}, but this evoframe reads format {RUN_FORMAT}; read it with "
                f"the evoframe that wrote it: {CONFIG_FILE} names its version under [provenance]"
            )
        if not roles or set(statements) != set(expected):
            raise InputError(
                f"{self.path}: is damaged: its tables are not those of a run with this {CONFIG_FILE}"
            )

    def read(self, name: str) -> Table:
        """Return a table, compared with its checksum.

        Raises:
            InputError: There is no such table, or it is damaged.
        """
        tables = self.tables()
        if name not in tables:
            raise InputError(f"{self.path}: has no table '{name}'; tables: {', '.join(sorted(tables))}")
        with self._limited():
            found = self._connection.execute(f'SELECT * FROM "{name}"')  # noqa: S608 - one of its tables
            table = Table(tuple(column[0] for column in found.description), found.fetchall())
        if name in (*CHAINED, *SINGLE):
            self._compare_checksums(name, table.rows)
            self._refuse_types(name, table.rows)
        return table

    def damage(self) -> list[str]:
        """Return what SQLite finds wrong with pages, tables and indices."""
        return [row[0] for row in self._fetched("PRAGMA integrity_check") if row[0] != "ok"]

    def _data_version(self) -> int:
        self._fetched("SELECT 1 FROM sqlite_master LIMIT 1")  # from here on everything is of one moment
        return int(self._fetched("PRAGMA data_version")[0][0])

    def _fetched(self, statement: str, *arguments: Any) -> list[tuple[Any, ...]]:
        with self._limited():
            return self._connection.execute(statement, arguments).fetchall()

    @contextlib.contextmanager
    def _limited(self) -> Iterator[None]:
        """Let no statement take longer than it can in a sound database of this size."""
        budget = iter(range(_STEPS_PER_BYTE * _size(self.path) // _STEPS + 100))
        self._connection.set_progress_handler(lambda: next(budget, None) is None, _STEPS)
        with _refusing(self.path):
            yield

    def _compare_checksums(self, table: str, rows: Sequence[tuple[Any, ...]]) -> None:
        """Refuse rows that are not those that were saved."""
        saved = {
            str(name): checksum for name, checksum in self._fetched("SELECT name, checksum FROM checksums")
        }
        found = dict(Checksums.of_rows(table, rows)) if rows else {}
        expected = {name: saved[name] for name in saved if name.partition(":")[0] == table}
        names = sorted(found.keys() | expected.keys())
        if wrong := [name for name in names if found.get(name) != expected.get(name)]:
            raise InputError(f"{self.path}: is damaged: {', '.join(wrong)} is not what was saved")

    def _refuse_types(self, table: str, rows: Sequence[tuple[Any, ...]]) -> None:
        """Refuse values of types that the columns do not declare: SQLite itself takes any."""
        declared = self._fetched('SELECT type, "notnull", pk FROM pragma_table_info(?)', table)
        types = [
            (_TYPES[type_],) if needed or key else (_TYPES[type_], type(None))
            for type_, needed, key in declared
        ]
        for row in rows:
            if not all(map(isinstance, row, types)):
                raise InputError(
                    f"{self.path}: is damaged: {table} has a row with values of other types: {row}"
                )


@contextlib.contextmanager
def _refusing(path: Path) -> Iterator[None]:
    try:
        yield
    except (sqlite3.Error, OverflowError, UnicodeDecodeError) as error:
        journal, hint = path.with_name(f"{path.name}-wal"), ""
        if journal.is_file() and not os.access(path.parent, os.W_OK):
            hint = f"; to read what {journal.name} has, copy the directory to where it may be written"
        raise InputError(f"{path}: cannot be read: {error}{hint}") from error


def _size(path: Path) -> int:
    """Return the bytes of a database and of what was written beside it."""
    return sum(part.stat().st_size for part in (path, path.with_name(f"{path.name}-wal")) if part.is_file())


def _roles(config: Mapping[str, Any]) -> list[str]:
    """Return the populations of a configuration, which become names of columns; none if they cannot."""
    populations = config.get("populations")
    if not isinstance(populations, dict) or not all(map(is_role, populations)):
        return []
    return list(populations)
