"""A run's directory: configuration, database, champion; one process writes, ordinary tools read."""

from __future__ import annotations

import contextlib
import json
import logging
import os
import sqlite3
import time
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, TypeAlias

import attrs

from evoframe.contract.values import Design, Pair, PopulationReport, Turn
from evoframe.errors import ComponentError, InputError, RunError
from evoframe.files.locks import Lock
from evoframe.record.champion import champion_document
from evoframe.record.checksums import Checksums

__all__ = [
    "CHAMPION_FILE",
    "CONFIG_FILE",
    "DATABASE_FILE",
    "RUN_FORMAT",
    "Store",
    "is_leftover",
    "remove",
    "schema",
    "write_atomically",
    "write_json",
]

RUN_FORMAT = 2
"""Version of the run directory; champion.json has its own."""

CHAMPION_FILE = "champion.json"
CONFIG_FILE = "config.toml"
DATABASE_FILE = "run.db"
_UNFINISHED = ".new"

Exports: TypeAlias = Callable[[Design], Mapping[str, bytes | None]]

_log = logging.getLogger(__name__)

# The way from and to the write-ahead log is one write of one page. A journal of it, left by a kill, could be
# undone by nobody who may only read, and names files that whoever undoes it touches.
_WITHOUT_A_JOURNAL = "PRAGMA journal_mode = MEMORY"

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
CREATE TABLE resumes (number INTEGER PRIMARY KEY, after_turn INTEGER, differences TEXT NOT NULL);
CREATE TABLE checksums (name TEXT PRIMARY KEY, checksum TEXT NOT NULL) WITHOUT ROWID;
"""


def schema(roles: Iterable[str]) -> list[str]:
    """Return the statements that make the tables of a run's database."""
    columns = ", ".join(f'"{role}" INTEGER NOT NULL' for role in roles)
    return [statement.strip() for statement in _SCHEMA.format(roles=columns).split(";") if statement.strip()]


@attrs.define
class Store:
    """The directory of a run that is being written, by this process and no other.

    All methods raise :class:`RunError` when the disk does not take what they write.

    Attributes:
        directory: The run's directory.
        simulation: What is needed to simulate the champion again, for its file.
        exports: Gives the champion as files of other programs: ending -> bytes, ``None`` for no file.
        last_turn: The last turn that is saved; -1 if there is none.
    """

    directory: Path
    simulation: Mapping[str, Any]
    exports: Exports
    _lock: Lock
    _database: sqlite3.Connection
    _checksums: Checksums = attrs.field(factory=Checksums, init=False)
    _changed: list[tuple[str, str]] = attrs.field(factory=list, init=False)
    last_turn: int = attrs.field(default=-1, init=False)
    _unwritten: tuple[Mapping[str, Any], Design] | None = attrs.field(default=None, init=False)
    _synced: float = attrs.field(factory=time.monotonic, init=False)

    @classmethod
    def open(
        cls, directory: Path, simulation: Mapping[str, Any], lock: Lock, exports: Exports = lambda _: {}
    ) -> Store:
        """Open the database of a directory, or make it; :meth:`begin` or :meth:`go_on` comes next.

        Raises:
            InputError: It cannot be written.
        """
        return cls(directory, simulation, exports, lock, _opened(directory / DATABASE_FILE))

    def begin(self, roles: Sequence[str], configuration: Mapping[str, Any]) -> None:
        """Lay the database out.

        Args:
            roles: Names of the populations, in order.
            configuration: The tables that decide the run, which must be the same when it goes on.
        """
        with self._transaction():
            for statement in schema(roles):
                self._database.execute(statement)
            self._replace("meta", [("format", str(RUN_FORMAT)), ("configuration", _json(configuration))])

    def go_on(self, rows: Mapping[str, Sequence[Sequence[Any]]], resume: Sequence[Any] | None) -> None:
        """Go on where a run was left, and note it.

        Args:
            rows: All rows of the tables that only grow, as they were read.
            resume: The row of this resume; ``None`` if no turn is left.
        """
        for table, saved in rows.items():
            self._checksums.add(table, saved)
        self.last_turn = rows["workload"][-1][0] if rows["workload"] else -1
        if resume is not None:
            with self._transaction():
                self._insert("resumes", [tuple(resume)])

    def save(self, turn: Turn, state: Mapping[str, Any]) -> None:
        """Save a turn and the state after it, both or neither; the files of a new champion may follow later.

        Args:
            turn: The turn.
            state: Part -> JSON values; parts that did not change may be left out.
        """
        champion = champion_document(turn.best_pair, self.simulation) if turn.best_pair else None
        with self._transaction():
            reports = sorted(turn.reports, key=lambda report: report.population)  # as the keys of the rows
            self._insert("turns", [_turn_row(turn.index, report) for report in reports])
            members = [row for report in reports for row in _individual_rows(turn.index, report)]
            self._insert("individuals", members)
            self._insert("pairs", _pair_rows(turn.index, turn.pairs))
            work = turn.workload
            self._insert("workload", [(turn.index, work.pairs, work.simulations, work.seconds)])
            if champion:
                self._insert("best_pairs", [(turn.index, champion["score"], _json(champion))])
            self._replace(
                "state", [(part, turn.index, _state(part, values)) for part, values in state.items()]
            )
        self.last_turn = turn.index
        if champion and turn.best_pair:
            self._unwritten = champion, turn.best_pair.design
        # A turn that takes long is likely to be followed by such a one.
        self._synchronise(at_once=work.seconds > _SYNC_INTERVAL / 4)

    def update_champion(self) -> None:
        """Write the files of the best pair that is saved, if they are those of an earlier one."""
        if self._unwritten is not None:
            self.save_champion(*self._unwritten)
            self._unwritten = None

    def save_champion(self, document: Mapping[str, Any], design: Design) -> None:
        """Write the champion's files, champion.json as the last: where it is written, all are."""
        for ending, data in self.exports(design).items():
            path = self.directory / f"champion.{ending}"
            if data is None:
                remove(path)
            else:
                write_atomically(path, data)
        write_json(self.directory / CHAMPION_FILE, document)

    def finish(self, result: Mapping[str, Any]) -> None:
        """Note the final figures."""
        self.update_champion()
        with self._transaction():
            self._replace("meta", [(key, _json(value)) for key, value in result.items()])

    def close(self) -> None:
        """Leave one self-contained database file, unless somebody is reading it just now."""
        with contextlib.ExitStack() as stack:
            stack.callback(self._lock.release)
            stack.callback(self._database.close)
            try:
                self._database.execute(_WITHOUT_A_JOURNAL)
            except sqlite3.Error as error:
                _log.info("%s: the journal stays beside the database: %s", self.directory, error)
            self.update_champion()

    def _insert(self, table: str, rows: Iterable[tuple[Any, ...]]) -> None:
        """Add rows to a table that only grows, in the order of their keys."""
        listed = list(rows)
        if listed:
            self._write("INSERT", table, listed)
            self._checksums.add(table, listed)
            self._changed.append(self._checksums.of(table))

    def _replace(self, table: str, rows: Sequence[tuple[Any, ...]]) -> None:
        """Put rows in place of those with the same keys."""
        self._write("INSERT OR REPLACE", table, rows)
        self._changed += [Checksums.of_row(table, row) for row in rows]

    def _write(self, verb: str, table: str, rows: Sequence[tuple[Any, ...]]) -> None:
        marks = ", ".join("?" * len(rows[0]))
        self._database.executemany(f"{verb} INTO {table} VALUES ({marks})", rows)

    @contextlib.contextmanager
    def _transaction(self) -> Iterator[None]:
        with self._writing():
            try:
                self._database.execute("BEGIN IMMEDIATE")
                yield
                self._write("INSERT OR REPLACE", "checksums", self._changed)
                self._database.execute("COMMIT")
            finally:
                self._changed.clear()
                if self._database.in_transaction:
                    self._database.execute("ROLLBACK")

    @contextlib.contextmanager
    def _writing(self) -> Iterator[None]:
        try:
            yield
        except sqlite3.Error as error:
            raise RunError(f"{self.directory}: the database cannot be written: {error}") from error

    def _synchronise(self, *, at_once: bool) -> None:
        if at_once or time.monotonic() - self._synced >= _SYNC_INTERVAL:
            with self._writing():
                self._database.execute("PRAGMA wal_checkpoint(PASSIVE)")
            self.update_champion()
            self._synced = time.monotonic()


def write_json(path: Path, document: Any) -> None:
    """Write JSON as :func:`write_atomically` does, always in the same way."""
    write_atomically(path, f"{_json(document)}\n".encode())


def write_atomically(path: Path, data: bytes) -> None:
    """Write a file so that a reader sees the old one or the new one, never a part.

    Raises:
        RunError: It cannot be written.
    """
    temporary = path.with_name(f".{path.name}{_UNFINISHED}")
    try:
        with temporary.open("wb") as file:
            file.write(data)
            file.flush()
            os.fsync(file.fileno())
        temporary.replace(path)
    except OSError as error:
        with contextlib.suppress(OSError):  # the first error is the one to tell
            temporary.unlink(missing_ok=True)
        raise RunError(f"{path}: cannot be written: {error.strerror}") from error


# What contains itself ends in a RecursionError.
_json = json.JSONEncoder(separators=(",", ":"), allow_nan=False, check_circular=False).encode


def is_leftover(path: Path) -> bool:
    """Return whether this is what a kill has left of the writing of a file."""
    return path.name.startswith(".") and path.name.endswith(_UNFINISHED)


def remove(path: Path) -> None:
    """Remove a file, if it is there.

    Raises:
        RunError: It cannot be removed.
    """
    try:
        path.unlink(missing_ok=True)
    except OSError as error:
        raise RunError(f"{path}: cannot be removed: {error.strerror}") from error


def _state(part: str, values: Any) -> str:
    try:
        return _json(values)
    except (TypeError, ValueError, RecursionError) as error:
        population = part.removeprefix("population/")
        evolver = f"populations.{population}.evolver"
        raise ComponentError(evolver, f"its state cannot be saved as JSON: {error}") from error


def _opened(path: Path) -> sqlite3.Connection:
    """Open a database that survives a kill at any moment; see ``_SYNC_INTERVAL`` for a power cut."""
    try:
        database = sqlite3.connect(path, isolation_level=None, check_same_thread=False)
        if database.execute("PRAGMA journal_mode").fetchone() != ("wal",):
            database.execute(_WITHOUT_A_JOURNAL)
        database.execute("PRAGMA journal_mode = WAL")
        database.execute("PRAGMA synchronous = NORMAL")
        database.execute("PRAGMA wal_autocheckpoint = 0")  # it has its own times, see _SYNC_INTERVAL
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
