"""Finished and unfinished runs, read back from their directories."""

from __future__ import annotations

import contextlib
import importlib
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import attrs

from evoframe.errors import InputError
from evoframe.files import LARGEST_DOCUMENT, parsed_json, parsed_toml, read_text, refuse_links
from evoframe.record.champion import Champion, champion_from_json
from evoframe.record.checksums import CHAINED, SINGLE
from evoframe.record.database import Database, Table
from evoframe.record.layout import CHAMPION_FILE, CONFIG_FILE, DATABASE_FILE, SETTLED, VERIFICATION_FILE
from evoframe.record.verification import Verification, verification_from_json

__all__ = ["Report", "Run", "load_run", "open_run", "open_unchecked"]


@attrs.frozen
class Report:
    """A report that was written.

    Attributes:
        directory: Where it is.
        words: Its conclusions, as ``conclusions.txt`` has them.
        files: All its files.
    """

    directory: Path
    words: str
    files: tuple[Path, ...]


@attrs.define
class Run:
    """A run's directory, read once: its configuration is checked, and so is each table when it is read.

    Within ``with open_run(directory) as run`` a table is read when it is first asked for. What
    :func:`load_run`, :func:`evoframe.run` and :func:`evoframe.resume` return has all of them.

    Attributes:
        directory: Its path.
        config: The resolved configuration, as TOML tables.
        begun: Whether the database has tables: not so after a very early kill.
    """

    directory: Path = attrs.field(on_setattr=attrs.setters.frozen)
    config: dict[str, Any] = attrs.field(on_setattr=attrs.setters.frozen, repr=False)
    begun: bool = attrs.field(default=True, eq=False, kw_only=True)
    _tables: dict[str, Table] = attrs.field(factory=dict, eq=False, repr=False, kw_only=True)
    _database: Database | None = attrs.field(default=None, eq=False, repr=False, kw_only=True)

    def turns(self) -> list[dict[str, Any]]:
        """Return a row for each population that was judged in a turn: best, best_so_far, mean, ..."""
        return self.table("turns")

    def individuals(self) -> list[dict[str, Any]]:
        """Return a row for each individual of each turn."""
        return self.table("individuals")

    def pairs(self) -> list[dict[str, Any]]:
        """Return a row for each pair that was scored."""
        return self.table("pairs")

    def workload(self) -> list[dict[str, Any]]:
        """Return a row for each turn: pairs, simulations, seconds."""
        return self.table("workload")

    def resumes(self) -> list[dict[str, Any]]:
        """Return a row for each time the run was resumed: after which turn, with which differences."""
        return self.table("resumes")

    def summary(self) -> dict[str, Any]:
        """Return the final figures; none as long as the run is not finished."""
        return {key: value for key, value in self._documents("meta").items() if key not in SETTLED}

    def finished(self) -> bool:
        """Return whether the run has come to its end."""
        return bool(self.summary())

    def last_turn(self) -> int | None:
        """Return the index of the last turn that is saved; ``None`` if there is none."""
        rows = self.rows("workload")
        return int(rows[-1][0]) if rows else None

    def configuration(self) -> dict[str, Any]:
        """Return the tables that decide the run, as the database has them; they must equal those of *config*.

        Raises:
            InputError: The database is damaged.
        """
        configuration = self._documents("meta").get("configuration")
        if not isinstance(configuration, dict):
            raise InputError(f"{self.directory / DATABASE_FILE}: meta: has no configuration")
        return configuration

    def state(self) -> dict[str, Any]:
        """Return what the loop continues from; empty as long as no turn is saved.

        Raises:
            InputError: The database is damaged.
        """
        return self._documents("state")

    def champion(self) -> Champion:
        """Return the best pair so far.

        Raises:
            InputError: There is none yet, or the database is damaged.
        """
        document, path = self.champion_document(), self.directory / DATABASE_FILE
        if document is None:
            raise InputError(f"{path}: has no pair with a score yet")
        try:
            return champion_from_json(document)
        except ValueError as error:
            raise InputError(f"{path}: best_pairs: {error}") from error

    def champion_document(self) -> str | None:
        """Return the text of champion.json, without its last line end; ``None`` before the first champion."""
        rows = self.table("best_pairs")
        return rows[-1]["document"] if rows else None

    def champion_is_written(self) -> bool:
        """Return whether champion.json is what the database has; it may be behind where a run was killed."""
        path, document = self.directory / CHAMPION_FILE, self.champion_document()
        if document is None:
            return True
        expected = f"{document}\n".encode()
        same_size = path.is_file() and path.stat().st_size == len(expected)
        return same_size and path.read_bytes() == expected

    def verification(self) -> Verification | None:
        """Return what became of the champion with one thing changed at a time; ``None`` if nobody has looked.

        Raises:
            InputError: The file is damaged, or is about another champion.
        """
        path = self.directory / VERIFICATION_FILE
        if not path.exists():
            return None
        again = f"to make it anew: evoframe verify {self.directory}"
        text = read_text(path, LARGEST_DOCUMENT)
        try:
            verification = verification_from_json(parsed_json(text))
        except ValueError as error:
            raise InputError(f"{path}: {error}; {again}") from error
        if verification.score != self.champion().score:
            raise InputError(f"{path}: is about another champion; {again}")
        return verification

    def report(self, out: str | Path | None = None, *, correction: str = "holm") -> Report:
        """Write the report of this run: see :func:`evoframe.report`."""
        public = importlib.import_module(
            "evoframe"
        )  # reports stand above the record: looked up when asked for
        report: Report = public.report(self, out=out, correction=correction)
        return report

    def check(self) -> None:
        """Look at the form of the database, before anything in it is read; :func:`open_run` has done so.

        Raises:
            InputError: It is of another format or run, or damaged.
        """
        self.begun = False  # unless it can be read
        self.begun = self._database is not None and bool(self._database.tables())
        if self._database is not None and self.begun:
            self._database.refuse_another(self.config)

    def damage(self) -> list[str]:
        """Return what SQLite finds wrong with the database; the run must be open."""
        return self._opened().damage()

    def read_all(self) -> None:
        """Read all tables, so that the run can be closed.

        Raises:
            InputError: A table is damaged.
        """
        for table in (*CHAINED, *SINGLE):
            self._read(table)

    def outdated(self) -> bool:
        """Return whether somebody has written since the run was opened; it must be open.

        What is read from now on is of now.
        """
        if self._database is None:
            return (self.directory / DATABASE_FILE).is_file()
        return self._database.renewed()

    def close(self) -> None:
        """Let others write; what was read stays."""
        if self._database is not None:
            self._database.close()

    def table(self, name: str) -> list[dict[str, Any]]:
        """Return the rows of a table of the database, column -> value, in the order of their keys.

        Raises:
            InputError: The database is damaged, or has no such table.
            ValueError: The run was closed before the table was read.
        """
        return self._read(name).records()

    def rows(self, name: str) -> Sequence[tuple[Any, ...]]:
        """Return the rows of a table as they were saved.

        Raises:
            InputError: As :meth:`table`.
            ValueError: As :meth:`table`.
        """
        return self._read(name).rows

    def _read(self, name: str) -> Table:
        if name not in self._tables:
            self._tables[name] = self._opened().read(name)
        return self._tables[name]

    def _opened(self) -> Database:
        if self._database is None:  # or it is a run of this process, which has no such table
            raise InputError(f"{self.directory / DATABASE_FILE}: there is no such file or table")
        if self._database.closed:
            raise ValueError(f"{self.directory}: this run was closed; read it within `with open_run(...)`")
        if not self.begun:
            self._database.refuse_another(self.config)
        return self._database

    def _documents(self, table: str) -> dict[str, Any]:
        """Return a table of JSON documents: the first column -> the last."""
        documents = {}
        for key, *_, text in self.rows(table):
            try:
                documents[key] = parsed_json(text)
            except ValueError as error:
                raise InputError(f"{self.directory / DATABASE_FILE}: {table}: {key}: {error}") from error
        return documents


@contextlib.contextmanager
def open_run(directory: str | Path) -> Iterator[Run]:
    """Open a run's directory: its configuration and the form of its database are read and checked, once.

    Raises:
        InputError: It is no run's directory, one of another format, or damaged.
    """
    with open_unchecked(directory) as run:
        run.check()
        yield run


@contextlib.contextmanager
def open_unchecked(directory: str | Path) -> Iterator[Run]:
    """Open a run's directory whose database nobody has looked at: call :meth:`Run.check` first.

    Raises:
        InputError: It is no run's directory, or its configuration is damaged.
    """
    directory = Path(directory)
    config, path = _config(directory), directory / DATABASE_FILE
    database = Database.opened(path) if path.is_file() else None
    run = Run(directory, config, database=database)
    try:
        yield run
    finally:
        run.close()


def load_run(directory: str | Path) -> Run:
    """Return the run in *directory*, all of it.

    Raises:
        InputError: As :func:`open_run`, or a table is damaged, or nothing was saved yet.
    """
    with open_run(directory) as run:
        run.read_all()
    return run


def _config(directory: Path) -> dict[str, Any]:
    """Return the tables of a run's configuration, which is complete: it must not make us read other files."""
    path = directory / CONFIG_FILE
    refuse_links(directory)
    journal = directory / f"{DATABASE_FILE}-journal"
    if journal.exists():
        raise InputError(f"{journal}: is of another program, which has left {DATABASE_FILE} half written")
    if not path.is_file():
        raise InputError(f"{directory}: is no run's directory: there is no {CONFIG_FILE}")
    tables = parsed_toml(read_text(path, LARGEST_DOCUMENT), str(path))
    if tables.get("extends") is not False:
        found = repr(tables["extends"]) if "extends" in tables else "nothing"
        what = "extends: a run's configuration is complete"
        raise InputError(f"{path}: {what}; expected false, found {found}")
    if not isinstance(tables.get("provenance", {}), dict):
        raise InputError(f"{path}: provenance: expected a table, found {tables['provenance']!r}")
    return tables
