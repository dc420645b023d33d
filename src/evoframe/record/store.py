"""Writing of a run's directory: database and champion. One process writes; any tool can read."""

from __future__ import annotations

import contextlib
import json
import logging
import sqlite3
import time
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, TypeAlias

import attrs

from evoframe.contract import Design, PopulationReport, Turn
from evoframe.errors import ComponentError, InputError, RunError
from evoframe.files import Lock, json_text, remove, write_atomically, write_json
from evoframe.record.champion import champion_document
from evoframe.record.checksums import CHAINED, SINGLE, Checksums
from evoframe.record.database import Table
from evoframe.record.layout import CHAMPION_FILE, DATABASE_FILE, RUN_FORMAT, SETTLED, schema

__all__ = ["Store"]

Exports: TypeAlias = Callable[[Design], Mapping[str, bytes | None]]

_log = logging.getLogger(__name__)

# Entering or leaving write-ahead logging writes one page, so it needs no rollback journal in a file. Such a
# file, left by a kill, would stop readers without write permission, and can name files to be modified.
_WITHOUT_A_JOURNAL = "PRAGMA journal_mode = MEMORY"

_SYNC_INTERVAL = 1.0  # s; a power cut loses at most the turns since the last synchronization


@attrs.define
class Store:
    """The directory of a run, to which only this process writes.

    All methods raise :class:`RunError` if writing fails.

    Attributes:
        directory: The run's directory.
        simulation: The tables needed to simulate the champion again, for its file.
        exports: Converts the champion to files of other programs: suffix -> bytes, ``None`` for no file.
        last_turn: Index of the last saved turn; -1 if no turn is saved.
    """

    directory: Path
    simulation: Mapping[str, Any]
    exports: Exports
    _lock: Lock
    _database: sqlite3.Connection
    _rows: dict[str, dict[Any, tuple[Any, ...]]] = attrs.field(factory=dict, init=False, repr=False)
    _checksums: Checksums = attrs.field(factory=Checksums, init=False)
    _changed: list[tuple[str, str]] = attrs.field(factory=list, init=False)
    last_turn: int = attrs.field(default=-1, init=False)
    _broken: bool = attrs.field(default=False, init=False)
    _unwritten: tuple[Mapping[str, Any], Design] | None = attrs.field(default=None, init=False)
    _synced: float = attrs.field(factory=time.monotonic, init=False)

    @classmethod
    def open(
        cls, directory: Path, simulation: Mapping[str, Any], lock: Lock, exports: Exports = lambda _: {}
    ) -> Store:
        """Open or create the database of a directory; :meth:`begin` or :meth:`resume` must follow.

        Raises:
            InputError: The database cannot be written.
        """
        return cls(directory, simulation, exports, lock, _open_database(directory / DATABASE_FILE))

    def begin(self, roles: Sequence[str], configuration: Mapping[str, Any]) -> None:
        """Create the tables of the database.

        Args:
            roles: Names of the populations, in order.
            configuration: The tables that determine the result; they must be the same on a resume.
        """
        with self._transaction():
            for statement in schema(roles):
                self._database.execute(statement)
            self._replace("meta", [("format", str(RUN_FORMAT)), ("configuration", json_text(configuration))])

    def resume(self, rows: Mapping[str, Sequence[tuple[Any, ...]]], differences: Sequence[str]) -> None:
        """Continue after the last saved turn, and record the resume unless the run is finished.

        Args:
            rows: Table -> its rows, as read.
            differences: Changes of versions and machine since the run started.
        """
        for table, saved in rows.items():
            self._keep(table, saved)
            if table in CHAINED:
                self._checksums.add(table, saved)
        if rows["workload"]:
            self.last_turn = rows["workload"][-1][0]
        if not self.finished:
            with self._transaction():
                after = None if self.last_turn < 0 else self.last_turn
                self._insert("resumes", [(len(rows["resumes"]), after, json.dumps(list(differences)))])

    @property
    def finished(self) -> bool:
        """``True`` if the final figures are saved."""
        return bool(self._rows["meta"].keys() - SETTLED)

    def tables(self) -> dict[str, Table]:
        """Return all tables as they would be read back; the store must be open."""
        tables = {}
        for name in (*CHAINED, *SINGLE):
            with self._writing():
                none = self._database.execute(f'SELECT * FROM "{name}" LIMIT 0')  # noqa: S608 - a constant name
            columns = tuple(column[0] for column in none.description)
            tables[name] = Table(columns, [row for _, row in sorted(self._rows.get(name, {}).items())])
        return tables

    def save(self, turn: Turn, state: Mapping[str, Any]) -> None:
        """Save a turn and the state after it in one transaction; files of a new champion can follow later.

        Args:
            turn: The turn.
            state: Part -> JSON values; unchanged parts can be omitted.
        """
        champion = champion_document(turn.best_pair, self.simulation) if turn.best_pair else None
        with self._transaction():
            reports = sorted(turn.reports, key=lambda report: report.population)  # the order of the keys
            index, work = turn.index, turn.workload
            self._insert(
                "turns",
                (
                    (index, r.population, r.generation, r.best, r.best_so_far, r.standing_champion, r.mean)
                    for r in reports
                ),
            )
            self._insert(
                "individuals",
                (
                    (
                        index,
                        r.population,
                        i,
                        m.id,
                        m.species,
                        m.genome_size,
                        m.age,
                        m.fitness,
                        int(m.diverged),
                    )
                    for r in reports
                    for i, m in enumerate(r.members)
                ),
            )
            self._insert("measures", (row for r in reports for row in _measures(index, r)))
            pairs = enumerate(turn.pairs)
            self._insert("pairs", ((index, i, *p.genomes, p.score, p.diverged_at) for i, p in pairs))
            self._insert("workload", [(index, work.pairs, work.simulations, work.seconds)])
            if champion:
                self._insert("best_pairs", [(index, champion["score"], json_text(champion))])
            self._replace("state", [(part, index, _state(part, values)) for part, values in state.items()])
        self.last_turn = index
        if champion and turn.best_pair:
            self._unwritten = champion, turn.best_pair.design
        # After a slow turn the next one is probably slow too, so do not wait for it.
        self._synchronize(at_once=work.seconds > _SYNC_INTERVAL / 4)

    def update_champion(self) -> None:
        """Write the champion's files, unless they are up to date."""
        if self._unwritten is not None:
            self.save_champion(*self._unwritten)
            self._unwritten = None

    def save_champion(self, document: Mapping[str, Any], design: Design) -> None:
        """Write the champion's files, with champion.json last: its presence means that all are written."""
        for ending, data in self.exports(design).items():
            path = self.directory / f"champion.{ending}"
            if data is None:
                remove(path)
            else:
                write_atomically(path, data)
        write_json(self.directory / CHAMPION_FILE, document)

    def finish(self, result: Mapping[str, Any]) -> None:
        """Save the final figures."""
        self.update_champion()
        with self._transaction():
            self._replace("meta", [(key, json_text(value)) for key, value in result.items()])

    def close(self) -> None:
        """Unlock the directory; merge the write-ahead log into the database unless a reader has it open."""
        with contextlib.ExitStack() as stack:
            stack.callback(self._lock.release)
            stack.callback(self._database.close)
            try:
                self._database.execute(_WITHOUT_A_JOURNAL)
            except sqlite3.Error as error:
                _log.info(
                    "%s: the write-ahead log could not be merged into the database: %s", self.directory, error
                )
            self.update_champion()

    def _insert(self, table: str, rows: Iterable[tuple[Any, ...]]) -> None:
        """Append rows to an append-only table, in the order of their keys."""
        listed = [tuple(_as_stored(row)) for row in rows]
        if listed:
            self._write("INSERT", table, listed)
            self._keep(table, listed)
            self._checksums.add(table, listed)
            self._changed.append(self._checksums.of(table))

    def _replace(self, table: str, rows: Sequence[tuple[Any, ...]]) -> None:
        """Insert rows, replacing those with the same keys."""
        if not rows:
            return
        self._write("INSERT OR REPLACE", table, rows)
        self._keep(table, rows)
        self._changed += [Checksums.of_row(table, row) for row in rows]

    def _keep(self, table: str, rows: Iterable[tuple[Any, ...]]) -> None:
        """Keep rows in memory too, so that they need not be read back."""
        kept = self._rows.setdefault(table, {})
        for row in rows:
            kept[row[0] if table in SINGLE else len(kept)] = row

    def _write(self, verb: str, table: str, rows: Sequence[tuple[Any, ...]]) -> None:
        marks = ", ".join("?" * len(rows[0]))
        self._database.executemany(f"{verb} INTO {table} VALUES ({marks})", rows)

    @contextlib.contextmanager
    def _transaction(self) -> Iterator[None]:
        if self._broken:  # rows in memory differ from those in the database
            raise RunError("cannot save turns after a failed write", source=self.directory)
        with self._writing():
            self._broken = True
            try:
                self._database.execute("BEGIN IMMEDIATE")
                yield
                self._write("INSERT OR REPLACE", "checksums", self._changed)
                self._database.execute("COMMIT")
                self._broken = False
            finally:
                self._changed.clear()
                if self._database.in_transaction:
                    self._database.execute("ROLLBACK")

    @contextlib.contextmanager
    def _writing(self) -> Iterator[None]:
        try:
            yield
        except sqlite3.Error as error:
            raise RunError(f"cannot write the database: {error}", source=self.directory) from error

    def _synchronize(self, *, at_once: bool) -> None:
        if at_once or time.monotonic() - self._synced >= _SYNC_INTERVAL:
            with self._writing():
                self._database.execute("PRAGMA wal_checkpoint(PASSIVE)")
            self.update_champion()
            self._synced = time.monotonic()


def _measures(turn: int, report: PopulationReport) -> Iterator[tuple[Any, ...]]:
    """Yield a row for each measure of each member, in the order of their keys."""
    names = sorted(report.measures)
    for position in range(len(report.members)):
        for name in names:
            yield turn, report.population, position, name, report.measures[name][position]


def _as_stored(row: tuple[Any, ...]) -> list[Any]:
    """Return the values of a row as SQLite stores them: it drops the sign of zero."""
    return [value + 0.0 if isinstance(value, float) else value for value in row]


def _state(part: str, values: Any) -> str:
    """Return a part of the state as JSON text; blame its evolver if it cannot be JSON."""
    try:
        return json_text(values)
    except (TypeError, ValueError) as error:
        kind, _, population = part.partition("/")
        problem = f"its state cannot be saved as JSON: {error}"
        if kind == "population":
            raise ComponentError(f"populations.{population}.evolver", problem) from error
        raise RunError(problem, key=part) from error


def _open_database(path: Path) -> sqlite3.Connection:
    """Open a database so that it survives a kill at any moment; for power cuts see ``_SYNC_INTERVAL``."""
    try:
        database = sqlite3.connect(path, isolation_level=None, check_same_thread=False)
        if database.execute("PRAGMA journal_mode").fetchone() != ("wal",):
            database.execute(_WITHOUT_A_JOURNAL)
        database.execute("PRAGMA journal_mode = WAL")
        database.execute("PRAGMA synchronous = NORMAL")
        database.execute("PRAGMA wal_autocheckpoint = 0")  # done by _synchronize
    except sqlite3.Error as error:
        raise InputError(f"cannot be written: {error}", source=path) from error
    return database
