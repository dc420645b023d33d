"""``doctor`` passes intact runs, and detects and names each kind of damage."""

from __future__ import annotations

import contextlib
import re
import sqlite3
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
import toys
from recorded import rewritten

from evoframe import Plugins, RunConfig, load_run, resume, run
from evoframe.contract.config import Source
from evoframe.errors import LockedError
from evoframe.files.locks import acquire_lock
from evoframe.registry.registry import Skipped
from evoframe.runs.doctor import Check, check_installation, check_run
from evoframe.runs.starting import prepare

Load = Callable[..., RunConfig]

SUBJECTS = ["format", "database", "configuration", "versions", "turns", "state", "champion"]


@pytest.fixture
def finished(toy_config: Load, tmp_path: Path) -> Path:
    return run(toy_config(), out=tmp_path / "run").directory


def finding_of(checks: list[Check], subject: str) -> str:
    [finding] = [check.finding for check in checks if check.subject == subject]
    return finding


def problems(checks: list[Check]) -> dict[str, str]:
    return {check.subject: check.finding for check in checks if check.state == "problem"}


def snapshot(directory: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in directory.iterdir()}


def test_an_intact_run_passes_and_is_not_changed(finished: Path, toy_plugins: Plugins) -> None:
    before = snapshot(finished)
    checks = list(check_run(finished, toy_plugins))
    assert [(check.subject, check.state) for check in checks] == [(subject, "ok") for subject in SUBJECTS]
    assert "8 turns" in finding_of(checks, "turns")
    assert snapshot(finished) == before


def test_a_run_without_a_lock_file_gets_none(finished: Path, toy_plugins: Plugins) -> None:
    (finished / "run.lock").unlink()
    assert not problems(list(check_run(finished, toy_plugins)))
    assert not (finished / "run.lock").exists()


def test_an_interrupted_run_can_be_resumed(toy_config: Load, toy_plugins: Plugins, tmp_path: Path) -> None:
    execution = prepare(toy_config(), toy_plugins, tmp_path / "run")
    assert not execution.play(stop=lambda: True).finished()
    checks = list(check_run(tmp_path / "run", toy_plugins))
    assert not problems(checks)
    assert "0 of 8" in finding_of(checks, "turns")
    assert finding_of(checks, "turns").endswith(f": evoframe resume {tmp_path / 'run'}")


def test_a_run_that_was_killed_before_its_first_save_can_be_started(
    finished: Path, toy_plugins: Plugins
) -> None:
    (finished / "run.db").unlink()
    [check] = check_run(finished, toy_plugins)
    assert (check.state, check.subject) == ("note", "database")
    assert check.finding.endswith(f": evoframe resume {finished}")


def test_a_run_that_is_being_written_is_refused(finished: Path, toy_plugins: Plugins) -> None:
    lock = acquire_lock(finished)
    try:
        with pytest.raises(LockedError, match=str(finished)):
            list(check_run(finished, toy_plugins))
    finally:
        lock.release()


@pytest.mark.parametrize(
    ("statement", "subject", "finding"),
    [
        ("DELETE FROM workload WHERE turn = 3", "turns", "workload: "),
        ("DELETE FROM turns WHERE turn = 3", "turns", "turns: "),
        ("UPDATE turns SET population = 'b' WHERE turn = 3", "turns", "turns: "),
        ("DELETE FROM individuals WHERE turn = 2 AND position = 0", "turns", "individuals: "),
        ("DELETE FROM pairs WHERE turn = 2 AND pair = 1", "turns", "pairs: "),
        ("UPDATE best_pairs SET score = score + 1", "turns", "best_pairs: "),
        ("DELETE FROM best_pairs WHERE turn = 0", "turns", "best_pairs: "),
        ("DELETE FROM state WHERE part = 'population/a'", "state", "'population/a'"),
        ("UPDATE state SET state = '{}' WHERE part = 'loop'", "state", "loop.turn"),
        ("UPDATE meta SET value = '4' WHERE key = 'format'", "format", "'4'"),
    ],
)
def test_rows_that_contradict_each_other_are_detected(
    finished: Path, toy_plugins: Plugins, statement: str, subject: str, finding: str
) -> None:
    rewritten(finished, statement)
    found = problems(list(check_run(finished, toy_plugins)))
    assert list(found) == [subject]
    assert finding in found[subject]


def test_damage_is_detected(finished: Path, toy_plugins: Plugins) -> None:
    with contextlib.closing(sqlite3.connect(finished / "run.db")) as database, database:
        database.execute("UPDATE pairs SET score = 0.25 WHERE turn = 1 AND pair = 2")
    checks = list(check_run(finished, toy_plugins))
    found = problems(checks)
    assert list(found) == ["database"]
    assert found["database"].startswith(f"{finished / 'run.db'}: pairs: ")
    assert [check.subject for check in checks] == ["format", "database", "configuration"]


def test_a_changed_configuration_is_detected(finished: Path, toy_plugins: Plugins) -> None:
    path = finished / "config.toml"
    path.write_text(path.read_text().replace("seed = 3", "seed = 4"))
    found = problems(list(check_run(finished, toy_plugins)))
    assert list(found) == ["configuration"]
    assert found["configuration"].startswith(f"{path}: ")
    assert re.search(r"run\.seed: 3 .*4", found["configuration"])


def test_a_missing_plugin_is_detected(finished: Path) -> None:
    found = problems(list(check_run(finished, Plugins())))
    assert "'toy-mean'" in found["configuration"]


def test_other_versions_are_noted(
    finished: Path, toy_plugins: Plugins, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("evoframe.record.provenance.__version__", "99")
    noted = [check for check in check_run(finished, toy_plugins) if check.state == "note"]
    assert [check.subject for check in noted] == ["versions"]
    assert re.search(r"evoframe: '0\.1\.0' .*'99'", noted[0].finding)


def test_another_source_of_a_local_plugin_is_noted(toy_config: Load, tmp_path: Path) -> None:
    made, edited = Plugins(), Plugins()
    for plugins, digest in ((made, "sha256:one"), (edited, "sha256:two")):
        plugins.add(toys, Source("toys", "local", "toys", digest))
    finished = run(toy_config(plugins=made), out=tmp_path / "run").directory
    assert [check.state for check in check_run(finished, made)] == ["ok"] * 7
    [noted] = [check for check in check_run(finished, edited) if check.state != "ok"]
    assert (noted.subject, noted.state) == ("versions", "note")
    assert "local_plugins.toys: 'sha256:one' then, 'sha256:two' now" in noted.finding


def test_a_run_that_was_resumed_with_other_versions_is_noted(
    toy_config: Load, toy_plugins: Plugins, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    prepare(toy_config(), toy_plugins, tmp_path / "run").play(lambda: True)
    with monkeypatch.context() as patch:
        patch.setattr("evoframe.record.provenance.__version__", "99")
        resume(tmp_path / "run", plugins=toy_plugins, allow_different_versions=True)
    [noted] = [check for check in check_run(tmp_path / "run", toy_plugins) if check.state != "ok"]
    assert (noted.subject, noted.state) == ("versions", "note")
    assert re.match(r"when the run was resumed after turn 0: evoframe: '0\.1\.0' .*'99'", noted.finding)


def test_a_champion_with_a_different_score_is_detected(
    finished: Path, toy_plugins: Plugins, monkeypatch: pytest.MonkeyPatch
) -> None:
    score = load_run(finished).champion().score
    monkeypatch.setattr(toys.Value, "score", lambda *_: 0.125)
    found = problems(list(check_run(finished, toy_plugins)))
    assert list(found) == ["champion"]
    assert re.search(rf"{re.escape(repr(score))} .* 0\.125$", found["champion"])


def test_a_score_of_another_bit_generation_is_no_damage(
    finished: Path, toy_plugins: Plugins, monkeypatch: pytest.MonkeyPatch
) -> None:
    score = load_run(finished).champion().score
    monkeypatch.setattr(toys.Product, "bit_generation", 2, raising=False)
    assert not problems(list(check_run(finished, toy_plugins)))
    assert finding_of(list(check_run(finished, toy_plugins)), "champion").startswith(f"scores {score!r}")
    monkeypatch.setattr(toys.Value, "score", lambda *_: 0.125)
    noted = {
        check.subject: check.finding for check in check_run(finished, toy_plugins) if check.state == "note"
    }
    changes = "bit generation of simulator 'toy-product': 1 then, 2 now"
    assert noted == {
        "versions": f"changed since the start of the run: {changes}",
        "champion": f"scored {score!r} in the run, but now scores 0.125: {changes}",
    }


def test_another_bit_generation_of_what_gives_no_score_excuses_nothing(
    finished: Path, toy_plugins: Plugins, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(toys.Drift, "bit_generation", 2, raising=False)
    monkeypatch.setattr(toys.Value, "score", lambda *_: 0.125)
    assert list(problems(list(check_run(finished, toy_plugins)))) == ["champion"]


def test_a_champion_that_diverges_now_is_detected(
    finished: Path, toy_plugins: Plugins, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(toys.Product, "simulate", diverging)
    assert problems(list(check_run(finished, toy_plugins)))["champion"].endswith("diverges at step 1")


def test_a_champion_that_diverges_out_of_reach_of_its_samples_is_noted(
    toy_config: Load, toy_plugins: Plugins, tmp_path: Path
) -> None:
    made = run(toy_config("simulator={name='toy-shortsighted', torn_at=7}"), out=tmp_path / "run")
    [noted] = [check for check in check_run(made.directory, toy_plugins) if check.state != "ok"]
    assert (noted.subject, noted.state) == ("champion", "note")
    assert repr(made.champion().score) in noted.finding
    assert "diverges at step 7" in noted.finding


def diverging(_: Any, designs: Any, record: Any) -> Any:
    return [toys.Product(limit=-1.0)._outcome(design) for design in designs]


@pytest.mark.parametrize("content", [None, "{}"])
def test_a_changed_champion_file_is_detected(
    finished: Path, toy_plugins: Plugins, content: str | None
) -> None:
    path = finished / "champion.json"
    path.unlink()
    if content is not None:
        path.write_text(content)
    found = problems(list(check_run(finished, toy_plugins)))["champion"]
    assert found.startswith(f"{path}: ")
    assert found.endswith(f": evoframe resume {finished}")


def test_skipped_plugins_are_reported(toy_plugins: Plugins) -> None:
    toy_plugins.skipped.append(Skipped(Source("broken", "2.0", "it"), "ImportError: no"))
    found = list(check_installation(toy_plugins))
    assert (found[0].subject, found[0].state) == ("plugins", "problem")
    assert re.search(r"'it' of broken 2\.0 .*: ImportError: no$", found[0].finding)
    assert {"versions", "simulation"} == {check.subject for check in found[2:]}
    assert "unknown" in found[-1].finding  # the presets need plugins that are not installed here
