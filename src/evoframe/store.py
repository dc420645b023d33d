"""A run's directory: configuration, database, champion; one process writes, ordinary tools read."""

from __future__ import annotations

import contextlib
import json
import logging
import os
import sqlite3
import time
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any

from evoframe.champion import FORMAT, champion_document
from evoframe.errors import InputError, RunError
from evoframe.values import Design, Pair, PopulationReport, Turn

__all__ = ["Store", "write_atomically", "write_json"]

_log = logging.getLogger(__name__)

_SYNC_INTERVAL = 1.0  # s; a power cut loses at most what was written since the last synchronisation

_SCHEMA = """
CREATE TABLE meta (key TEXT PRIMARY KEY, value TEXT NOT NULL) WITHOUT ROWID;
CREATE TABLE turns (
    turn INTEGER, population TEXT, generation INTEGER NOT NULL,
    best REAL NOT NULL, best_so_far REAL NOT NULL, standing_champion REAL NOT NULL, mean REAL NOT NULL,
    PRIMARY KEY (turn, population)
) WITHOUT ROWID;
CREATE TABLE individuals (
    turn INTEGER, population TEXT, position INTEGER, genome_id INTEGER NOT NULL, species INTEGER,
    genome_size INTEGER NOT NULL, age INTEGER NOT NULL, fitness REAL NOT NULL, diverged INTEGER NOT NULL,
    PRIMARY KEY (turn, population, position)
) WITHOUT ROWID;
CREATE TABLE pairs (
    turn INTEGER, pair INTEGER, {roles}, score REAL, diverged_at INTEGER,
    PRIMARY KEY (turn, pair)
) WITHOUT ROWID;
CREATE TABLE best_pairs (turn INTEGER PRIMARY KEY, score REAL NOT NULL, document TEXT NOT NULL);
CREATE TABLE state (part TEXT PRIMARY KEY, turn INTEGER NOT NULL, state TEXT NOT NULL) WITHOUT ROWID;
CREATE TABLE workload (
    turn INTEGER PRIMARY KEY, pairs INTEGER NOT NULL, simulations INTEGER NOT NULL, seconds REAL NOT NULL
);
"""


class Store:
    """The directory of a run that is being written.

    Args:
        directory: The run's directory.
        roles: Names of the populations, in order.
        simulation: What is needed to simulate the champion again, for its file.
        exports: Gives the champion as files of other programs: ending -> bytes, ``None`` for no file.

    Raises:
        InputError: The directory belongs to another run, or cannot be written.
        RunError: Raised by all methods when the disk does not take what they write.
    """

    def __init__(
        self,
        directory: Path,
        roles: list[str],
        simulation: Mapping[str, Any],
        exports: Callable[[Design], Mapping[str, bytes | None]] = lambda _: {},
    ) -> None:
        self.directory = directory
        self.simulation = simulation
        self.exports = exports
        self._database = _new_database(directory / "run.db")
        with self._transaction():
            columns = ", ".join(f'"{role}" INTEGER NOT NULL' for role in roles)
            for statement in _SCHEMA.format(roles=columns).split(";"):
                self._database.execute(statement)
            self._database.execute("INSERT INTO meta VALUES ('format', ?)", (str(FORMAT),))
        self._synced = time.monotonic()

    def save_config(self, text: str) -> None:
        """Write the resolved configuration."""
        write_atomically(self.directory / "config.toml", text.encode())

    def save(self, turn: Turn, state: Mapping[str, Any]) -> None:
        """Save a turn and the state after it, both or neither; then the champion's files, if it is a new one.

        Args:
            turn: The turn.
            state: Part -> JSON values; parts that did not change may be left out.
        """
        champion = champion_document(turn.best_pair, self.simulation) if turn.best_pair else None
        with self._transaction():
            self._insert("turns", (_turn_row(turn.index, report) for report in turn.reports))
            for report in turn.reports:
                self._insert("individuals", _individual_rows(turn.index, report))
            self._insert("pairs", _pair_rows(turn.index, turn.pairs))
            work = turn.workload
            self._insert("workload", [(turn.index, work.pairs, work.simulations, work.seconds)])
            if champion:
                self._insert("best_pairs", [(turn.index, champion["score"], _json(champion))])
            for part, values in state.items():
                row = (part, turn.index, _json(values))
                self._database.execute("INSERT OR REPLACE INTO state VALUES (?, ?, ?)", row)
        if champion and turn.best_pair:
            self._save_champion(champion, turn.best_pair.design)
        self._synchronise()

    def _save_champion(self, document: Mapping[str, Any], design: Design) -> None:
        """Write the champion's files; none of an earlier one stays."""
        write_json(self.directory / "champion.json", document)
        for ending, data in self.exports(design).items():
            path = self.directory / f"champion.{ending}"
            if data is None:
                path.unlink(missing_ok=True)
            else:
                write_atomically(path, data)

    def finish(self, result: Mapping[str, Any]) -> None:
        """Note the final figures."""
        with self._transaction():
            for key, value in result.items():
                row = (key, _json(value))
                self._database.execute("INSERT OR REPLACE INTO meta VALUES (?, ?)", row)

    def close(self) -> None:
        """Leave one self-contained database file, unless somebody is reading it just now."""
        try:
            self._database.execute("PRAGMA journal_mode = DELETE")
        except sqlite3.Error as error:
            _log.info("%s: the journal stays beside the database: %s", self.directory, error)
        self._database.close()

    def _insert(self, table: str, rows: Iterator[tuple[Any, ...]] | list[tuple[Any, ...]]) -> None:
        listed = list(rows)
        if listed:
            marks = ", ".join("?" * len(listed[0]))
            self._database.executemany(f"INSERT INTO {table} VALUES ({marks})", listed)  # noqa: S608 - our names

    @contextlib.contextmanager
    def _transaction(self) -> Iterator[None]:
        with self._writing():
            try:
                self._database.execute("BEGIN IMMEDIATE")
                yield
                self._database.execute("COMMIT")
            finally:
                if self._database.in_transaction:
                    self._database.execute("ROLLBACK")

    @contextlib.contextmanager
    def _writing(self) -> Iterator[None]:
        try:
            yield
        except sqlite3.Error as error:
            raise RunError(f"{self.directory}: the database cannot be written: {error}") from error

    def _synchronise(self) -> None:
        if time.monotonic() - self._synced >= _SYNC_INTERVAL:
            with self._writing():
                self._database.execute("PRAGMA wal_checkpoint(PASSIVE)")
            self._synced = time.monotonic()


def write_json(path: Path, document: Any) -> None:
    """Write JSON as :func:`write_atomically` does, always in the same way."""
    write_atomically(path, f"{_json(document)}\n".encode())


def write_atomically(path: Path, data: bytes) -> None:
    """Write a file so that a reader sees the old one or the new one, never a part.

    Raises:
        RunError: It cannot be written.
    """
    temporary = path.with_name(f".{path.name}.new")
    try:
        with temporary.open("wb") as file:
            file.write(data)
            file.flush()
            os.fsync(file.fileno())
        temporary.replace(path)
    except OSError as error:
        temporary.unlink(missing_ok=True)
        raise RunError(f"{path}: cannot be written: {error.strerror}") from error


def _json(value: Any) -> str:
    return json.dumps(value, separators=(",", ":"), allow_nan=False)


def _new_database(path: Path) -> sqlite3.Connection:
    """Open a database that survives a kill at any moment; see ``_SYNC_INTERVAL`` for a power cut."""
    try:
        path.touch(exist_ok=False)  # whoever makes it owns the directory
    except FileExistsError as error:
        raise InputError(f"{path.parent}: is in use by another run") from error
    except OSError as error:
        raise InputError(f"{path}: cannot be written: {error.strerror}") from error
    try:
        database = sqlite3.connect(path, isolation_level=None, check_same_thread=False)
        database.execute("PRAGMA journal_mode = WAL")
        database.execute("PRAGMA synchronous = NORMAL")
    except sqlite3.Error as error:
        raise InputError(f"{path}: cannot be written: {error}") from error
    return database


def _turn_row(turn: int, report: PopulationReport) -> tuple[Any, ...]:
    return (
        turn,
        report.population,
        report.generation,
        report.best,
        report.best_so_far,
        report.standing_champion,
        report.mean,
    )


def _individual_rows(turn: int, report: PopulationReport) -> Iterator[tuple[Any, ...]]:
    for position, member in enumerate(report.members):
        yield (
            turn,
            report.population,
            position,
            member.id,
            member.species,
            member.genome_size,
            member.age,
            member.fitness,
            int(member.diverged),
        )


def _pair_rows(turn: int, pairs: tuple[Pair, ...]) -> Iterator[tuple[Any, ...]]:
    for index, pair in enumerate(pairs):
        yield (turn, index, *pair.genomes, pair.score, pair.diverged_at)
