"""Reading of a database: one snapshot, one run, and only databases written by evoframe."""

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
            database = Database.open(directory / "run.db")
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
    with contextlib.closing(Database.open(directory / "run.db")) as database:
        saved = {name: database.read(name).rows for name in (*CHAINED, *SINGLE)}
    store.resume(saved, [])
    store.save(turn(1), {"loop": {"turn": 1}})
    store.close()
    table = opened().read("workload")
    assert table.columns == ("turn", "pairs", "simulations", "seconds")
    assert [*table.rows] == [(0, 1, 1, 0.25), (1, 1, 1, 0.25)]
    assert table.records()[1] == {"turn": 1, "pairs": 1, "simulations": 1, "seconds": 0.25}


def test_the_error_for_an_unknown_table_lists_the_tables(opened: Open, directory: Path) -> None:
    with pytest.raises(InputError, match=r"'turn'.*: best_pairs, checksums, individuals, ") as caught:
        opened().read("turn")
    assert caught.value.source == str(directory / "run.db")


class TestSnapshot:
    """The snapshot of a run that is being written."""

    @pytest.fixture
    def store(self, tmp_path: Path) -> Iterator[Store]:
        store = begun(tmp_path / "playing")
        store.save(turn(0), {"loop": 0})
        yield store
        store.close()

    @pytest.fixture
    def database(self, store: Store) -> Iterator[Database]:
        with contextlib.closing(Database.open(store.directory / "run.db")) as database:
            yield database

    def test_is_that_of_the_first_read(self, store: Store, database: Database) -> None:
        assert len(database.read("workload").rows) == 1
        store.save(turn(1), {"loop": 1})
        assert len(database.read("workload").rows) == 1
        assert database.read("state").rows == [("loop", 0, "0")]

    def test_is_refreshed_on_demand(self, store: Store, database: Database) -> None:
        assert database.tables()
        assert not database.refresh()
        store.save(turn(1), {"loop": 1})
        assert database.refresh()
        assert not database.refresh()
        assert len(database.read("workload").rows) == 2


class TestRefusal:
    @pytest.mark.parametrize(
        "statement",
        [
            "UPDATE workload SET pairs = 2",
            "DELETE FROM workload",
            "DELETE FROM checksums WHERE name = 'workload'",
            "INSERT INTO workload VALUES (9, 1, 1, 0.5)",
        ],
    )
    def test_of_rows_that_differ_from_the_saved_ones(
        self, opened: Open, directory: Path, statement: str
    ) -> None:
        changed(directory, statement)
        with pytest.raises(InputError, match="checksum") as caught:
            opened().read("workload")
        assert (caught.value.source, caught.value.key) == (str(directory / "run.db"), "workload")

    def test_of_one_row_names_it(self, opened: Open, directory: Path) -> None:
        changed(directory, "UPDATE state SET state = '{}'")
        with pytest.raises(InputError, match="checksum") as caught:
            opened().read("state")
        assert caught.value.key == "state:loop"

    def test_of_values_of_wrong_types_with_valid_checksums(self, opened: Open, directory: Path) -> None:
        rewritten(directory, "UPDATE workload SET seconds = 'long'")
        with pytest.raises(InputError, match=r"types: \(0, 1, 1, 'long'\)") as caught:
            opened().read("workload")
        assert caught.value.key == "workload"

    @pytest.mark.parametrize(
        "statement", ["DROP TABLE pairs", "CREATE TABLE more (x)", "CREATE VIEW more AS SELECT 1"]
    )
    def test_of_a_database_with_different_tables(self, opened: Open, directory: Path, statement: str) -> None:
        changed(directory, statement)
        with pytest.raises(InputError, match=r"config\.toml") as caught:
            opened().refuse_another(CONFIG)
        assert (caught.value.source, caught.value.key) == (str(directory / "run.db"), "")

    @pytest.mark.parametrize(
        ("statements", "found"),
        [
            (["DROP TABLE meta", "CREATE VIEW meta AS SELECT 'format' AS key, '3' AS value"], "none"),
            (["UPDATE meta SET value = '2' WHERE key = 'format'"], "'2'"),
        ],
    )
    def test_of_a_different_format(
        self, opened: Open, directory: Path, statements: list[str], found: str
    ) -> None:
        changed(directory, *statements)
        with pytest.raises(InputError, match=f"3, found {found};") as caught:
            opened().refuse_another(CONFIG)
        assert (caught.value.source, caught.value.key) == (str(directory / "run.db"), "meta.format")

    @pytest.mark.parametrize("populations", [{"a": {}}, {"a": {}, "c": {}}, {"b": {}, "a": {}}])
    def test_of_the_database_of_other_populations(self, opened: Open, populations: dict[str, Any]) -> None:
        opened().refuse_another(CONFIG)
        with pytest.raises(InputError) as caught:
            opened().refuse_another({**CONFIG, "populations": populations})
        assert caught.value.key == ""

    @pytest.mark.parametrize("populations", [None, [], {'a" INTEGER); --': {}}])
    def test_of_populations_that_cannot_be_columns(
        self, opened: Open, directory: Path, populations: Any
    ) -> None:
        with pytest.raises(InputError) as caught:
            opened().refuse_another({**CONFIG, "populations": populations})
        assert caught.value.source == str(directory / "run.db")

    def test_of_a_file_that_is_not_a_database(self, directory: Path, opened: Open) -> None:
        (directory / "run.db").write_bytes(b"no database" * 100)
        with pytest.raises(InputError) as caught:
            opened().tables()
        assert caught.value.source == str(directory / "run.db")
        assert isinstance(caught.value.__cause__, sqlite3.DatabaseError)


def test_nothing_is_written_and_nothing_attached(opened: Open, directory: Path) -> None:
    connection = opened()._connection
    with pytest.raises(sqlite3.OperationalError, match="readonly"):
        connection.execute("DELETE FROM meta")
    with pytest.raises(sqlite3.OperationalError, match="too many attached"):
        connection.execute("ATTACH ':memory:' AS other")


def test_an_endless_statement_is_interrupted(opened: Open) -> None:
    endless = "WITH RECURSIVE n(x) AS (SELECT 1 UNION ALL SELECT x + 1 FROM n) SELECT max(x) FROM n"
    with pytest.raises(InputError, match="interrupted"):
        opened()._fetched(endless)


def test_an_intact_database_has_no_damage(opened: Open) -> None:
    assert opened().damage() == []
