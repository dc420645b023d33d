"""A run is opened once and passed on: nothing is parsed, opened or checked twice."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import click.testing
import pytest
import toys
from counting import TABLES, Reads, counted

from evoframe import Plugins, RunConfig, discover, load_config, load_run, resume, run, verify
from evoframe.cli import cli
from evoframe.runs.doctor import check_run
from evoframe.runs.starting import prepare
from evoframe.study.gathered import gather
from evoframe.study.plan import Planned, Study
from evoframe.study.progress import status_of

Start = Callable[[Path], Any]


@pytest.fixture(scope="module")
def plugins() -> Plugins:
    """The plugins as loaded by ``-p``; toys from another source would count as another version."""
    return discover([toys.__file__])


@pytest.fixture
def config(toy_file: Path, plugins: Plugins) -> RunConfig:
    return load_config(toy_file, overrides=["simulator=toy-varied"], plugins=plugins)


@pytest.fixture
def left(config: RunConfig, tmp_path: Path) -> Path:
    """The directory of a run that was interrupted after some turns."""
    stops = iter([False, False, False, True])
    prepare(config, Plugins(), tmp_path / "run").play(lambda: next(stops))
    return tmp_path / "run"


@pytest.fixture
def finished(config: RunConfig, tmp_path: Path) -> Path:
    return run(config, out=tmp_path / "run").directory


def command(*arguments: str | Path) -> None:
    """Run the command in this process."""
    result = click.testing.CliRunner().invoke(cli, [*map(str, arguments)], catch_exceptions=False)
    assert result.exit_code == 0, result.output


def resume_by_command(directory: Path, _: Plugins) -> None:
    command("resume", "-p", toys.__file__, directory)


def resume_from_python(directory: Path, plugins: Plugins) -> None:
    resume(directory, plugins=plugins)


def doctor_by_command(directory: Path, _: Plugins) -> None:
    command("doctor", "-p", toys.__file__, directory)


def doctor_from_python(directory: Path, plugins: Plugins) -> None:
    assert {check.state for check in check_run(directory, plugins)} == {"ok"}


def verify_by_command(directory: Path, _: Plugins) -> None:
    command("verify", "-p", toys.__file__, directory)


def verify_from_python(directory: Path, plugins: Plugins) -> None:
    verify(directory, plugins=plugins)


@pytest.mark.parametrize("resumed", [resume_from_python, resume_by_command])
def test_a_resumed_run_is_read_once_and_opened_once_more_to_write(
    left: Path, plugins: Plugins, monkeypatch: pytest.MonkeyPatch, resumed: Callable[[Path, Plugins], None]
) -> None:
    reads = counted(left, monkeypatch)
    resumed(left, plugins)
    monkeypatch.undo()
    assert load_run(left).finished()
    assert (reads.parsed, reads.opened) == (1, 2)
    assert_every_table_was_checked_once(reads, TABLES - {"resumes", "measures"})  # which were empty


@pytest.mark.parametrize("resumed", [resume_from_python, resume_by_command])
@pytest.mark.parametrize("verified", [True, False])
def test_a_finished_run_that_is_resumed_is_read_once(
    finished: Path,
    plugins: Plugins,
    monkeypatch: pytest.MonkeyPatch,
    resumed: Callable[[Path, Plugins], None],
    verified: bool,
) -> None:
    if not verified:
        (finished / "verification.json").unlink()
    reads = counted(finished, monkeypatch)
    resumed(finished, plugins)
    assert (finished / "verification.json").exists()
    assert (reads.parsed, reads.opened) == (1, 1)
    assert set(reads.checked.values()) == {1}


@pytest.mark.parametrize("check", [doctor_from_python, doctor_by_command])
@pytest.mark.parametrize("which", ["left", "finished"])
def test_a_checked_run_is_read_once(
    request: pytest.FixtureRequest,
    plugins: Plugins,
    monkeypatch: pytest.MonkeyPatch,
    check: Callable[[Path, Plugins], None],
    which: str,
) -> None:
    directory: Path = request.getfixturevalue(which)
    reads = counted(directory, monkeypatch)
    check(directory, plugins)
    assert (reads.parsed, reads.opened) == (1, 1)
    assert_every_table_was_checked_once(reads, TABLES - {"resumes", "measures"})


@pytest.mark.parametrize("again", [verify_from_python, verify_by_command])
def test_a_verified_run_is_read_once(
    finished: Path, plugins: Plugins, monkeypatch: pytest.MonkeyPatch, again: Callable[[Path, Plugins], None]
) -> None:
    reads = counted(finished, monkeypatch)
    again(finished, plugins)
    assert (reads.parsed, reads.opened) == (1, 1)
    assert_every_table_was_checked_once(reads, {"meta", "best_pairs"})  # nothing else is needed


def test_a_loaded_run_is_read_once(finished: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    reads = counted(finished, monkeypatch)
    loaded = load_run(finished)
    for ask in (loaded.pairs, loaded.pairs, loaded.champion, loaded.summary, loaded.state, loaded.turns):
        ask()
    assert (reads.parsed, reads.opened) == (1, 1)
    assert_every_table_was_checked_once(reads, TABLES - {"resumes", "measures"})


def test_a_run_just_played_is_not_read_at_all(
    config: RunConfig, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    execution = prepare(config, Plugins(), tmp_path / "run")
    reads = counted(tmp_path / "run", monkeypatch)
    played = execution.play()
    execution.verify(played)
    assert played.champion().score == max(pair["score"] for pair in played.pairs())
    assert reads == Reads()


@pytest.mark.parametrize("with_row", [False, True])
def test_a_run_of_a_study_is_read_once_for_its_status_and_its_row(
    made: tuple[Study, Path, list[Planned]], monkeypatch: pytest.MonkeyPatch, with_row: bool
) -> None:
    planned = made[2][1]
    reads = counted(planned.directory, monkeypatch)
    status = status_of(planned, with_row=with_row)
    assert (status.state, status.row is not None) == ("finished", with_row)
    assert gather({planned: status}, {})[planned].run == planned.index
    reads_of_row = 1 if with_row else 2  # gather reads a row that is missing
    assert (reads.parsed, reads.opened) == (reads_of_row, reads_of_row)
    assert max(reads.checked.values()) <= reads_of_row


def assert_every_table_was_checked_once(reads: Reads, tables: frozenset[str] | set[str]) -> None:
    assert dict(reads.checked) == dict.fromkeys(tables, 1)
