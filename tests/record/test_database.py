"""A database that is read: of one moment, of one run, and of nobody's making but evoframe's."""

from __future__ import annotations

import contextlib
import sqlite3
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from recorded import rewritten
from turns import CONFIG, begun, reopened

from evoframe import InputError, Turn, Workload
from evoframe.record.checksums import CHAINED, SINGLE
from evoframe.record.database import Database
from evoframe.record.store import Store

Open = Callable[[], Database]


@pytest.fixture
def directory(tmp_path: Path) -> Path:
    store = begun(tmp_path / "run")
    store.save(turn(0), {"loop": {"turn": 0}})
    store.close()
    return tmp_path / "run"


@pytest.fixture
def opened(directory: Path) -> Iterator[Open]:
    with contextlib.ExitStack() as stack:

        def open_it() -> Database:
            database = Database.opened(directory / "run.db")
            stack.callback(database.close)
            return database

        yield open_it


def changed(directory: Path, *statements: str) -> None:
    with contextlib.closing(sqlite3.connect(directory / "run.db", isolation_level=None)) as database:
        for statement in statements:
            database.execute(statement)


def turn(index: int) -> Turn:
    return Turn(index, (), (), None, Workload(1, 1, 0.25))


def test_a_table_is_read_with_its_columns_in_the_order_of_its_keys(opened: Open, directory: Path) -> None:
    store = reopened(directory)
    with contextlib.closing(Database.opened(directory / "run.db")) as database:
        saved = {name: database.read(name).rows for name in (*CHAINED, *SINGLE)}
    store.go_on(saved, [])
    store.save(turn(1), {"loop": {"turn": 1}})
    store.close()
    table = opened().read("workload")
    assert table.columns == ("turn", "pairs", "simulations", "seconds")
    assert [*table.rows] == [(0, 1, 1, 0.25), (1, 1, 1, 0.25)]
    assert table.records()[1] == {"turn": 1, "pairs": 1, "simulations": 1, "seconds": 0.25}


def test_an_unknown_table_is_answered_with_those_that_there_are(opened: Open) -> None:
    with pytest.raises(
        InputError, match=r"has no table 'turn'; tables: best_pairs, checksums, individuals, "
    ):
        opened().read("turn")


class TestMoment:
    """Of a run that goes on meanwhile."""

    @pytest.fixture
    def store(self, tmp_path: Path) -> Iterator[Store]:
        store = begun(tmp_path / "going-on")
        store.save(turn(0), {"loop": 0})
        yield store
        store.close()

    @pytest.fixture
    def database(self, store: Store) -> Iterator[Database]:
        with contextlib.closing(Database.opened(store.directory / "run.db")) as database:
            yield database

    def test_is_that_of_the_first_look(self, store: Store, database: Database) -> None:
        assert len(database.read("workload").rows) == 1
        store.save(turn(1), {"loop": 1})
        assert len(database.read("workload").rows) == 1
        assert database.read("state").rows == [("loop", 0, "0")]

    def test_is_renewed_on_demand_and_whether_anything_happened_is_said(
        self, store: Store, database: Database
    ) -> None:
        assert database.tables()
        assert not database.renewed()
        store.save(turn(1), {"loop": 1})
        assert database.renewed()
        assert not database.renewed()
        assert len(database.read("workload").rows) == 2


class TestRefusal:
    @pytest.mark.parametrize(
        ("statement", "message"),
        [
            ("UPDATE workload SET pairs = 2", "is damaged: workload is not what was saved"),
            ("DELETE FROM workload", "is damaged: workload is not what was saved"),
            ("DELETE FROM checksums WHERE name = 'workload'", "is damaged: workload is not what was saved"),
            ("INSERT INTO workload VALUES (9, 1, 1, 0.5)", "is damaged: workload is not what was saved"),
        ],
    )
    def test_of_rows_that_are_not_those_that_were_saved(
        self, opened: Open, directory: Path, statement: str, message: str
    ) -> None:
        changed(directory, statement)
        with pytest.raises(InputError, match=message):
            opened().read("workload")

    def test_of_one_row_names_it(self, opened: Open, directory: Path) -> None:
        changed(directory, "UPDATE state SET state = '{}'")
        with pytest.raises(InputError, match=r"is damaged: state:loop is not what was saved"):
            opened().read("state")

    def test_of_values_of_other_types_whatever_their_checksums_say(
        self, opened: Open, directory: Path
    ) -> None:
        rewritten(directory, "UPDATE workload SET seconds = 'long'")
        with pytest.raises(
            InputError, match=r"workload has a row with values of other types: \(0, 1, 1, 'long'\)"
        ):
            opened().read("workload")

    @pytest.mark.parametrize(
        ("statements", "message"),
        [
            (["DROP TABLE pairs"], "its tables are not those of a run with this config.toml"),
            (["CREATE TABLE more (x)"], "its tables are not those of a run"),
            (["CREATE VIEW more AS SELECT 1"], "its tables are not those of a run"),
            (
                ["DROP TABLE meta", "CREATE VIEW meta AS SELECT 'format' AS key, '2' AS value"],
                "has no format",
            ),
            (["UPDATE meta SET value = '1' WHERE key = 'format'"], "has the format '1', but this evoframe"),
        ],
    )
    def test_of_the_database_of_something_else(
        self, opened: Open, directory: Path, statements: list[str], message: str
    ) -> None:
        changed(directory, *statements)
        with pytest.raises(InputError, match=message):
            opened().refuse_another(CONFIG)

    @pytest.mark.parametrize("populations", [{"a": {}}, {"a": {}, "c": {}}, {"b": {}, "a": {}}])
    def test_of_the_database_of_other_populations(self, opened: Open, populations: dict[str, Any]) -> None:
        opened().refuse_another(CONFIG)
        with pytest.raises(InputError, match="its tables are not those of a run"):
            opened().refuse_another({**CONFIG, "populations": populations})

    @pytest.mark.parametrize("populations", [None, [], {'a" INTEGER); --': {}}])
    def test_of_populations_that_could_be_no_columns(self, opened: Open, populations: Any) -> None:
        with pytest.raises(InputError, match=r"this evoframe reads format|its tables are not those of a run"):
            opened().refuse_another({**CONFIG, "populations": populations})

    def test_of_what_is_no_database(self, directory: Path, opened: Open) -> None:
        (directory / "run.db").write_bytes(b"no database" * 100)
        with pytest.raises(InputError, match=r"run\.db: cannot be read: file is not a database"):
            opened().tables()


def test_nothing_is_written_and_nothing_attached(opened: Open, directory: Path) -> None:
    connection = opened()._connection
    with pytest.raises(sqlite3.OperationalError, match="readonly"):
        connection.execute("DELETE FROM meta")
    with pytest.raises(sqlite3.OperationalError, match="too many attached"):
        connection.execute("ATTACH ':memory:' AS other")


def test_a_statement_without_end_is_stopped(opened: Open) -> None:
    endless = "WITH RECURSIVE n(x) AS (SELECT 1 UNION ALL SELECT x + 1 FROM n) SELECT max(x) FROM n"
    with pytest.raises(InputError, match="cannot be read: interrupted"):
        opened()._fetched(endless)


def test_a_sound_database_has_no_damage(opened: Open) -> None:
    assert opened().damage() == []
