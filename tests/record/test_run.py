"""Reading of runs: opened once, tables read on first use, and complete when returned."""

from __future__ import annotations

import contextlib
import sqlite3
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from turns import CONFIG, begun

from evoframe import (
    BestPair,
    ConfigurationError,
    Design,
    InputError,
    Run,
    RunConfig,
    Turn,
    Workload,
    load_run,
    open_run,
    run,
)
from evoframe.files.locks import acquire_lock
from evoframe.record.run import open_unchecked
from evoframe.record.store import Store

Load = Callable[..., RunConfig]


class TestRefusal:
    def test_a_directory_that_is_not_a_run_is_refused(self, tmp_path: Path) -> None:
        with pytest.raises(InputError, match=r"config\.toml") as caught:
            load_run(tmp_path)
        assert (caught.value.source, caught.value.key) == (str(tmp_path), "")
        (tmp_path / "config.toml").write_text("[run]")
        with pytest.raises(InputError, match="nothing") as caught:
            load_run(tmp_path)
        assert (caught.value.source, caught.value.key) == (str(tmp_path / "config.toml"), "extends")
        (tmp_path / "config.toml").write_text("extends = false")
        with pytest.raises(InputError, match="no such") as caught:
            load_run(tmp_path)
        assert caught.value.source == str(tmp_path / "run.db")
        (tmp_path / "run.db").write_text("not a database, but long enough for its header" * 10)
        with pytest.raises(InputError) as caught:
            load_run(tmp_path)
        assert caught.value.source == str(tmp_path / "run.db")
        assert isinstance(caught.value.__cause__, sqlite3.DatabaseError)

    def test_another_format_is_refused(self, toy_config: Load, tmp_path: Path) -> None:
        finished = run(toy_config(), out=tmp_path / "run")
        with contextlib.closing(sqlite3.connect(finished.directory / "run.db")) as database, database:
            database.execute("UPDATE meta SET value = '99' WHERE key = 'format'")
        with pytest.raises(InputError, match=r"3, found '99';") as caught:
            load_run(finished.directory)
        assert (caught.value.source, caught.value.key) == (str(finished.directory / "run.db"), "meta.format")


def turn(index: int, score: float | None = None) -> Turn:
    best = None if score is None else BestPair(index, score, {}, {}, Design({}))
    return Turn(index, (), (), best, Workload(1, 1, 0.25))


@pytest.fixture
def store(tmp_path: Path) -> Iterator[Store]:
    """The open store of a run with one saved turn."""
    store = begun(tmp_path / "run")
    store.save(turn(0), {"loop": {"turn": 0}})
    yield store
    store.close()


@pytest.fixture
def left(store: Store) -> Path:
    """The directory of a run that was interrupted after its first turn."""
    store.close()
    return store.directory


EDITED = (
    ("generations = 4", "generations = 5", "run.generations: 4 recorded, 5 in config.toml"),
    ("size = 6", "size = 6.5", "populations.a.size: 6 recorded, 6.5 in config.toml"),
    ("generations = 4\n", "", "run.generations: 4 recorded, not set in config.toml"),
    ("generations = 4", "generations = 4\nlonger = 1", "run.longer: not set recorded, 1 in config.toml"),
    (
        'name = "toy-mean"',
        'name = "toy-other"',
        "aggregator.name: 'toy-mean' recorded, 'toy-other' in config.toml",
    ),
)


class TestEditedConfiguration:
    @pytest.fixture
    def finished(self, toy_config: Load, tmp_path: Path) -> Path:
        return run(toy_config(), out=tmp_path / "run").directory

    @pytest.mark.parametrize(("before", "after", "line"), EDITED)
    def test_is_refused_with_the_differences(
        self, finished: Path, before: str, after: str, line: str
    ) -> None:
        path = finished / "config.toml"
        assert path.read_text().count(before) == 1
        path.write_text(path.read_text().replace(before, after))
        for read in (load_run, lambda directory: open_run(directory).__enter__()):
            with pytest.raises(ConfigurationError) as caught:
                read(finished)
            assert caught.value.source == str(path)
            assert caught.value.problem.splitlines()[1:-1] == [f"  {line}"]
        with open_unchecked(finished) as opened:
            opened.check_database()
            with pytest.raises(ConfigurationError):
                opened.check_configuration()

    @pytest.mark.parametrize(
        ("before", "after"),
        [
            ("generations = 4", "generations=4 # turns: 8"),
            ("[provenance]\n", "[provenance]\nnote = 'mine'\n"),
            ('name = "toy-here"', 'name = "toy-there"\nworkers = 4'),
        ],
        ids=["comment", "provenance", "executor"],
    )
    def test_may_differ_in_what_does_not_determine_the_result(
        self, finished: Path, before: str, after: str
    ) -> None:
        path = finished / "config.toml"
        assert path.read_text().count(before) == 1
        path.write_text(path.read_text().replace(before, after))
        assert load_run(finished).finished()

    def test_is_not_compared_before_anything_was_recorded(self, finished: Path) -> None:
        (finished / "run.db").write_bytes(b"")
        path = finished / "config.toml"
        path.write_text(path.read_text().replace("generations = 4", "generations = 5"))
        with open_run(finished) as opened:
            assert not opened.begun


class TestOpened:
    def test_keeps_only_the_tables_that_were_read_before_it_was_closed(self, left: Path) -> None:
        with open_run(left) as opened:
            assert opened.last_turn() == 0
        assert opened.workload() == [{"turn": 0, "pairs": 1, "simulations": 1, "seconds": 0.25}]
        with pytest.raises(ValueError, match=r"is closed.*open_run"):
            opened.pairs()

    def test_keeps_all_tables_if_all_were_read_before_it_was_closed(self, left: Path) -> None:
        with open_run(left) as opened:
            opened.read_all()
        assert (opened.pairs(), opened.state(), opened.summary()) == ([], {"loop": {"turn": 0}}, {})
        assert opened.configuration() == CONFIG
        assert not opened.finished()

    def test_is_closed_after_an_error(self, left: Path) -> None:
        with pytest.raises(ZeroDivisionError), open_run(left) as opened:
            raise ZeroDivisionError
        with pytest.raises(ValueError, match="is closed"):
            opened.turns()

    def test_is_one_snapshot_until_it_is_refreshed(self, store: Store) -> None:
        with open_run(store.directory) as opened:
            assert not opened.outdated()
            store.save(turn(1), {"loop": {"turn": 1}})
            assert opened.outdated()
            assert opened.last_turn() == 1  # not read before

    def test_lets_others_write_when_it_is_closed(self, left: Path) -> None:
        with open_run(left) as opened:
            opened.read_all()
            opened.close()
            Store.open(left, {}, acquire_lock(left)).close()

    def test_equals_another_of_the_same_directory_and_configuration(self, left: Path) -> None:
        assert load_run(left) == load_run(left)
        with open_run(left) as opened:
            assert opened == load_run(left)


class TestEarlyKill:
    """A kill before anything was saved."""

    @pytest.fixture(params=["missing", "empty"])
    def nothing(self, left: Path, request: pytest.FixtureRequest) -> Path:
        (left / "run.db").unlink()
        if request.param == "empty":
            (left / "run.db").touch()
        return left

    def test_leaves_a_run_that_has_not_begun(self, nothing: Path) -> None:
        with open_run(nothing) as opened:
            assert not opened.begun
            assert not opened.outdated()

    def test_leaves_nothing_to_read(self, nothing: Path) -> None:
        with pytest.raises(InputError):
            load_run(nothing)

    def test_may_be_followed_by_another_process(self, left: Path) -> None:
        (left / "run.db").unlink()
        with open_run(left) as opened:
            store = Store.open(left, {}, acquire_lock(left))
            assert opened.outdated()
            store.close()


class TestChampion:
    def test_is_missing_before_the_first_pair_with_a_score(self, left: Path) -> None:
        opened = load_run(left)
        assert opened.champion_document() is None
        assert opened.champion_is_written()  # there is none to write
        with pytest.raises(InputError, match="no pair") as caught:
            opened.champion()
        assert caught.value.source == str(left / "run.db")

    def test_is_the_latest(self, store: Store) -> None:
        for index, score in ((1, 1.5), (2, 2.5)):
            store.save(turn(index, score), {"loop": {}})
        store.close()
        assert load_run(store.directory).champion().score == 2.5

    @pytest.mark.parametrize("content", [None, b"", b"{}\n"])
    def test_counts_as_written_only_if_its_file_is_equal(self, store: Store, content: bytes | None) -> None:
        store.save(turn(1, 1.5), {"loop": {}})
        store.close()
        assert load_run(store.directory).champion_is_written()
        path = store.directory / "champion.json"
        path.unlink()
        if content is not None:
            path.write_bytes(content)
        assert not load_run(store.directory).champion_is_written()


class TestDirectory:
    def test_with_a_journal_of_another_program_is_refused(self, left: Path) -> None:
        (left / "run.db-journal").touch()
        with pytest.raises(InputError) as caught:
            load_run(left)
        assert caught.value.source == str(left / "run.db-journal")

    def test_with_a_link_is_refused(self, left: Path, tmp_path: Path) -> None:
        (left / "notes").symlink_to(tmp_path)
        with pytest.raises(InputError, match=r"notes: .* link"):
            load_run(left)

    @pytest.mark.parametrize(
        ("text", "key", "data"),
        [
            ('extends = "paper"', "extends", "'paper'"),
            ("extends = false\nprovenance = 3", "provenance", "3"),
            ("extends = ", "", "TOML"),
        ],
    )
    def test_with_an_invalid_configuration_is_refused(
        self, left: Path, text: str, key: str, data: str
    ) -> None:
        (left / "config.toml").write_text(text)
        with pytest.raises(InputError, match=rf"config\.toml: .*{data}") as caught, open_run(left):
            pass
        assert key in str(caught.value)

    def test_with_an_unchecked_database_is_refused_when_it_is_checked(self, left: Path) -> None:
        (left / "run.db").write_bytes(b"no database" * 100)
        with open_unchecked(left) as opened:
            with pytest.raises(InputError) as caught:
                opened.check()
            assert caught.value.source == str(left / "run.db")
            assert not opened.begun

    def test_can_be_given_as_path_or_string(self, left: Path) -> None:
        assert load_run(str(left)) == load_run(left)
        assert isinstance(load_run(left), Run)
