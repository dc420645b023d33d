"""Runs that go on: the same end, whatever happened, and what keeps them from going on."""

from __future__ import annotations

import json
import shutil
import sqlite3
from collections.abc import Callable
from pathlib import Path

import pytest
import toys
from opening import configuration_of, has_begun, reopened
from recorded import assert_same_result, rewritten, rows

import evoframe.record.provenance
from evoframe import ConfigurationError, InputError, Plugins, RunConfig, RunError, load_run, resume, run
from evoframe.contract.config import Source
from evoframe.files.locks import acquire_lock
from evoframe.record.store import Store
from evoframe.runs.starting import prepare

Load = Callable[..., RunConfig]


def stop_after(turns: int) -> Callable[[], bool]:
    left = iter(range(turns - 1, -1, -1))
    return lambda: next(left) == 0


def stopped(config: RunConfig, directory: Path, after: int) -> Path:
    """Leave a run after so many turns."""
    execution = prepare(config, Plugins(), directory)
    assert not execution.play(stop_after(after)).finished()
    return directory


@pytest.fixture
def left(toy_config: Load, tmp_path: Path) -> Path:
    return stopped(toy_config(), tmp_path / "left", 4)


@pytest.mark.parametrize("turn", range(1, 9))
def test_ends_as_if_it_had_never_been_left(
    toy_config: Load, toy_plugins: Plugins, tmp_path: Path, turn: int
) -> None:
    undisturbed = run(toy_config(), out=tmp_path / "undisturbed")
    resumed = resume(stopped(toy_config(), tmp_path / "left", turn), plugins=toy_plugins)
    assert_same_result(undisturbed.directory, resumed.directory)
    assert [(row["turn"], row["pairs"]) for row in resumed.workload()] == [
        (row["turn"], row["pairs"]) for row in undisturbed.workload()
    ]
    assert [(row["number"], row["after_turn"], row["differences"]) for row in resumed.resumes()] == [
        (0, turn - 1, "[]")
    ]


def test_a_run_of_the_paper_goes_on_with_other_workers(tmp_path: Path) -> None:
    settings = {"seed": 4, "run.generations": 4}
    undisturbed = run("quick", out=tmp_path / "undisturbed", workers=2, **settings)  # type: ignore[arg-type]
    config = evoframe.load_config(
        "quick", overrides=["run.seed=4", "run.generations=4", "executor.workers=1"]
    )
    resumed = resume(stopped(config, tmp_path / "left", 5), workers=3)
    assert_same_result(undisturbed.directory, resumed.directory)
    assert resumed.verification() is not None


def test_what_a_kill_left_beside_the_database_is_mended(
    toy_config: Load, toy_plugins: Plugins, tmp_path: Path, left: Path
) -> None:
    undisturbed = run(toy_config(), out=tmp_path / "undisturbed")
    (left / "champion.json").write_text("old")
    (left / ".champion.json.new").write_text("half")
    resumed = resume(left, plugins=toy_plugins)
    assert_same_result(undisturbed.directory, resumed.directory)
    assert not (left / ".champion.json.new").exists()


@pytest.mark.parametrize("database", ["missing", "empty"])
def test_a_run_that_was_killed_before_its_first_transaction_begins(
    toy_config: Load, toy_plugins: Plugins, tmp_path: Path, left: Path, database: str
) -> None:
    undisturbed = run(toy_config(), out=tmp_path / "undisturbed")
    (left / "run.db").unlink()
    (left / "champion.json").unlink()
    if database == "empty":
        (left / "run.db").touch()
    assert not has_begun(left)
    assert_same_result(undisturbed.directory, resume(left, plugins=toy_plugins).directory)


def test_a_finished_run_whose_champion_is_missing_gets_it_again(
    toy_config: Load, toy_plugins: Plugins, tmp_path: Path
) -> None:
    finished = run(toy_config(), out=tmp_path / "run")
    champion = (tmp_path / "run" / "champion.json").read_bytes()
    (tmp_path / "run" / "champion.json").unlink()
    assert resume(tmp_path / "run", plugins=toy_plugins).summary() == finished.summary()
    assert (tmp_path / "run" / "champion.json").read_bytes() == champion


def test_a_finished_run_stays_as_it_is(toy_config: Load, toy_plugins: Plugins, tmp_path: Path) -> None:
    finished = run(toy_config(), out=tmp_path / "run")
    before = (finished.directory / "run.db").read_bytes()
    assert resume(finished.directory, plugins=toy_plugins).summary() == finished.summary()
    assert (finished.directory / "run.db").read_bytes() == before


def test_a_run_whose_last_turn_is_saved_but_not_its_end_is_ended(
    toy_config: Load, toy_plugins: Plugins, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def killed(*_: object) -> None:
        raise SystemExit("killed")

    undisturbed = run(toy_config(), out=tmp_path / "undisturbed")
    with monkeypatch.context() as patch:
        patch.setattr(Store, "finish", killed)
        with pytest.raises(SystemExit):
            run(toy_config(), out=tmp_path / "left")
    assert not load_run(tmp_path / "left").finished()
    resumed = resume(tmp_path / "left", plugins=toy_plugins)
    assert resumed.finished()
    assert_same_result(undisturbed.directory, resumed.directory)


class TestRefusal:
    def test_of_what_is_no_run_leaves_no_trace(self, tmp_path: Path) -> None:
        with pytest.raises(InputError, match=r"is no run's directory: there is no config\.toml"):
            resume(tmp_path)
        assert list(tmp_path.iterdir()) == []

    def test_of_another_configuration_names_it(self, toy_plugins: Plugins, left: Path) -> None:
        text = (left / "config.toml").read_text()
        assert "generations = 4" in text
        (left / "config.toml").write_text(text.replace("generations = 4", "generations = 5"))
        with pytest.raises(ConfigurationError, match=r"not that of the run:\n  run\.generations: 4 "):
            resume(left, plugins=toy_plugins, allow_different_versions=True)

    def test_of_other_versions_names_all_of_them(
        self, toy_config: Load, left: Path, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        newer = Plugins()
        newer.add(toys, Source("toy-box", "2.0", "toys"))
        monkeypatch.setattr(evoframe.record.provenance, "__version__", "99")
        with pytest.raises(ConfigurationError, match="--allow-different-versions") as caught:
            resume(left, plugins=newer)
        assert "evoframe: '0.1.0' then, '99' now" in str(caught.value)
        assert "components.aggregator: \"'toys' of toy-box 1.0\" then, \"'toys' of toy-box 2.0\" now" in str(
            caught.value
        )
        resumed = resume(left, plugins=newer, allow_different_versions=True)
        noted = json.loads(resumed.resumes()[-1]["differences"])
        assert "evoframe: '0.1.0' then, '99' now" in noted

    def test_of_a_configuration_that_reads_other_files(self, left: Path, toy_plugins: Plugins) -> None:
        text = (left / "config.toml").read_text()
        (left / "config.toml").write_text(text.replace("extends = false", 'extends = "../secret.toml"'))
        with pytest.raises(InputError, match=r"config\.toml: extends: a run's configuration is complete"):
            resume(left, plugins=toy_plugins)

    def test_of_settings_that_decide_the_result(self, left: Path, toy_plugins: Plugins) -> None:
        for begun in (True, False):
            if not begun:
                (left / "run.db").unlink()
            with pytest.raises(ConfigurationError, match=r"not that of the run:\n  run\.seed: 3 then, 9 now"):
                reopened(left, toy_plugins, ["run.seed=9"])
        assert resume(left, plugins=toy_plugins).finished()

    def test_of_other_settings_for_the_verification_of_a_finished_run(
        self, toy_config: Load, toy_plugins: Plugins, tmp_path: Path
    ) -> None:
        directory = run(toy_config("simulator=toy-varied"), out=tmp_path / "run").directory
        (directory / "verification.json").unlink()
        with pytest.raises(ConfigurationError, match=r"not that of the run:\n  simulator\.gain: 1\.0 then"):
            configuration_of(directory, ["simulator.gain=2.0"], toy_plugins)

    def test_of_a_second_process(self, left: Path, toy_plugins: Plugins) -> None:
        lock = acquire_lock(left)
        with pytest.raises(InputError, match="is being written by another process"):
            resume(left, plugins=toy_plugins)
        lock.release()
        assert resume(left, plugins=toy_plugins).finished()

    def test_gives_the_lock_back(self, left: Path, toy_plugins: Plugins) -> None:
        text = (left / "config.toml").read_text()
        (left / "config.toml").write_text(text.replace("generations = 4", "generations = 5"))
        with pytest.raises(ConfigurationError):
            resume(left, plugins=toy_plugins)
        (left / "config.toml").write_text(text)
        assert resume(left, plugins=toy_plugins).finished()

    @pytest.mark.parametrize("state", ["{}", "[]", "null", '{"values": 3}', '{"evolver": {}}'])
    def test_of_a_state_that_is_none(self, left: Path, toy_plugins: Plugins, state: str) -> None:
        rewritten(left, "UPDATE state SET state = ? WHERE part = 'population/a'", state)
        with pytest.raises(InputError, match="the state cannot be restored"):
            reopened(left, toy_plugins)

    def test_run_says_what_a_directory_holds(
        self, toy_config: Load, toy_plugins: Plugins, left: Path
    ) -> None:
        with pytest.raises(InputError, match=f"holds a run that is not finished; .* evoframe resume {left}"):
            run(toy_config(), out=left)
        resume(left, plugins=toy_plugins)
        with pytest.raises(InputError, match="holds a finished run; choose another directory"):
            run(toy_config(), out=left)


class TestDisk:
    def test_a_database_that_another_program_holds_is_an_error_and_the_run_goes_on_later(
        self, toy_config: Load, toy_plugins: Plugins, tmp_path: Path
    ) -> None:
        undisturbed = run(toy_config(), out=tmp_path / "undisturbed")
        config = toy_config()
        execution = prepare(config, Plugins(), tmp_path / "left")
        execution._store._database.execute("PRAGMA busy_timeout = 10")
        holder = sqlite3.connect(tmp_path / "left" / "run.db", isolation_level=None)
        holder.execute("BEGIN IMMEDIATE")
        with pytest.raises(RunError, match="the database cannot be written: database is locked"):
            execution.play()
        holder.close()
        assert_same_result(undisturbed.directory, resume(tmp_path / "left", plugins=toy_plugins).directory)

    def test_a_copy_of_the_directory_goes_on_elsewhere(
        self, toy_config: Load, toy_plugins: Plugins, tmp_path: Path, left: Path
    ) -> None:
        undisturbed = run(toy_config(), out=tmp_path / "undisturbed")
        shutil.move(left, tmp_path / "moved")
        assert_same_result(undisturbed.directory, resume(tmp_path / "moved", plugins=toy_plugins).directory)


def test_a_resume_is_noted_only_beside_the_results(left: Path, toy_plugins: Plugins) -> None:
    resume(left, plugins=toy_plugins)
    assert rows(left, "resumes") == [(0, 3, "[]")]
    assert load_run(left).finished()


def test_a_run_that_was_finished_a_moment_ago_is_not_resumed(left: Path, toy_plugins: Plugins) -> None:
    resume(left, plugins=toy_plugins)
    before = {path.name: path.read_bytes() for path in left.iterdir() if path.suffix in (".json", ".toml")}
    execution = reopened(left, toy_plugins)  # by a process that saw it before
    finished = execution.play()
    assert finished.finished()
    execution.verify(finished)
    assert rows(left, "resumes") == [(0, 3, "[]")]
    after = {path.name: path.read_bytes() for path in left.iterdir() if path.suffix in (".json", ".toml")}
    assert after == before
    assert load_run(left).finished()
