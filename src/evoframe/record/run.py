"""Finished and unfinished runs, read back from their directories."""

from __future__ import annotations

import contextlib
import os
import sqlite3
import tomllib
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import attrs

from evoframe.contract.config import is_role
from evoframe.contract.values import Design
from evoframe.errors import InputError
from evoframe.files.reading import read_text, refuse_links
from evoframe.record.champion import LARGEST_DOCUMENT, champion_from_json, genomes_from_json, parsed_json
from evoframe.record.checksums import CHAINED, SINGLE, Checksums
from evoframe.record.store import CHAMPION_FILE, CONFIG_FILE, DATABASE_FILE, RUN_FORMAT, schema
from evoframe.record.verification import VERIFICATION_FILE, Verification, verification_from_json

__all__ = ["Champion", "Run", "has_begun", "load_run", "run_tables"]


@attrs.frozen(eq=False)
class Champion:
    """The best pair that was really simulated.

    Attributes:
        score: What the objective gave; a displacement in metres with all built-in objectives.
        design: Body and controller.
        simulation: The tables ``simulator`` and ``objective`` that it was simulated with.
        genomes: Population -> its genome, as its evolver dumps it.
    """

    score: float
    design: Design
    simulation: dict[str, Any]
    genomes: dict[str, Any] = attrs.field(repr=False)


@attrs.frozen
class Run:
    """A run's directory.

    Attributes:
        directory: Where it is.
        config: The resolved configuration, as TOML tables.
    """

    directory: Path
    config: dict[str, Any]

    @property
    def turns(self) -> list[dict[str, Any]]:
        """One row for each population that was judged in a turn: best, best_so_far, mean, ..."""
        return self.table("turns")

    @property
    def individuals(self) -> list[dict[str, Any]]:
        """One row for each individual of each turn."""
        return self.table("individuals")

    @property
    def pairs(self) -> list[dict[str, Any]]:
        """One row for each pair that was scored."""
        return self.table("pairs")

    @property
    def workload(self) -> list[dict[str, Any]]:
        """One row for each turn: pairs, simulations, seconds."""
        return self.table("workload")

    @property
    def summary(self) -> dict[str, Any]:
        """The final figures; empty as long as the run is not finished."""
        return {key: value for key, value in self._meta.items() if key not in _SETTLED}

    @property
    def finished(self) -> bool:
        """Whether the run has come to its end."""
        return bool(self.summary)

    @property
    def last_turn(self) -> int | None:
        """Index of the last turn that is saved; ``None`` if there is none."""
        rows = self.table("workload")
        return int(rows[-1]["turn"]) if rows else None

    @property
    def resumes(self) -> list[dict[str, Any]]:
        """One row for each time the run was resumed: after which turn, with which differences."""
        return self.table("resumes")

    @property
    def configuration(self) -> dict[str, Any]:
        """The tables that decide the run, as the database has them; must equal those of :attr:`config`."""
        configuration = self._meta.get("configuration")
        if not isinstance(configuration, dict):
            raise InputError(f"{self._database}: meta: has no configuration")
        return configuration

    @property
    def state(self) -> dict[str, Any]:
        """What the loop continues from; empty as long as no turn is saved.

        Raises:
            InputError: The database is damaged.
        """
        rows = self.table("state")
        return {row["part"]: self._json("state", row["part"], row["state"]) for row in rows}

    @property
    def _meta(self) -> dict[str, Any]:
        rows = self.table("meta")
        return {row["key"]: self._json("meta", row["key"], row["value"]) for row in rows}

    @property
    def _database(self) -> Path:
        return self.directory / DATABASE_FILE

    def _json(self, table: str, key: str, text: str) -> Any:
        try:
            return parsed_json(text)
        except ValueError as error:
            raise InputError(f"{self._database}: {table}: {key}: {error}") from error

    @property
    def champion(self) -> Champion:
        """The best pair so far.

        Raises:
            InputError: There is none yet, or the database is damaged.
        """
        document = self.champion_document
        if document is None:
            raise InputError(f"{self._database}: has no pair with a score yet")
        try:
            design, simulation, score = champion_from_json(document)
            genomes = genomes_from_json(document)
        except ValueError as error:
            raise InputError(f"{self._database}: best_pairs: {error}") from error
        return Champion(score, design, simulation, genomes)

    @property
    def champion_document(self) -> str | None:
        """The text of champion.json, without its last line end; ``None`` if there is no champion yet."""
        rows = self.table("best_pairs")
        return rows[-1]["document"] if rows else None

    @property
    def champion_is_written(self) -> bool:
        """Whether champion.json is what the database has; it may be behind where a run was killed."""
        path, document = self.directory / CHAMPION_FILE, self.champion_document
        if document is None:
            return True
        expected = f"{document}\n".encode()
        same_size = path.is_file() and path.stat().st_size == len(expected)
        return same_size and path.read_bytes() == expected

    @property
    def verification(self) -> Verification | None:
        """What became of the champion with one thing changed at a time; ``None`` if nobody has looked.

        Raises:
            InputError: The file is damaged, or is about another champion.
        """
        path = self.directory / VERIFICATION_FILE
        if not path.exists():
            return None
        text = read_text(path, LARGEST_DOCUMENT)
        try:
            verification = verification_from_json(parsed_json(text))
        except ValueError as error:
            raise InputError(f"{path}: {error}; {self._verify_again}") from error
        if verification.score != self.champion.score:
            raise InputError(f"{path}: is about another champion; {self._verify_again}")
        return verification

    @property
    def _verify_again(self) -> str:
        return f"to make it anew: evoframe verify {self.directory}"

    def damage(self) -> list[str]:
        """Return what SQLite finds wrong with the database's pages, tables and indices."""
        with _reading(self._database) as database:
            return [row[0] for row in database.execute("PRAGMA integrity_check") if row[0] != "ok"]

    def table(self, name: str) -> list[dict[str, Any]]:
        """Return the rows of a table of the database, in the order of their keys.

        Raises:
            InputError: The database cannot be read, or has no such table.
        """
        columns, rows = self._read(name)
        return [dict(zip(columns, row, strict=True)) for row in rows]

    def rows(self, name: str) -> list[tuple[Any, ...]]:
        """Return the rows of a table as they were saved.

        Raises:
            InputError: As :meth:`table`.
        """
        return self._read(name)[1]

    def _read(self, name: str) -> tuple[list[str], list[tuple[Any, ...]]]:
        """Return the columns and rows of a table, whose checksum was compared."""
        path = self._database
        with _reading(path) as database:
            database.execute("BEGIN")  # rows and checksums of one moment
            tables = _tables(database)
            if name not in tables:
                known = ", ".join(sorted(tables))
                raise InputError(f"{path}: has no table '{name}'; tables: {known}")
            found = database.execute(f'SELECT * FROM "{name}"')  # noqa: S608
            columns, rows = [column[0] for column in found.description], found.fetchall()
            if name in (*CHAINED, *SINGLE):
                _compare_checksums(path, name, rows, _checksums(database))
                _refuse_types(path, name, rows, _types(database, name))
            return columns, rows


def load_run(directory: str | Path) -> Run:
    """Return the run in *directory*.

    Raises:
        InputError: It is no run's directory, or one of another format.
    """
    directory = Path(directory)
    config = run_tables(directory)
    _refuse_other_databases(directory, config)
    run = Run(directory, config)
    run.table("meta")
    return run


def run_tables(directory: Path) -> dict[str, Any]:
    """Return the tables of a run's configuration, which is complete: it must not make us read other files.

    Raises:
        InputError: It is no run's directory, or has something in it that no run has.
    """
    path = directory / CONFIG_FILE
    refuse_links(directory)
    journal = directory / f"{DATABASE_FILE}-journal"
    if journal.exists():
        raise InputError(f"{journal}: is of another program, which has left {DATABASE_FILE} half written")
    if not path.is_file():
        raise InputError(f"{directory}: is no run's directory: there is no {CONFIG_FILE}")
    text = read_text(path, LARGEST_DOCUMENT)
    try:
        tables = tomllib.loads(text)
    except (ValueError, RecursionError) as error:
        raise InputError(f"{path}: not valid TOML: {error}") from error
    if tables.get("extends") is not False:
        found = repr(tables["extends"]) if "extends" in tables else "nothing"
        what = "extends: a run's configuration is complete"
        raise InputError(f"{path}: {what}; expected false, found {found}")
    if not isinstance(tables.get("provenance", {}), dict):
        raise InputError(f"{path}: provenance: expected a table, found {tables['provenance']!r}")
    return tables


def has_begun(directory: Path) -> bool:
    """Return whether a run's directory has a database with tables in it: not so after a very early kill.

    Raises:
        InputError: The database cannot be read.
    """
    path = directory / DATABASE_FILE
    if not path.is_file():
        return False
    with _reading(path) as database:
        return bool(_tables(database))


_SETTLED = ("format", "configuration")  # keys of meta that stand there from the beginning


def _refuse_other_databases(directory: Path, config: Mapping[str, Any]) -> None:
    """Look at the format first, since another may have other tables; beside ours there is nothing else.

    What a database says of its own form is read before anything else, and nothing is asked of a table that is
    not to the letter one of ours: a view may be called like one.
    """
    path, roles = directory / DATABASE_FILE, _roles(config)
    expected = schema(roles)
    with _reading(path) as database:
        statements = [row[0] for row in database.execute("SELECT sql FROM sqlite_master")]
        meta = [statement for statement in expected if statement in statements and " meta " in statement]
        asked = database.execute("SELECT value FROM meta WHERE key = 'format'") if meta else ()
        found = [row[0] for row in asked]
    if found != [str(RUN_FORMAT)]:
        what = f"the format {found[0]!r}" if found else "no format"
        raise InputError(
            f"{directory}: has {what}, but this evoframe reads format {RUN_FORMAT}; read it with the "
            f"evoframe that wrote it: {CONFIG_FILE} names its version under [provenance]"
        )
    if not roles or set(statements) != set(expected):
        raise InputError(f"{path}: is damaged: its tables are not those of a run with this {CONFIG_FILE}")


def _roles(config: Mapping[str, Any]) -> list[str]:
    """Return the populations of a configuration, which become names of columns; none if they cannot."""
    populations = config.get("populations")
    if not isinstance(populations, dict) or not all(map(is_role, populations)):
        return []
    return list(populations)


@contextlib.contextmanager
def _reading(path: Path) -> Iterator[sqlite3.Connection]:
    """Open a database that may come from anyone: nothing in it is trusted, and nothing is written.

    Raises:
        InputError: It cannot be read.
    """
    if not path.is_file():
        raise InputError(f"{path}: there is no such file")
    address = f"{path.absolute().as_uri()}?mode=ro"
    try:
        with contextlib.closing(sqlite3.connect(address, uri=True, isolation_level=None)) as database:
            database.execute("PRAGMA trusted_schema = OFF")
            database.setlimit(sqlite3.SQLITE_LIMIT_LENGTH, LARGEST_DOCUMENT << 20)
            database.setlimit(sqlite3.SQLITE_LIMIT_ATTACHED, 0)
            budget = iter(range(_STEPS_PER_BYTE * _size(path) // _STEPS + 100))
            database.set_progress_handler(lambda: next(budget, None) is None, _STEPS)
            yield database
    except (sqlite3.Error, OverflowError, UnicodeDecodeError) as error:
        raise InputError(f"{path}: cannot be read: {error}{_hint(path)}") from error


def _hint(path: Path) -> str:
    journal = path.with_name(f"{path.name}-wal")
    if not journal.is_file() or os.access(path.parent, os.W_OK):
        return ""
    return f"; to read what {journal.name} has, copy the directory to where it may be written"


# Pages that refer to each other in a made-up database may hold more rows than a computer can count.
_STEPS_PER_BYTE = 20  # of SQLite's machine: some fifty times what a table takes that is read whole
_STEPS = 100_000


def _size(path: Path) -> int:
    """Return the bytes of a database and of what was written beside it."""
    return sum(part.stat().st_size for part in (path, path.with_name(f"{path.name}-wal")) if part.is_file())


def _tables(database: sqlite3.Connection) -> list[str]:
    """Return the names of all tables: a view or a trigger is none, whatever it is called."""
    return [row[0] for row in database.execute("SELECT name FROM sqlite_master WHERE type = 'table'")]


def _checksums(database: sqlite3.Connection) -> dict[str, str]:
    return {
        str(name): checksum for name, checksum in database.execute("SELECT name, checksum FROM checksums")
    }


def _types(database: sqlite3.Connection, table: str) -> list[tuple[type, ...]]:
    """Return the types that the columns of one of our tables may have: SQLite itself takes any."""
    found = database.execute('SELECT type, "notnull", pk FROM pragma_table_info(?)', (table,))
    kinds: dict[str, type] = {"INTEGER": int, "REAL": float, "TEXT": str}
    return [
        (kinds[declared],) if needed or key else (kinds[declared], type(None))
        for declared, needed, key in found
    ]


def _refuse_types(
    path: Path, table: str, rows: Sequence[tuple[Any, ...]], types: Sequence[tuple[type, ...]]
) -> None:
    for row in rows:
        if not all(map(isinstance, row, types)):
            raise InputError(f"{path}: is damaged: {table} has a row with values of other types: {row}")


def _compare_checksums(
    path: Path, table: str, rows: Sequence[tuple[Any, ...]], saved: dict[str, str]
) -> None:
    """Refuse rows that are not those that were saved."""
    found = dict(Checksums.of_rows(table, rows)) if rows else {}
    expected = {name: saved[name] for name in saved if name.partition(":")[0] == table}
    wrong = sorted(name for name in found.keys() | expected.keys() if found.get(name) != expected.get(name))
    if wrong:
        raise InputError(f"{path}: is damaged: {', '.join(wrong)} is not what was saved")
