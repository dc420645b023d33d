"""Reading of finished and unfinished runs from their directories."""

from __future__ import annotations

import contextlib
import importlib
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import attrs

from evoframe.contract import deciding
from evoframe.documents import differences
from evoframe.errors import ConfigurationError, InputError
from evoframe.files import LARGEST_DOCUMENT, parsed_json, parsed_toml, read_text, refuse_links
from evoframe.record.champion import Champion, champion_from_json, joined_key
from evoframe.record.checksums import CHAINED, SINGLE
from evoframe.record.database import Database, Table
from evoframe.record.layout import CHAMPION_FILE, CONFIG_FILE, DATABASE_FILE, SETTLED, VERIFICATION_FILE
from evoframe.record.verification import Verification, verification_from_json

__all__ = ["Report", "Run", "load_run", "open_run", "open_unchecked"]


@attrs.frozen
class Report:
    """A written report.

    Attributes:
        directory: Its directory.
        words: Its conclusions, the text of ``conclusions.txt``.
        files: Paths of all its files.
    """

    directory: Path
    words: str
    files: tuple[Path, ...]


@attrs.define
class Run:
    """A run's directory. Its configuration is checked on opening, and each table when it is read.

    Inside ``with open_run(directory) as run`` each table is read on first use. Runs returned by
    :func:`load_run`, :func:`evoframe.run` and :func:`evoframe.resume` hold all tables.

    Attributes:
        directory: Its path.
        config: The resolved configuration, as TOML tables.
        begun: ``True`` if the database has tables; a kill at the very start can leave none.
    """

    directory: Path = attrs.field(on_setattr=attrs.setters.frozen)
    config: dict[str, Any] = attrs.field(on_setattr=attrs.setters.frozen, repr=False)
    begun: bool = attrs.field(default=True, eq=False, kw_only=True)
    _tables: dict[str, Table] = attrs.field(factory=dict, eq=False, repr=False, kw_only=True)
    _database: Database | None = attrs.field(default=None, eq=False, repr=False, kw_only=True)

    def turns(self) -> list[dict[str, Any]]:
        """Return a row for each population evaluated in each turn: best, best_so_far, mean, ..."""
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
        """Return a row for each resume: the last turn before it, and differences of versions or machine."""
        return self.table("resumes")

    def summary(self) -> dict[str, Any]:
        """Return the final figures; empty until the run is finished."""
        return {key: value for key, value in self._documents("meta").items() if key not in SETTLED}

    def finished(self) -> bool:
        """Return ``True`` if the run is finished."""
        return bool(self.summary())

    def last_turn(self) -> int | None:
        """Return the index of the last saved turn; ``None`` if no turn is saved."""
        rows = self.rows("workload")
        return int(rows[-1][0]) if rows else None

    def configuration(self) -> dict[str, Any]:
        """Return the tables that determine the result, as saved at the start; *config* must have the same.

        Raises:
            InputError: The database is damaged.
        """
        configuration = self._documents("meta").get("configuration")
        if not isinstance(configuration, dict):
            raise InputError("missing", source=self.directory / DATABASE_FILE, key="meta.configuration")
        return configuration

    def state(self) -> dict[str, Any]:
        """Return the state from which the run is resumed; empty until a turn is saved.

        Raises:
            InputError: The database is damaged.
        """
        return self._documents("state")

    def champion(self) -> Champion:
        """Return the best pair so far.

        Raises:
            InputError: No pair has a score yet, or the database is damaged.
        """
        document, path = self.champion_document(), self.directory / DATABASE_FILE
        if document is None:
            raise InputError("no pair has a score yet", source=path)
        try:
            return champion_from_json(document)
        except InputError as error:
            key = joined_key("best_pairs", error.key)
            raise InputError(error.problem, source=path, key=key) from error

    def champion_document(self) -> str | None:
        """Return the text of champion.json without the final newline; ``None`` before the first champion."""
        rows = self.table("best_pairs")
        return rows[-1]["document"] if rows else None

    def champion_is_written(self) -> bool:
        """Return ``True`` if champion.json equals the database; after a kill the file can be out of date."""
        path, document = self.directory / CHAMPION_FILE, self.champion_document()
        if document is None:
            return True
        expected = f"{document}\n".encode()
        same_size = path.is_file() and path.stat().st_size == len(expected)
        return same_size and path.read_bytes() == expected

    def verification(self) -> Verification | None:
        """Return the verification of the champion; ``None`` if it was not verified.

        Raises:
            InputError: The file is damaged, or verifies a different champion.
        """
        path = self.directory / VERIFICATION_FILE
        if not path.exists():
            return None
        hint = f"to verify again: evoframe verify {self.directory}"
        text = read_text(path, LARGEST_DOCUMENT)
        try:
            verification = verification_from_json(parsed_json(text))
        except ValueError as error:
            raise InputError(f"{error}; {hint}", source=path) from error
        except InputError as error:
            raise InputError(f"{error.problem}; {hint}", source=path, key=error.key) from error
        expected = self.champion().score
        if verification.score != expected:
            found = f"the champion scores {expected!r}, found the verification of {verification.score!r}"
            raise InputError(f"{found}; {hint}", source=path, key="score")
        return verification

    def report(
        self, out: str | Path | None = None, *, correction: str = "holm", force: bool = False
    ) -> Report:
        """Write the report of this run: see :func:`evoframe.report`."""
        public = importlib.import_module("evoframe")  # late, because reports depend on this module
        report: Report = public.report(self, out=out, correction=correction, force=force)
        return report

    def check(self) -> None:
        """Check the database before it is read, and its configuration; :func:`open_run` calls this.

        Raises:
            ConfigurationError: As :meth:`check_configuration`.
            InputError: As :meth:`check_database`.
        """
        self.check_database()
        self.check_configuration()

    def check_configuration(self) -> None:
        """Check that the configuration was not edited since the run started.

        Comments, provenance and the executor, which do not determine the result, may differ.

        Raises:
            ConfigurationError: Other settings differ; the text lists them.
            InputError: The database is damaged.
        """
        if not self.begun:
            return
        recorded, found = deciding(self.configuration()), deciding(self.config)
        if changes := differences(recorded, found, ("recorded", f"in {CONFIG_FILE}")):
            path = self.directory / CONFIG_FILE
            lines = [
                "was edited after the run started:",
                *changes,
                f"undo these changes, or start a new run: evoframe run {path}",
            ]
            raise ConfigurationError("\n  ".join(lines), source=path)

    def check_database(self) -> None:
        """Check the format and the tables of the database.

        Raises:
            InputError: The format or the tables differ, or the database is damaged.
        """
        self.begun = False  # remains False if the next line fails
        self.begun = self._database is not None and bool(self._database.tables())
        if self._database is not None and self.begun:
            self._database.refuse_another(self.config)

    def damage(self) -> list[str]:
        """Return the faults that SQLite finds in the database; the run must be open."""
        return self._opened().damage()

    def read_all(self) -> None:
        """Read all tables, so that they remain available after the run is closed.

        Raises:
            InputError: A table is damaged.
        """
        for table in (*CHAINED, *SINGLE):
            self._read(table)

    def outdated(self) -> bool:
        """Return ``True`` if the database was written to since the run was opened; the run must be open.

        Tables read from now on have their present content.
        """
        if self._database is None:
            return (self.directory / DATABASE_FILE).is_file()
        return self._database.refresh()

    def close(self) -> None:
        """Close the database, so that others can write; tables that were read remain available."""
        if self._database is not None:
            self._database.close()

    def table(self, name: str) -> list[dict[str, Any]]:
        """Return the rows of a table of the database as column -> value, in the order of their keys.

        Raises:
            InputError: The database is damaged, or has no such table.
            ValueError: The run was closed before the table was read.
        """
        return self._read(name).records()

    def rows(self, name: str) -> Sequence[tuple[Any, ...]]:
        """Return the rows of a table as tuples, in the order of their keys.

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
        if self._database is None:  # no file, or a run of this process, which holds all existing tables
            raise InputError("no such file or table", source=self.directory / DATABASE_FILE)
        if self._database.closed:
            raise ValueError(f"{self.directory}: the run is closed; read tables inside `with open_run(...)`")
        if not self.begun:
            self._database.refuse_another(self.config)
        return self._database

    def _documents(self, table: str) -> dict[str, Any]:
        """Return a table of JSON documents as first column -> last column."""
        documents = {}
        for key, *_, text in self.rows(table):
            try:
                documents[key] = parsed_json(text)
            except ValueError as error:
                path = self.directory / DATABASE_FILE
                raise InputError(str(error), source=path, key=f"{table}.{key}") from error
        return documents


@contextlib.contextmanager
def open_run(directory: str | Path) -> Iterator[Run]:
    """Open a run's directory, and check its configuration and the format and tables of its database.

    Raises:
        ConfigurationError: Its configuration was edited after the run started.
        InputError: It is not a run's directory, has a different format, or is damaged.
    """
    with open_unchecked(directory) as run:
        run.check()
        yield run


@contextlib.contextmanager
def open_unchecked(directory: str | Path) -> Iterator[Run]:
    """Open a run's directory without checking its database: call :meth:`Run.check` first.

    Raises:
        InputError: It is not a run's directory, or its configuration is damaged.
    """
    directory = Path(directory)
    config, path = _config(directory), directory / DATABASE_FILE
    database = Database.open(path) if path.is_file() else None
    run = Run(directory, config, database=database)
    try:
        yield run
    finally:
        run.close()


def load_run(directory: str | Path) -> Run:
    """Return the run in *directory* with all its tables.

    Raises:
        ConfigurationError: As :func:`open_run`.
        InputError: As :func:`open_run`, or a table is damaged, or nothing is saved yet.
    """
    with open_run(directory) as run:
        run.read_all()
    return run


def _config(directory: Path) -> dict[str, Any]:
    """Return the tables of a run's configuration; one that extends another file is refused."""
    path = directory / CONFIG_FILE
    refuse_links(directory)
    journal = directory / f"{DATABASE_FILE}-journal"
    if journal.exists():
        raise InputError(
            f"leftover rollback journal: another program modified {DATABASE_FILE}", source=journal
        )
    if not path.is_file():
        problem = f"not a run directory: no {CONFIG_FILE}" if directory.exists() else "does not exist"
        raise InputError(problem, source=directory)
    tables = parsed_toml(read_text(path, LARGEST_DOCUMENT), str(path))
    if tables.get("extends") is not False:
        found = repr(tables["extends"]) if "extends" in tables else "nothing"
        problem = f"expected false, because the configuration of a run is complete; found {found}"
        raise InputError(problem, source=path, key="extends")
    if not isinstance(tables.get("provenance", {}), dict):
        found = repr(tables["provenance"])
        raise InputError(f"expected a table, found {found}", source=path, key="provenance")
    return tables
