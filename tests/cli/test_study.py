"""``evoframe study``."""

from __future__ import annotations

import csv
import os
import re
import signal
from pathlib import Path

import pausing
import pytest
import toys
from processes import Evoframe, children, ended, eventually, is_ended, on_a_terminal, started, told
from toy_study import STUDY

from evoframe import load_run, open_run
from evoframe.workers.cores import available_cores

SLOW = ("--set", "simulator={name='toy-slow', delay=0.02}")


@pytest.fixture
def toy(tmp_path: Path) -> list[str]:
    (tmp_path / "toy.toml").write_text(toys.CONFIGURATION)
    (tmp_path / "grid.toml").write_text(
        STUDY.replace('simulator = ["toy-product"', 'simulator = [{ name = "toy-slow", delay = 0.02 }')
    )
    return ["-p", toys.__file__, "grid.toml"]


def tables(directory: Path) -> dict[str, list[list[str]]]:
    """Return what must be the same for equal studies: all but what was done twice, and for how long."""
    found = {}
    for name in ("rows.csv", "curves.csv"):
        header, *lines = csv.reader((directory / name).read_text().splitlines())
        kept = [i for i, column in enumerate(header) if column not in ("seconds", "simulations")]
        found[name] = [[line[i] for i in kept] for line in (header, *lines)]
    for path in directory.rglob("verification.json"):
        found[str(path.relative_to(directory))] = [[path.read_text()]]
    return found


def test_runs_the_grid_and_prints_its_results(evoframe: Evoframe, toy: list[str], tmp_path: Path) -> None:
    made = evoframe("study", *toy)
    assert made.returncode == 0, made.stderr
    assert made.stdout.count(" 3/3 ") == 4
    assert "12/12 runs done" in made.stderr
    assert len(list((tmp_path / "studies" / "grid").glob("*/*/0?/champion.json"))) == 12
    assert len((tmp_path / "studies" / "grid" / "rows.csv").read_text().splitlines()) == 13
    again = evoframe("study", *toy)
    assert again.returncode == 0
    assert "runs done" not in again.stderr
    assert "evoframe report studies/grid" in again.stderr
    assert again.stdout == made.stdout


def test_a_dry_run_says_how_much_it_is_and_writes_nothing(
    evoframe: Evoframe, toy: list[str], tmp_path: Path
) -> None:
    told_of = evoframe("study", *toy, "--dry-run")
    assert told_of.returncode == 0, told_of.stderr
    assert "0 finished, 12 to run" in told_of.stdout
    assert re.search(r"at most .* from the first turn of one run", told_of.stdout)
    assert not (tmp_path / "studies").exists()


def test_a_dry_run_counts_on_the_workers_that_are_asked_for(evoframe: Evoframe, toy: list[str]) -> None:
    alone = evoframe("study", *toy, "--dry-run", "--workers", "1").stdout
    assert "on 1 core, estimated from" in alone
    one = ("--set", "runs=1", "--set", "grid.collaboration.n=[1]", "--set", "grid.simulator=['toy-product']")
    assert "on 1 core, estimated from" in evoframe("study", *toy, *one, "--dry-run", "--workers", "8").stdout
    for workers in ((), ("--workers", "1000")):
        together = evoframe("study", *toy, "--dry-run", *workers).stdout
        assert f"on {min(12, available_cores())} core" in together


def test_a_dry_run_changes_nothing_that_is_there(evoframe: Evoframe, toy: list[str], tmp_path: Path) -> None:
    assert evoframe("study", *toy, "--set", "runs=1", "--out", "s").returncode == 0
    before = {path: path.read_bytes() for path in (tmp_path / "s").rglob("*") if path.is_file()}
    assert evoframe("study", *toy, "--out", "s", "--dry-run").returncode == 0
    assert {path: path.read_bytes() for path in (tmp_path / "s").rglob("*") if path.is_file()} == before


def test_more_runs_and_values_are_added_to_what_is_there(
    evoframe: Evoframe, toy: list[str], tmp_path: Path
) -> None:
    assert (
        evoframe(
            "study", *toy, "--set", "grid.collaboration.n=[1]", "--set", "runs=2", "--out", "s"
        ).returncode
        == 0
    )
    [config] = (tmp_path / "s").glob("collaboration.n=1/simulator=toy-slow-*/00/config.toml")
    before = config.stat().st_mtime_ns
    more = evoframe("study", *toy, "--out", "s", "--dry-run")
    assert "4 finished, 8 to run" in more.stdout
    assert "from 4 finished runs" in more.stdout
    assert evoframe("study", *toy, "--out", "s").returncode == 0
    assert config.stat().st_mtime_ns == before


def test_another_study_is_refused(evoframe: Evoframe, toy: list[str]) -> None:
    assert evoframe("study", *toy, "--set", "runs=1", "--out", "s").returncode == 0
    refused = evoframe("study", *toy, "--set", "populations.a.size=7", "--out", "s")
    assert refused.returncode == 2
    assert refused.stderr.startswith("Error: s/study.toml: ")
    assert re.search(r"\n  populations.a.size: .*6.*7", refused.stderr)
    refused = evoframe("study", *toy, "--out", ".")
    assert refused.returncode == 2
    assert refused.stderr.startswith("Error: .: ")


def test_runs_that_fail_are_listed_and_retried_on_demand(
    evoframe: Evoframe, toy: list[str], tmp_path: Path
) -> None:
    hanging = 'grid.simulator=["toy-product", {name="toy-unsound", sound="sound"}]'
    arguments = ["study", *toy, "--set", hanging, "--set", "runs=1", "--out", "s"]
    failed = evoframe(*arguments)
    assert failed.returncode == 1
    assert "2 runs failed; to repeat, add --retry" in failed.stderr
    assert "failed: collaboration.n=1, simulator=" in failed.stderr
    assert "ZeroDivisionError: not sound" in failed.stderr
    again = evoframe(*arguments)
    assert again.returncode == 1  # not tried again
    assert "runs done" not in again.stderr
    (tmp_path / "sound").touch()
    assert evoframe(*arguments, "--retry").returncode == 0


def test_champions_that_were_not_verified_are_verified_by_the_next_sitting(
    evoframe: Evoframe, toy: list[str], tmp_path: Path
) -> None:
    unverifiable = 'grid.simulator=[{name="toy-unverifiable", fixed="fixed"}]'
    arguments = ["study", *toy, "--set", unverifiable, "--set", "runs=1", "--out", "s"]
    failed = evoframe(*arguments)
    assert failed.returncode == 1
    assert ": no variant fits" in failed.stderr
    (tmp_path / "fixed").touch()
    assert evoframe(*arguments).returncode == 1  # not tried again
    first, second = (tmp_path / "s").glob("*/*/00")
    (first / "failure.json").unlink()  # as if the process had been killed before it verified
    left = evoframe(*arguments, "--dry-run", "--retry")
    assert "1 finished, of which 1 to verify, 1 to run" in left.stdout
    assert evoframe(*arguments).returncode == 1  # the second has failed
    assert evoframe(*arguments, "--retry").returncode == 0
    for directory in (first, second):
        assert load_run(directory).verification() is not None
        assert load_run(directory).resumes() == []


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGKILL])
def test_that_is_interrupted_ends_with_the_same_tables(
    evoframe: Evoframe, toy: list[str], tmp_path: Path, number: signal.Signals
) -> None:
    arguments = ["study", *toy, "--set", "runs=2"]
    assert evoframe(*arguments, "--out", "undisturbed").returncode == 0
    for _ in range(2):
        with started(tmp_path, *arguments, "--workers", "1", "--out", "left") as process:  # 8 runs in a row
            told(process, "finished, best pair")
            process.send_signal(number)
            if number == signal.SIGINT:
                told(process, "Stopping")
                told(process, "Interrupted")
                assert ended(process) == 130
    assert evoframe(*arguments, "--out", "left").returncode == 0
    assert tables(tmp_path / "left") == tables(tmp_path / "undisturbed")


def test_a_run_whose_process_is_killed_is_resumed_by_another(toy: list[str], tmp_path: Path) -> None:
    arguments = ["study", *toy, "-p", pausing.__file__, "--workers", "1", "--set", "runs=1", "--out", "s"]
    (tmp_path / "pause").touch()
    with started(tmp_path, *arguments) as process:
        eventually(lambda: any(map(has_saved_a_turn, (tmp_path / "s").glob("*/*/00"))), "no turn was saved")
        [worker] = children(process.pid)
        os.kill(worker, signal.SIGKILL)
        eventually(lambda: set(children(process.pid)) - {worker}, "the worker was not replaced")
        (tmp_path / "pause").unlink()
        assert ended(process) == 0, process.log
    resumes = [load_run(path.parent).resumes() for path in (tmp_path / "s").glob("*/*/00/config.toml")]
    assert sorted(map(len, resumes)) == [0, 0, 0, 1]


def has_saved_a_turn(directory: Path) -> bool:
    if not (directory / "config.toml").exists():
        return False
    with open_run(directory) as run:
        return run.begun and run.last_turn() is not None


def test_a_run_that_ends_its_workers_has_failed_and_the_others_go_on(
    evoframe: Evoframe, toy: list[str], tmp_path: Path
) -> None:
    fatal = 'grid.simulator=["toy-product", {name="toy-fatal", fixed="fixed"}]'
    arguments = ["study", *toy, "--workers", "1", "--set", "runs=1", "--set", fatal, "--out", "s"]
    failed = evoframe(*arguments)
    assert failed.returncode == 1
    assert failed.stderr.count("exit code 3; 5 of them") == 4  # when they fail, and at the end
    assert "2 runs failed; to repeat, add --retry" in failed.stderr
    (tmp_path / "fixed").touch()
    assert evoframe(*arguments, "--retry").returncode == 0


def test_workers_end_with_the_study(toy: list[str], tmp_path: Path) -> None:
    hanging = 'grid.simulator=[{name="toy-hanging", beyond=-1.0, fixed="fixed"}]'
    with started(tmp_path, "study", *toy, "--set", hanging, "--out", "left") as process:
        eventually(lambda: len(children(process.pid)) == available_cores(), "not all workers started")
        workers = children(process.pid)
        process.kill()
    eventually(lambda: all(map(is_ended, workers)), "a worker still runs")


def test_runs_at_which_another_process_is_are_left_to_it(
    evoframe: Evoframe, toy: list[str], tmp_path: Path
) -> None:
    with started(tmp_path, "study", *toy, "--workers", "1", "--out", "s") as process:
        told(process, "finished, best pair")
        other = evoframe("study", *toy, "--workers", "1", "--out", "s")
        code = ended(process)
    assert 0 in (code, other.returncode)  # 1 for the one that left the last run to the other
    assert "failed" not in other.stderr
    assert len(list((tmp_path / "s").glob("*/*/0?/champion.json"))) == 12
    for config in (tmp_path / "s").glob("*/*/0?/config.toml"):
        assert load_run(config.parent).resumes() == []


@pytest.mark.parametrize("attempt", range(4))
def test_processes_that_start_together_divide_the_runs_among_them(
    toy: list[str], tmp_path: Path, attempt: int
) -> None:
    arguments = ["study", *toy, "--workers", "1", "--out", "s"]
    with started(tmp_path, *arguments) as one, started(tmp_path, *arguments) as other:
        assert {ended(other), ended(one)} <= {0, 1}, [
            one.log,
            other.log,
        ]  # 1: it left the last run to the other
    said = "".join(one.log + other.log)
    assert "failed" not in said
    assert 0 in (one.returncode, other.returncode), said
    assert not list((tmp_path / "s").rglob("failure.json"))
    assert len((tmp_path / "s" / "rows.csv").read_text().splitlines()) == 13
    for config in (tmp_path / "s").glob("*/*/0?/config.toml"):
        assert load_run(config.parent).finished()
        assert load_run(config.parent).resumes() == []


def test_a_picture_on_a_terminal(toy: list[str], tmp_path: Path) -> None:
    shown = on_a_terminal(["study", *toy], tmp_path, lines=40)
    text = " ".join(re.sub(r"\x1b\[[0-9;?]*[A-Za-z]", "", shown).split())  # lines are broken anywhere
    assert "n simulator done running best pair median" in text
    assert re.search(r"\d+/12 runs done, [12] running, \d+ left, [\d,]+ pairs/s, \d+ s left", text)
    assert shown.count("\x1b[?25l") == shown.count("\x1b[?25h") > 0  # the cursor
