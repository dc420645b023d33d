"""Rows are read back as they were saved, whenever writing stopped."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import attrs
import numpy as np
import pytest
from hypothesis import given, settings, strategies as st
from recorded import rows
from turns import CONFIG, begun, reopened, states, turns

from evoframe import BestPair, Design, RunError, Turn, Workload, load_run, open_run
from evoframe.errors import ComponentError
from evoframe.record.checksums import CHAINED, SINGLE
from evoframe.record.database import Table
from evoframe.record.store import Store

TABLES = (*CHAINED, *SINGLE)
STATE: dict[str, Any] = {"loop": {}}

New = Callable[[], Path]


@pytest.fixture(scope="module")
def new(tmp_path_factory: pytest.TempPathFactory) -> New:
    """Return a function that returns a new path for a directory."""
    return lambda: tmp_path_factory.mktemp("store") / "run"


def plain(tables: dict[str, Table]) -> dict[str, Any]:
    return {name: (table.columns, [tuple(row) for row in table.rows]) for name, table in tables.items()}


def turn(index: int = 0, score: float | None = None) -> Turn:
    best = None
    if score is not None:
        best = BestPair(index, score, {"a": 1, "b": 2}, {"a": 0.5}, Design({"a": np.array([score])}))
    return Turn(index, (), (), best, Workload(1, 1, 0.0))


def read(directory: Path) -> dict[str, Any]:
    with open_run(directory) as run:
        run.read_all()
        return {name: ([*run.table(name)], [*run.rows(name)]) for name in TABLES}


@settings(max_examples=20)
@given(played=turns(), state=states)
def test_rows_are_read_as_they_were_saved(new: New, played: list[Turn], state: dict[str, Any]) -> None:
    directory = new()
    store = begun(directory)
    for each in played:
        store.save(each, state)
    kept = store.tables()
    store.close()
    for name, (records, found) in read(directory).items():
        assert found == [tuple(row) for row in kept[name].rows], name
        assert records == kept[name].records()
    run = load_run(directory)
    assert run.state() == (state if played else {})
    assert run.configuration() == CONFIG
    assert run.last_turn() == (len(played) - 1 if played else None)
    assert [row["score"] for row in run.pairs()] == [pair.score for each in played for pair in each.pairs]
    assert [row["genome_id"] for row in run.individuals()] == [
        member.id for each in played for report in each.reports for member in report.members
    ]


@settings(max_examples=20)
@given(played=turns(), cut=st.integers(0, 4))
def test_a_run_that_is_continued_has_the_rows_and_checksums_of_one_that_never_stopped(
    new: New, played: list[Turn], cut: int
) -> None:
    whole, parted = new(), new()
    store = begun(whole)
    for each in played:
        store.save(each, {"loop": each.index})
    store.close()
    store = begun(parted)
    for each in played[:cut]:
        store.save(each, {"loop": each.index})
    store.close()
    with open_run(parted) as run:
        saved = {table: run.rows(table) for table in TABLES}
    store = reopened(parted)
    store.resume(saved, ["evoframe: 1 then, 2 now"])
    assert store.last_turn == min(cut, len(played)) - 1
    for each in played[cut:]:
        store.save(each, {"loop": each.index})
    store.close()
    for table in ("turns", "individuals", "pairs", "best_pairs", "workload", "state", "meta"):
        assert rows(whole, table) == rows(parted, table), table
    [resume] = load_run(parted).resumes()
    assert json.loads(resume["differences"]) == ["evoframe: 1 then, 2 now"]
    sums = [dict(rows(directory, "checksums")) for directory in (whole, parted)]
    assert sums[0] == {name: value for name, value in sums[1].items() if name != "resumes"}


class TestTurn:
    def test_that_cannot_be_saved_leaves_no_rows(self, new: New) -> None:
        directory = new()
        store = begun(directory)
        store.save(turn(0), {"loop": 0})
        with pytest.raises(RunError, match="JSON") as caught:
            store.save(turn(1, 2.5), {"loop": {1, 2}})
        assert caught.value.key == "loop"
        assert store.last_turn == 0
        store.close()
        run = load_run(directory)
        assert ([row["turn"] for row in run.workload()], run.state()) == ([0], {"loop": 0})
        assert not run.table("best_pairs")

    def test_with_an_unsavable_state_of_an_evolver_blames_the_evolver(self, new: New) -> None:
        store = begun(new())
        with pytest.raises(ComponentError) as caught:
            store.save(turn(), {"population/b": float("nan")})
        assert caught.value.component == "populations.b.evolver"
        store.close()

    def test_that_was_saved_twice_is_refused(self, new: New) -> None:
        directory = new()
        store = begun(directory)
        store.save(turn(), STATE)
        with pytest.raises(RunError, match="UNIQUE") as caught:
            store.save(turn(), STATE)
        assert caught.value.source == str(directory)
        store.close()
        assert len(load_run(directory).workload()) == 1


class TestChampion:
    def test_has_its_files_once_the_store_is_closed(self, new: New) -> None:
        directory = new()
        store = begun(directory, lambda design: {"txt": str(design.roles["a"].tolist()).encode()})
        store.save(turn(0, 1.5), STATE)
        store.save(turn(1, 2.5), STATE)
        store.close()
        assert (directory / "champion.txt").read_text() == "[2.5]"
        run = load_run(directory)
        assert run.champion_is_written()
        assert (run.champion().score, run.champion().design.roles["a"].tolist()) == (2.5, [2.5])

    def test_that_a_format_cannot_represent_keeps_no_file_of_an_earlier_one(self, new: New) -> None:
        directory = new()
        files = iter([b"first", None])
        store = begun(directory, lambda _: {"txt": next(files)})
        for index in range(2):
            store.save(turn(index, float(index)), STATE)
            store.update_champion()
        store.close()
        assert not (directory / "champion.txt").exists()
        assert load_run(directory).champion().score == 1.0

    def test_is_written_only_once(self, new: New) -> None:
        written: list[Design] = []

        def exports(design: Design) -> dict[str, bytes | None]:
            written.append(design)
            return {}

        store = begun(new(), exports)
        store.save(turn(0, 1.5), STATE)
        for _ in range(3):
            store.update_champion()
        store.finish({"turns": 0})
        store.close()
        assert len(written) == 1


def test_a_run_with_final_figures_is_finished(new: New) -> None:
    directory = new()
    store = begun(directory)
    store.save(turn(), STATE)
    assert not store.finished
    store.finish({"turns": 0, "best_pair_score": None})
    assert store.finished
    store.close()
    run = load_run(directory)
    assert run.finished()
    assert run.summary() == {"turns": 0, "best_pair_score": None}


def test_a_closed_store_leaves_one_file_and_no_lock(new: New) -> None:
    directory = new()
    store = begun(directory)
    store.save(turn(), STATE)
    assert (directory / "run.db-wal").exists()
    store.close()
    assert {path.name for path in directory.iterdir()} == {"config.toml", "run.db", "run.lock"}
    reopened(directory).close()


def test_zero_has_no_sign_as_in_the_database(new: New) -> None:
    directory = new()
    store = begun(directory)
    store.save(attrs.evolve(turn(), workload=Workload(0, 0, -0.0)), STATE)
    store.close()
    assert str(load_run(directory).workload()[0]["seconds"]) == "0.0"  # and its checksum is valid


def test_rows_in_memory_equal_those_in_the_file(new: New) -> None:
    store = begun(new())
    store.save(turn(0, 1.5), {"loop": 1})
    store.save(turn(1), {"loop": 2})
    kept = plain(store.tables())
    assert isinstance(store, Store)
    assert kept["state"][1] == [("loop", 1, "2")]
    assert [row[0] for row in kept["workload"][1]] == [0, 1]
    store.close()
