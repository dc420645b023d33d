"""``evoframe resume``, signals, and disks that take nothing more."""

from __future__ import annotations

import contextlib
import re
import signal
from collections.abc import Iterator
from pathlib import Path

import pausing
import pytest
import toys
from processes import Evoframe, Program, ended, python, started, told
from recorded import assert_same_result

from evoframe import load_run

_HANGING = ("--set", "simulator={name='toy-hanging', fixed='fixed'}")


@pytest.fixture
def toy(tmp_path: Path) -> list[str]:
    (tmp_path / "toy.toml").write_text(toys.CONFIGURATION)
    return ["-p", toys.__file__]


@contextlib.contextmanager
def paused(directory: Path, toy: list[str]) -> Iterator[Program]:
    """Start a run that waits after its first turn until the file ``pause`` is removed."""
    (directory / "pause").touch()
    with started(
        directory, "run", *toy, "-p", pausing.__file__, "-v", "toy.toml", "--out", "left"
    ) as process:
        told(process, "turn 0")
        yield process


def undisturbed(evoframe: Evoframe, toy: list[str], directory: Path) -> Path:
    assert evoframe("run", *toy, "toy.toml", "--out", "undisturbed").returncode == 0
    return directory / "undisturbed"


@pytest.mark.parametrize(("number", "code"), [(signal.SIGINT, 130), (signal.SIGTERM, 143)])
def test_goes_on_after_a_signal_that_stopped_it_after_its_turn(
    evoframe: Evoframe, toy: list[str], tmp_path: Path, number: signal.Signals, code: int
) -> None:
    with paused(tmp_path, toy) as process:
        process.send_signal(number)
        told(process, "Stopping")
        (tmp_path / "pause").unlink()
        line = told(process, "Interrupted")
        assert line.rstrip().endswith(f": evoframe resume left -p {toys.__file__} -p {pausing.__file__}")
        assert ended(process) == code
    resumed = evoframe("resume", *toy, "left")
    assert resumed.returncode == 0, resumed.stderr
    assert "best pair" in resumed.stdout
    assert_same_result(undisturbed(evoframe, toy, tmp_path), tmp_path / "left")


def test_a_second_process_is_refused_and_the_first_goes_on(
    evoframe: Evoframe, toy: list[str], tmp_path: Path
) -> None:
    with paused(tmp_path, toy) as process:
        second = evoframe("resume", *toy, "left")
        assert second.returncode == 2
        assert second.stderr.splitlines()[-1].startswith("Error: left: ")
        assert "another process" in second.stderr
        (tmp_path / "pause").unlink()
        assert ended(process) == 0
    assert_same_result(undisturbed(evoframe, toy, tmp_path), tmp_path / "left")


def test_a_finished_run_is_said_to_be_finished(evoframe: Evoframe, toy: list[str], tmp_path: Path) -> None:
    assert evoframe("run", *toy, "toy.toml", "--out", "here").returncode == 0
    before = {path.name: path.read_bytes() for path in (tmp_path / "here").iterdir()}
    again = evoframe("-q", "resume", *toy, "here")
    assert (again.returncode, again.stderr) == (0, "here: the run is finished\n")
    assert {path.name: path.read_bytes() for path in (tmp_path / "here").iterdir()} == before
    refused = evoframe("resume", *toy, "here", "--set", "run.generations=9")
    assert refused.returncode == 2
    assert refused.stderr.startswith("Error: here: ")
    assert re.search(r"\n  run.generations: .*4.*9", refused.stderr)


@pytest.mark.parametrize(
    ("directory", "message"),
    [("nowhere", "Error: nowhere: does not exist"), (".", "Error: .: not a run directory: no config.toml")],
)
def test_what_is_no_run_is_refused(evoframe: Evoframe, directory: str, message: str) -> None:
    refused = evoframe("resume", directory)
    assert (refused.returncode, refused.stderr.startswith(message)) == (2, True)


_FULL_DISK = """
import resource, signal, sys
signal.signal(signal.SIGXFSZ, signal.SIG_IGN)  # what is beyond the limit is an error, as on a full disk
resource.setrlimit(resource.RLIMIT_FSIZE, (int(sys.argv.pop(1)),) * 2)
from evoframe.cli import main
main()
"""


@pytest.mark.parametrize("size", [0, 4_000, 60_000, 150_000])
def test_a_full_disk_stops_the_run_and_it_goes_on_when_there_is_room(
    evoframe: Evoframe, toy: list[str], tmp_path: Path, size: int
) -> None:
    longer = ["--set", "run.generations=20"]
    command = ["run", *toy, "toy.toml", *longer, "--out", "left"]
    unmeasured = {"COVERAGE_PROCESS_CONFIG": ""}  # coverage's file is beyond the limit too
    full = python("-c", _FULL_DISK, size, *command, directory=tmp_path, **unmeasured)
    assert full.returncode in (1, 2), full.stderr
    assert "Traceback" not in full.stderr
    assert "Error: left" in full.stderr
    assert "writ" in full.stderr
    if not (tmp_path / "left" / "config.toml").exists():
        return  # not even that could be written: there is nothing to go on with
    resumed = evoframe("resume", *toy, "left")
    assert resumed.returncode == 0, resumed.stderr
    assert evoframe("run", *toy, "toy.toml", *longer, "--out", "undisturbed").returncode == 0
    assert_same_result(tmp_path / "undisturbed", tmp_path / "left")
    assert load_run(tmp_path / "left").finished()


def test_where_nothing_can_be_written_nothing_is_begun(
    evoframe: Evoframe, toy: list[str], tmp_path: Path
) -> None:
    (tmp_path / "file").touch()
    refused = evoframe("run", *toy, "toy.toml", "--out", "file/run")
    assert refused.returncode == 2
    assert refused.stderr.startswith("Error: file/run: ")
    assert "Not a directory" in refused.stderr


def test_a_thread_that_hangs_does_not_keep_the_program_from_ending(
    evoframe: Evoframe, toy: list[str], tmp_path: Path
) -> None:
    executor = ["--set", "executor={name='threads', batch_time_limit=2.0}"]
    hung = evoframe("run", *toy, "toy.toml", *_HANGING, *executor, "--out", "left")
    assert hung.returncode == 1
    message, todo, plugins = hung.stderr.splitlines()[-3:]
    assert plugins.endswith(f"-p {toys.__file__}")
    assert message.startswith("Error: simulator: 'toy-hanging' (plugin 'toys' of toys local): ")
    assert "evoframe resume left" in todo
    (tmp_path / "fixed").touch()
    assert evoframe("resume", *toy, "left").returncode == 0


def test_a_second_signal_does_not_wait_for_what_hangs(toy: list[str], tmp_path: Path) -> None:
    hanging = [
        "--set",
        "simulator={name='toy-hanging', beyond=-1.0, fixed='fixed'}",
        "--set",
        "executor={name='threads', workers=2}",
    ]
    with started(tmp_path, "run", *toy, "-v", "toy.toml", *hanging, "--out", "left") as process:
        told(process, "8 turns")
        for word in ("Stopping", "Interrupted"):
            process.send_signal(signal.SIGINT)
            told(process, word)
        assert ended(process) == 130


def test_what_cannot_be_written_is_said_whatever_lies_there(
    evoframe: Evoframe, toy: list[str], tmp_path: Path
) -> None:
    assert (
        evoframe("run", *toy, "toy.toml", "--set", "simulator='toy-varied'", "--out", "here").returncode == 0
    )
    (tmp_path / "here" / ".verification.json.new").mkdir()
    refused = evoframe("verify", *toy, "here")
    assert refused.returncode == 1
    assert refused.stderr.startswith("Error: here/verification.json: ")
    assert "Is a directory" in refused.stderr


def test_a_run_that_was_killed_while_it_wrote_its_configuration_is_begun(
    evoframe: Evoframe, toy: list[str], tmp_path: Path
) -> None:
    (tmp_path / "here").mkdir()
    (tmp_path / "here" / ".config.toml.new").write_text("[ru")
    begun = evoframe("run", *toy, "toy.toml", "--out", "here")
    assert begun.returncode == 0, begun.stderr


def test_processes_cannot_import_a_plugin_of_a_file(evoframe: Evoframe, toy: list[str]) -> None:
    refused = evoframe("run", *toy, "toy.toml", "--set", "executor='processes'", "--out", "left")
    assert refused.returncode == 1
    assert re.search("^Error: executor.*: ModuleNotFoundError", refused.stderr, re.MULTILINE)
    assert "Traceback" not in refused.stderr


def test_a_finished_run_needs_no_plugin_to_be_said_to_be_finished(evoframe: Evoframe, toy: list[str]) -> None:
    assert evoframe("run", *toy, "toy.toml", "--set", "simulator=toy-varied", "--out", "r").returncode == 0
    again = evoframe("resume", "r")
    assert (again.returncode, again.stderr.startswith("r: the run is finished;")) == (0, True)
