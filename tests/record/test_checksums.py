"""Checksums depend on the saved rows and on nothing else."""

from __future__ import annotations

import sqlite3

import pytest
from hypothesis import HealthCheck, given, settings, strategies as st

from evoframe.record.checksums import CHAINED, SINGLE, Checksums

values = st.none() | st.integers(-(2**62), 2**62) | st.floats(allow_nan=False) | st.text(max_size=4)


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.lists(st.lists(values, min_size=1, max_size=3), max_size=6), st.integers(0, 6))
def test_a_checksum_does_not_depend_on_how_rows_arrive(given_rows: list[list[object]], cut: int) -> None:
    whole, parts = Checksums(), Checksums()
    whole.add("pairs", given_rows)
    parts.add("pairs", given_rows[:cut])
    parts.add("pairs", given_rows[cut:])
    assert whole.of("pairs") == parts.of("pairs")
    with sqlite3.connect(":memory:") as database:
        database.execute("CREATE TABLE t (a)")
        flat = [(row[0],) for row in given_rows]
        database.executemany("INSERT INTO t VALUES (?)", flat)
        read = database.execute("SELECT a FROM t").fetchall()
    database.close()
    written, found = Checksums(), Checksums()
    written.add("pairs", flat)
    found.add("pairs", read)
    assert written.of("pairs") == found.of("pairs")


rows = st.lists(st.tuples(st.integers(0, 9), values), max_size=5)


@given(rows, rows)
def test_other_rows_have_another_checksum(
    first: list[tuple[object, ...]], second: list[tuple[object, ...]]
) -> None:
    checksums = []
    for each in (first, second):
        grown = Checksums()
        grown.add("pairs", each)
        checksums.append(grown.of("pairs"))
    assert (checksums[0] == checksums[1]) == (repr(first) == repr(second))


@given(rows)
def test_rows_that_are_read_have_the_checksum_with_which_they_were_written(
    written: list[tuple[object, ...]],
) -> None:
    grown = Checksums()
    grown.add("pairs", written)
    assert dict(Checksums.of_rows("pairs", written)) == dict([grown.of("pairs")])
    replaced = {row[0]: row for row in written}.values()
    assert dict(Checksums.of_rows("state", replaced)) == dict(
        Checksums.of_row("state", row) for row in replaced
    )


def test_tables_have_independent_checksums() -> None:
    grown = Checksums()
    before = grown.of("turns")
    grown.add("pairs", [(1, 2.5)])
    assert grown.of("turns") == before
    assert grown.of("pairs")[1] != before[1]


def test_a_replaceable_row_is_named_by_its_key() -> None:
    assert Checksums.of_row("state", ("loop", 3, "{}"))[0] == "state:loop"
    assert Checksums.of_row("state", ("loop", 3, "{}")) != Checksums.of_row("state", ("loop", 4, "{}"))


def test_an_unknown_table_has_no_checksum() -> None:
    assert list(Checksums.of_rows("notes", [(1,)])) == []
    assert not set(CHAINED) & set(SINGLE)


@pytest.mark.parametrize("table", ["pairs", "state"])
def test_the_bytes_of_a_damaged_database_have_a_checksum_too(table: str) -> None:
    [(_, damaged)] = Checksums.of_rows(table, [(b"\xff", 1)])
    [(_, intact)] = Checksums.of_rows(table, [("x", 1)])
    assert damaged != intact
