"""Checksums of rows."""

from __future__ import annotations

import sqlite3

from hypothesis import HealthCheck, given, settings, strategies as st

from evoframe.record.checksums import Checksums

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
