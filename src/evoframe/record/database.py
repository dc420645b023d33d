"""Reading of a run's database, which is untrusted input."""

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

# In a crafted database, pages that refer to each other can yield a practically infinite number of rows.
_STEPS_PER_BYTE = 20  # of SQLite's virtual machine: about fifty times the cost of reading a whole table
_STEPS = 100_000

_TYPES: Mapping[str, type] = {"INTEGER": int, "REAL": float, "TEXT": str}


@attrs.frozen(eq=False)
class Table:
    """All rows of a table, in the order of their keys.

    Attributes:
        columns: Names of the columns.
        rows: Tuples with a value for each column.
    """

    columns: tuple[str, ...]
    rows: Sequence[tuple[Any, ...]]

    def records(self) -> list[dict[str, Any]]:
        """Return each row as column -> value."""
        return [dict(zip(self.columns, row, strict=True)) for row in self.rows]


@attrs.define(eq=False)
class Database:
    """A database open for reading; all reads come from one snapshot until :meth:`refresh`.

    Attributes:
        path: Its file.
        closed: ``True`` after :meth:`close`.
    """

    path: Path
    _connection: sqlite3.Connection
    closed: bool = attrs.field(default=False, init=False)
    _version: int = attrs.field(default=0, init=False)

    @classmethod
    def open(cls, path: Path) -> Database:
        """Open the database in a file; the caller closes it.

        Raises:
            InputError: The file cannot be read.
        """
        with _wrap_errors(path):
            connection = sqlite3.connect(
                f"{path.absolute().as_uri()}?mode=ro", uri=True, isolation_level=None
            )
            connection.execute("PRAGMA trusted_schema = OFF")
            connection.setlimit(sqlite3.SQLITE_LIMIT_LENGTH, LARGEST_DOCUMENT << 20)
            connection.setlimit(sqlite3.SQLITE_LIMIT_ATTACHED, 0)
            connection.execute("BEGIN")  # rows and checksums from one snapshot
        return cls(path, connection)

    def close(self) -> None:
        """Close the database; tables that were read remain available."""
        self.closed = True
        self._connection.close()

    def refresh(self) -> bool:
        """Take a new snapshot; return ``True`` if the database was written to since the previous one."""
        with _wrap_errors(self.path):
            self._connection.execute("COMMIT")
            self._connection.execute("BEGIN")
        before, self._version = self._version, self._data_version()
        return before != self._version

    def tables(self) -> list[str]:
        """Return the names of all tables; views and triggers are excluded, whatever their names."""
        self._version = self._version or self._data_version()
        return [row[0] for row in self._fetched("SELECT name FROM sqlite_master WHERE type = 'table'")]

    def refuse_another(self, config: Mapping[str, Any]) -> None:
        """Check that this is the database of a run with *config*, in the format of this version of evoframe.

        The format is checked first, because other formats may have other tables. A table is queried only if
        its definition equals the schema character for character: a view could have its name.

        Raises:
            InputError: The format or the tables differ.
        """
        roles = _roles(config)
        expected = schema(roles)
        statements = [row[0] for row in self._fetched("SELECT sql FROM sqlite_master")]
        genuine = any(" meta " in statement and statement in statements for statement in expected)
        formats = self._fetched("SELECT value FROM meta WHERE key = 'format'") if genuine else []
        if formats != [(str(RUN_FORMAT),)]:
            found = repr(formats[0][0]) if formats else "none"
            hint = f"read it with the version of evoframe that wrote it (see [provenance] in {CONFIG_FILE})"
            problem = f"expected {RUN_FORMAT}, found {found}; {hint}"
            raise InputError(problem, source=self.path, key="meta.format")
        if not roles or set(statements) != set(expected):
            raise InputError(
                f"damaged: the tables do not match the populations in {CONFIG_FILE}", source=self.path
            )

    def read(self, name: str) -> Table:
        """Read a table, and compare it with its checksum.

        Raises:
            InputError: The table does not exist, or is damaged.
        """
        tables = self.tables()
        if name not in tables:
            raise InputError(f"no table '{name}'; tables: {', '.join(sorted(tables))}", source=self.path)
        with self._limit_work():
            found = self._connection.execute(f'SELECT * FROM "{name}"')  # noqa: S608 - one of its tables
            table = Table(tuple(column[0] for column in found.description), found.fetchall())
        if name in (*CHAINED, *SINGLE):
            self._compare_checksums(name, table.rows)
            self._refuse_types(name, table.rows)
        return table

    def damage(self) -> list[str]:
        """Return the faults that SQLite finds in pages, tables and indices."""
        return [row[0] for row in self._fetched("PRAGMA integrity_check") if row[0] != "ok"]

    def _data_version(self) -> int:
        self._fetched("SELECT 1 FROM sqlite_master LIMIT 1")  # this starts the snapshot
        return int(self._fetched("PRAGMA data_version")[0][0])

    def _fetched(self, statement: str, *arguments: Any) -> list[tuple[Any, ...]]:
        with self._limit_work():
            return self._connection.execute(statement, arguments).fetchall()

    @contextlib.contextmanager
    def _limit_work(self) -> Iterator[None]:
        """Interrupt statements that exceed the work possible in an intact database of this size."""
        budget = iter(range(_STEPS_PER_BYTE * _size(self.path) // _STEPS + 100))
        self._connection.set_progress_handler(lambda: next(budget, None) is None, _STEPS)
        with _wrap_errors(self.path):
            yield

    def _compare_checksums(self, table: str, rows: Sequence[tuple[Any, ...]]) -> None:
        """Refuse rows that do not match their checksums."""
        saved = {
            str(name): checksum for name, checksum in self._fetched("SELECT name, checksum FROM checksums")
        }
        found = dict(Checksums.of_rows(table, rows)) if rows else {}
        expected = {name: saved[name] for name in saved if name.partition(":")[0] == table}
        names = sorted(found.keys() | expected.keys())
        if wrong := [name for name in names if found.get(name) != expected.get(name)]:
            raise InputError("damaged: does not match its checksum", source=self.path, key=", ".join(wrong))

    def _refuse_types(self, table: str, rows: Sequence[tuple[Any, ...]]) -> None:
        """Refuse values whose types differ from those of their columns, which SQLite itself accepts."""
        declared = self._fetched('SELECT type, "notnull", pk FROM pragma_table_info(?)', table)
        types = [
            (_TYPES[type_],) if needed or key else (_TYPES[type_], type(None))
            for type_, needed, key in declared
        ]
        for row in rows:
            if not all(map(isinstance, row, types)):
                raise InputError(
                    f"damaged: a row has values of wrong types: {row}", source=self.path, key=table
                )


@contextlib.contextmanager
def _wrap_errors(path: Path) -> Iterator[None]:
    try:
        yield
    except (sqlite3.Error, OverflowError, UnicodeDecodeError) as error:
        journal, hint = path.with_name(f"{path.name}-wal"), ""
        if journal.is_file() and not os.access(path.parent, os.W_OK):
            hint = f"; to read {journal.name} too, copy the directory to a writable place"
        raise InputError(f"cannot be read: {error}{hint}", source=path) from error


def _size(path: Path) -> int:
    """Return the size of a database and its write-ahead log, in bytes."""
    return sum(part.stat().st_size for part in (path, path.with_name(f"{path.name}-wal")) if part.is_file())


def _roles(config: Mapping[str, Any]) -> list[str]:
    """Return the populations of a configuration, or none if their names cannot be names of columns."""
    populations = config.get("populations")
    if not isinstance(populations, dict) or not all(map(is_role, populations)):
        return []
    return list(populations)
