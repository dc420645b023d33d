"""Resumed runs give the result of an uninterrupted run; reasons that prevent resuming."""

from __future__ import annotations

import json
import re
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
from evoframe.errors import LockedError, OccupiedError
from evoframe.files.locks import acquire_lock
from evoframe.record.store import Store
from evoframe.runs.starting import prepare

Load = Callable[..., RunConfig]


def stop_after(turns: int) -> Callable[[], bool]:
    left = iter(range(turns - 1, -1, -1))
    return lambda: next(left) == 0


def stopped(config: RunConfig, directory: Path, after: int) -> Path:
    """Interrupt a run after *after* turns."""
    execution = prepare(config, Plugins(), directory)
    assert not execution.play(stop_after(after)).finished()
    return directory


@pytest.fixture
def left(toy_config: Load, tmp_path: Path) -> Path:
    return stopped(toy_config(), tmp_path / "left", 4)


@pytest.mark.parametrize("turn", range(1, 9))
def test_gives_the_result_of_an_uninterrupted_run(
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


def test_a_run_of_the_paper_resumes_with_other_workers(tmp_path: Path) -> None:
    settings = {"seed": 4, "run.generations": 4}
    undisturbed = run("quick", out=tmp_path / "undisturbed", workers=2, **settings)  # type: ignore[arg-type]
    config = evoframe.load_config(
        "quick", overrides=["run.seed=4", "run.generations=4", "executor.workers=1"]
    )
    resumed = resume(stopped(config, tmp_path / "left", 5), workers=3)
    assert_same_result(undisturbed.directory, resumed.directory)
    assert resumed.verification() is not None


def test_files_that_a_kill_left_incomplete_are_repaired(
    toy_config: Load, toy_plugins: Plugins, tmp_path: Path, left: Path
) -> None:
    undisturbed = run(toy_config(), out=tmp_path / "undisturbed")
    (left / "champion.json").write_text("old")
    (left / ".champion.json.new").write_text("half")
    resumed = resume(left, plugins=toy_plugins)
    assert_same_result(undisturbed.directory, resumed.directory)
    assert not (left / ".champion.json.new").exists()


@pytest.mark.parametrize("database", ["missing", "empty"])
def test_a_run_that_was_killed_before_its_first_transaction_starts(
    toy_config: Load, toy_plugins: Plugins, tmp_path: Path, left: Path, database: str
) -> None:
    undisturbed = run(toy_config(), out=tmp_path / "undisturbed")
    (left / "run.db").unlink()
    (left / "champion.json").unlink()
    if database == "empty":
        (left / "run.db").touch()
    assert not has_begun(left)
    assert_same_result(undisturbed.directory, resume(left, plugins=toy_plugins).directory)


def test_a_missing_champion_of_a_finished_run_is_written_again(
    toy_config: Load, toy_plugins: Plugins, tmp_path: Path
) -> None:
    finished = run(toy_config(), out=tmp_path / "run")
    champion = (tmp_path / "run" / "champion.json").read_bytes()
    (tmp_path / "run" / "champion.json").unlink()
    assert resume(tmp_path / "run", plugins=toy_plugins).summary() == finished.summary()
    assert (tmp_path / "run" / "champion.json").read_bytes() == champion


def test_a_finished_run_is_not_changed(toy_config: Load, toy_plugins: Plugins, tmp_path: Path) -> None:
    finished = run(toy_config(), out=tmp_path / "run")
    before = (finished.directory / "run.db").read_bytes()
    assert resume(finished.directory, plugins=toy_plugins).summary() == finished.summary()
    assert (finished.directory / "run.db").read_bytes() == before


def test_a_run_with_all_turns_but_no_final_figures_is_finished(
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
    def test_of_a_directory_that_is_not_a_run_leaves_no_trace(self, tmp_path: Path) -> None:
        with pytest.raises(InputError, match=r"config\.toml") as caught:
            resume(tmp_path)
        assert caught.value.source == str(tmp_path)
        assert list(tmp_path.iterdir()) == []

    def test_of_a_changed_configuration_names_the_change(self, toy_plugins: Plugins, left: Path) -> None:
        text = (left / "config.toml").read_text()
        assert "generations = 4" in text
        (left / "config.toml").write_text(text.replace("generations = 4", "generations = 5"))
        with pytest.raises(ConfigurationError, match=r"\n  run\.generations: 4 .*5") as caught:
            resume(left, plugins=toy_plugins, allow_different_versions=True)
        assert caught.value.source == str(left / "config.toml")

    def test_of_other_versions_names_all_changes(
        self, toy_config: Load, left: Path, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        newer = Plugins()
        newer.add(toys, Source("toy-box", "2.0", "toys"))
        monkeypatch.setattr(evoframe.record.provenance, "__version__", "99")
        command = f"evoframe resume {left} --allow-different-versions"
        with pytest.raises(ConfigurationError, match=f"{command}$") as caught:
            resume(left, plugins=newer)
        assert caught.value.source == str(left)
        changes = [
            r"evoframe: '0\.1\.0' .*'99'",
            r"components\.aggregator: \"'toys' of toy-box 1\.0\" .*\"'toys' of toy-box 2\.0\"",
        ]
        for change in changes:
            assert re.search(change, str(caught.value))
        resumed = resume(left, plugins=newer, allow_different_versions=True)
        recorded = json.loads(resumed.resumes()[-1]["differences"])
        assert [line for line in recorded if re.match(changes[0], line)]

    def test_of_another_bit_generation_names_component_generations_and_option(
        self, toy_plugins: Plugins, left: Path, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        """The run was recorded without a number, as by earlier versions of evoframe."""
        monkeypatch.setattr(toys.Product, "bit_generation", 2, raising=False)
        change = "bit generation of simulator 'toy-product': 1 then, 2 now"
        command = f"evoframe resume {left} --allow-different-versions"
        with pytest.raises(ConfigurationError, match=f"\n  {change}\n.*{command}$") as caught:
            resume(left, plugins=toy_plugins)
        assert caught.value.source == str(left)
        resumed = resume(left, plugins=toy_plugins, allow_different_versions=True)
        assert json.loads(resumed.resumes()[-1]["differences"]) == [change]

    def test_of_another_source_of_a_local_plugin_names_it(self, toy_config: Load, tmp_path: Path) -> None:
        made, edited = Plugins(), Plugins()
        for plugins, digest in ((made, "sha256:one"), (edited, "sha256:two")):
            plugins.add(toys, Source("toys", "local", "toys", digest))
        left = tmp_path / "left"
        prepare(toy_config(plugins=made), made, left).play(lambda: True)
        change = "local_plugins.toys: 'sha256:one' then, 'sha256:two' now"
        with pytest.raises(ConfigurationError, match=change) as caught:
            resume(left, plugins=edited)
        assert caught.value.source == str(left)
        resumed = resume(left, plugins=edited, allow_different_versions=True)
        assert json.loads(resumed.resumes()[-1]["differences"]) == [change]

    def test_of_a_configuration_that_reads_other_files(self, left: Path, toy_plugins: Plugins) -> None:
        text = (left / "config.toml").read_text()
        (left / "config.toml").write_text(text.replace("extends = false", 'extends = "../secret.toml"'))
        with pytest.raises(InputError, match=r"'\.\./secret\.toml'") as caught:
            resume(left, plugins=toy_plugins)
        assert (caught.value.source, caught.value.key) == (str(left / "config.toml"), "extends")

    def test_of_settings_that_determine_the_result(self, left: Path, toy_plugins: Plugins) -> None:
        for begun in (True, False):
            if not begun:
                (left / "run.db").unlink()
            with pytest.raises(ConfigurationError, match=r"\n  run\.seed: 3 .*9"):
                reopened(left, toy_plugins, ["run.seed=9"])
        assert resume(left, plugins=toy_plugins).finished()

    def test_of_other_settings_for_the_verification_of_a_finished_run(
        self, toy_config: Load, toy_plugins: Plugins, tmp_path: Path
    ) -> None:
        directory = run(toy_config("simulator=toy-varied"), out=tmp_path / "run").directory
        (directory / "verification.json").unlink()
        with pytest.raises(ConfigurationError, match=r"\n  simulator\.gain: 1\.0 "):
            configuration_of(directory, ["simulator.gain=2.0"], toy_plugins)

    def test_of_a_second_process(self, left: Path, toy_plugins: Plugins) -> None:
        lock = acquire_lock(left)
        with pytest.raises(LockedError):
            resume(left, plugins=toy_plugins)
        lock.release()
        assert resume(left, plugins=toy_plugins).finished()

    def test_releases_the_lock(self, left: Path, toy_plugins: Plugins) -> None:
        text = (left / "config.toml").read_text()
        (left / "config.toml").write_text(text.replace("generations = 4", "generations = 5"))
        with pytest.raises(ConfigurationError):
            resume(left, plugins=toy_plugins)
        (left / "config.toml").write_text(text)
        assert resume(left, plugins=toy_plugins).finished()

    @pytest.mark.parametrize("state", ["{}", "[]", "null", '{"values": 3}', '{"evolver": {}}'])
    def test_of_an_invalid_state(self, left: Path, toy_plugins: Plugins, state: str) -> None:
        rewritten(left, "UPDATE state SET state = ? WHERE part = 'population/a'", state)
        with pytest.raises(InputError) as caught:
            reopened(left, toy_plugins)
        assert (caught.value.source, caught.value.key) == (str(left), "state")

    def test_of_a_new_run_in_a_directory_with_a_run(
        self, toy_config: Load, toy_plugins: Plugins, left: Path
    ) -> None:
        with pytest.raises(OccupiedError, match=f"--out, .* evoframe resume {left}$"):
            run(toy_config(), out=left)
        resume(left, plugins=toy_plugins)
        with pytest.raises(OccupiedError, match=r"--out$") as caught:
            run(toy_config(), out=left)
        assert caught.value.source == str(left)


class TestDisk:
    def test_a_database_locked_by_another_program_is_an_error_and_the_run_can_be_resumed(
        self, toy_config: Load, toy_plugins: Plugins, tmp_path: Path
    ) -> None:
        undisturbed = run(toy_config(), out=tmp_path / "undisturbed")
        config = toy_config()
        execution = prepare(config, Plugins(), tmp_path / "left")
        execution._store._database.execute("PRAGMA busy_timeout = 10")
        holder = sqlite3.connect(tmp_path / "left" / "run.db", isolation_level=None)
        holder.execute("BEGIN IMMEDIATE")
        with pytest.raises(RunError, match="database is locked"):
            execution.play()
        holder.close()
        assert_same_result(undisturbed.directory, resume(tmp_path / "left", plugins=toy_plugins).directory)

    def test_a_moved_directory_can_be_resumed(
        self, toy_config: Load, toy_plugins: Plugins, tmp_path: Path, left: Path
    ) -> None:
        undisturbed = run(toy_config(), out=tmp_path / "undisturbed")
        shutil.move(left, tmp_path / "moved")
        assert_same_result(undisturbed.directory, resume(tmp_path / "moved", plugins=toy_plugins).directory)


def test_a_resume_is_recorded_without_changing_the_results(left: Path, toy_plugins: Plugins) -> None:
    resume(left, plugins=toy_plugins)
    assert rows(left, "resumes") == [(0, 3, "[]")]
    assert load_run(left).finished()


def test_a_run_that_another_process_has_just_finished_is_not_resumed(
    left: Path, toy_plugins: Plugins
) -> None:
    resume(left, plugins=toy_plugins)
    before = {path.name: path.read_bytes() for path in left.iterdir() if path.suffix in (".json", ".toml")}
    execution = reopened(left, toy_plugins)  # by a process that read it before
    finished = execution.play()
    assert finished.finished()
    execution.verify(finished)
    assert rows(left, "resumes") == [(0, 3, "[]")]
    after = {path.name: path.read_bytes() for path in left.iterdir() if path.suffix in (".json", ".toml")}
    assert after == before
    assert load_run(left).finished()
