"""``doctor``: sound runs are found sound, and each kind of damage is found and named."""

from __future__ import annotations

import contextlib
import sqlite3
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
import toys
from recorded import rewritten

from evoframe import Plugins, RunConfig, load_run, run
from evoframe.contract.config import Source
from evoframe.errors import InputError
from evoframe.files.locks import acquire_lock
from evoframe.registry.registry import Skipped
from evoframe.runs.doctor import Check, check_installation, check_run
from evoframe.runs.starting import prepare

Load = Callable[..., RunConfig]

SUBJECTS = ["format", "database", "configuration", "versions", "turns", "state", "champion"]


@pytest.fixture
def finished(toy_config: Load, tmp_path: Path) -> Path:
    return run(toy_config(), out=tmp_path / "run").directory


def problems(checks: list[Check]) -> dict[str, str]:
    return {check.subject: check.finding for check in checks if check.state == "problem"}


def snapshot(directory: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in directory.iterdir()}


def test_a_sound_run_is_sound_and_not_touched(finished: Path, toy_plugins: Plugins) -> None:
    before = snapshot(finished)
    checks = list(check_run(finished, toy_plugins))
    assert [(check.subject, check.state) for check in checks] == [(subject, "ok") for subject in SUBJECTS]
    assert "finished after 8 turns" in [check.finding for check in checks]
    assert snapshot(finished) == before


def test_a_run_without_a_lock_file_gets_none(finished: Path, toy_plugins: Plugins) -> None:
    (finished / "run.lock").unlink()
    assert not problems(list(check_run(finished, toy_plugins)))
    assert not (finished / "run.lock").exists()


def test_a_run_that_was_left_can_go_on(toy_config: Load, toy_plugins: Plugins, tmp_path: Path) -> None:
    execution = prepare(toy_config(), toy_plugins, tmp_path / "run")
    assert not execution.play(stop=lambda: True).finished()
    checks = list(check_run(tmp_path / "run", toy_plugins))
    assert not problems(checks)
    assert f"saved up to 0 of 8; to go on: evoframe resume {tmp_path / 'run'}" in [c.finding for c in checks]


def test_a_run_that_was_killed_before_anything_was_saved_can_begin(
    finished: Path, toy_plugins: Plugins
) -> None:
    (finished / "run.db").unlink()
    [check] = check_run(finished, toy_plugins)
    assert (check.state, check.subject) == ("note", "database")
    assert check.finding.endswith(f"to begin: evoframe resume {finished}")


def test_a_run_that_is_being_written_is_left_alone(finished: Path, toy_plugins: Plugins) -> None:
    lock = acquire_lock(finished)
    try:
        with pytest.raises(InputError, match="is being written by another process"):
            list(check_run(finished, toy_plugins))
    finally:
        lock.release()


@pytest.mark.parametrize(
    ("statement", "subject", "finding"),
    [
        ("DELETE FROM workload WHERE turn = 3", "turns", "workload: turns are missing"),
        ("DELETE FROM turns WHERE turn = 3", "turns", "turns: not those populations"),
        ("UPDATE turns SET population = 'b' WHERE turn = 3", "turns", "turns: not those populations"),
        ("DELETE FROM individuals WHERE turn = 2 AND position = 0", "turns", "individuals: not as many"),
        ("DELETE FROM pairs WHERE turn = 2 AND pair = 1", "turns", "pairs: not as many as in workload"),
        ("UPDATE best_pairs SET score = score + 1", "turns", "best_pairs: not the best of the pairs"),
        ("DELETE FROM best_pairs WHERE turn = 0", "turns", "best_pairs: not the best of the pairs"),
        ("DELETE FROM state WHERE part = 'population/a'", "state", "the state cannot be restored: missing"),
        (
            "UPDATE state SET state = '{}' WHERE part = 'loop'",
            "state",
            "restored: loop.turn: is missing",
        ),
        ("UPDATE meta SET value = '3' WHERE key = 'format'", "format", "this evoframe reads format"),
    ],
)
def test_rows_that_do_not_fit_together_are_found(
    finished: Path, toy_plugins: Plugins, statement: str, subject: str, finding: str
) -> None:
    rewritten(finished, statement)
    found = problems(list(check_run(finished, toy_plugins)))
    assert list(found) == [subject]
    assert finding in found[subject]


def test_damage_is_found(finished: Path, toy_plugins: Plugins) -> None:
    with contextlib.closing(sqlite3.connect(finished / "run.db")) as database, database:
        database.execute("UPDATE pairs SET score = 0.25 WHERE turn = 1 AND pair = 2")
    checks = list(check_run(finished, toy_plugins))
    assert problems(checks) == {"database": f"{finished / 'run.db'}: is damaged: pairs is not what was saved"}
    assert [check.subject for check in checks] == ["format", "database", "configuration"]


def test_another_configuration_is_found(finished: Path, toy_plugins: Plugins) -> None:
    path = finished / "config.toml"
    path.write_text(path.read_text().replace("seed = 3", "seed = 4"))
    found = problems(list(check_run(finished, toy_plugins)))
    assert found["configuration"].endswith("not that of the run:\n  run.seed: 3 then, 4 now")


def test_a_missing_plugin_is_found(finished: Path) -> None:
    found = problems(list(check_run(finished, Plugins())))
    assert "unknown aggregator 'toy-mean'" in found["configuration"]


def test_other_versions_are_noted(
    finished: Path, toy_plugins: Plugins, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("evoframe.record.provenance.__version__", "99")
    noted = [check for check in check_run(finished, toy_plugins) if check.state == "note"]
    assert [check.subject for check in noted] == ["versions"]
    assert "evoframe: '0.1.0' then, '99' now" in noted[0].finding


def test_a_champion_that_scores_something_else_is_found(
    finished: Path, toy_plugins: Plugins, monkeypatch: pytest.MonkeyPatch
) -> None:
    score = load_run(finished).champion().score
    monkeypatch.setattr(toys.Value, "score", lambda *_: 0.125)
    found = problems(list(check_run(finished, toy_plugins)))
    assert found == {"champion": f"scored {score!r} in its run, but now scores 0.125"}


def test_a_champion_that_diverges_now_is_found(
    finished: Path, toy_plugins: Plugins, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(toys.Product, "simulate", diverging)
    assert "but now diverges at step 1" in problems(list(check_run(finished, toy_plugins)))["champion"]


def diverging(_: Any, designs: Any, record: Any) -> Any:
    return [toys.Product(limit=-1.0)._outcome(design) for design in designs]


@pytest.mark.parametrize("content", [None, "{}"])
def test_another_champion_file_is_found(finished: Path, toy_plugins: Plugins, content: str | None) -> None:
    path = finished / "champion.json"
    path.unlink()
    if content is not None:
        path.write_text(content)
    found = problems(list(check_run(finished, toy_plugins)))["champion"]
    assert found == f"{path}: is not that of the database; evoframe resume {finished} writes it again"


def test_skipped_plugins_are_found(toy_plugins: Plugins) -> None:
    toy_plugins.skipped.append(Skipped(Source("broken", "2.0", "it"), "ImportError: no"))
    found = list(check_installation(toy_plugins))
    assert found[0] == Check("plugins", "problem", "'it' of broken 2.0 is skipped: ImportError: no")
    assert {"versions", "simulation"} == {check.subject for check in found[2:]}
    assert "unknown" in found[-1].finding  # the presets need plugins that are not there
