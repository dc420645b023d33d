"""The tables of a run's database, with a column for each population."""

from __future__ import annotations

import contextlib
import sqlite3

import pytest

from evoframe.record.checksums import CHAINED, SINGLE
from evoframe.record.layout import schema


def columns(roles: list[str]) -> dict[str, list[str]]:
    """Return the tables that SQLite creates from the statements, and their columns."""
    with contextlib.closing(sqlite3.connect(":memory:")) as database:
        for statement in schema(roles):
            database.execute(statement)
        tables = [row[0] for row in database.execute("SELECT name FROM sqlite_master WHERE type = 'table'")]
        return {
            table: [row[0] for row in database.execute("SELECT name FROM pragma_table_info(?)", [table])]
            for table in tables
        }


def test_every_table_but_that_of_the_checksums_has_checksums() -> None:
    assert set(columns(["a", "b"])) == {*CHAINED, *SINGLE, "checksums"}


@pytest.mark.parametrize(
    "roles", [["a", "b"], ["morphology", "controller"], ["b", "a", "with-hyphen_1", "select"]]
)
def test_every_population_has_a_column_of_pairs_in_their_order(roles: list[str]) -> None:
    assert columns(roles)["pairs"] == ["turn", "pair", *roles, "score", "diverged_at"]


def test_sqlite_keeps_the_statements_unchanged() -> None:
    """This allows comparing a database with them character for character."""
    with contextlib.closing(sqlite3.connect(":memory:")) as database:
        for statement in schema(["a", "b"]):
            database.execute(statement)
        kept = [row[0] for row in database.execute("SELECT sql FROM sqlite_master WHERE sql IS NOT NULL")]
    assert kept == schema(["a", "b"])
