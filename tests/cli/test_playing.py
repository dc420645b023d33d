"""What a run shows at its end, and when it is interrupted."""

from __future__ import annotations

import contextlib
import signal
from pathlib import Path

import toys
from processes import Evoframe, Program, ended, started, told

import evoframe as package


def slow_run(directory: Path, *settings: str) -> contextlib.AbstractContextManager[Program]:
    """Start a run of toys that takes its time."""
    (directory / "toy.toml").write_text(toys.CONFIGURATION)
    options = [option for setting in settings for option in ("--set", setting)]
    return started(directory, "run", "-v", "-p", toys.__file__, "toy.toml", "--out", "here", *options)


def test_the_summary_counts_the_pairs_that_diverged(evoframe: Evoframe, tmp_path: Path) -> None:
    (tmp_path / "toy.toml").write_text(toys.CONFIGURATION)
    ran = evoframe("-p", toys.__file__, "run", "toy.toml", "--set", "simulator.limit=0.15", "--out", "here")
    assert ran.returncode == 0, ran.stderr
    pairs = package.load_run(tmp_path / "here").pairs()
    diverged = sum(pair["score"] is None for pair in pairs)
    assert diverged > 0
    assert f" {diverged} diverged" in ran.stdout


def test_ends_with_the_verification_of_its_champion(evoframe: Evoframe, tmp_path: Path) -> None:
    (tmp_path / "toy.toml").write_text(toys.CONFIGURATION)
    command = ["run", "-p", toys.__file__, "toy.toml", "--set", "simulator=toy-varied"]
    ran = evoframe(*command, "--out", "here")
    assert ran.returncode == 0, ran.stderr
    summary, table = ran.stdout.split("\n\n")
    *rows, verdict = table.splitlines()
    assert "best pair" in summary
    assert [line.split()[0] for line in rows] == [
        "variant", "unchanged", "gain", "no", "one",
    ]  # fmt: skip
    assert verdict.startswith("The score comes from gain")
    assert "verifying" in ran.stderr
    assert f"evoframe report here -p {toys.__file__}" in ran.stderr
    quiet = evoframe("-q", *command, "--out", "quiet")
    assert (quiet.stdout, quiet.stderr) == ("quiet\n", "")
    stored = [(tmp_path / name / "verification.json").read_bytes() for name in ("here", "quiet")]
    assert stored[0] == stored[1]


def test_warns_of_simulations_that_the_objective_overlooks(evoframe: Evoframe, tmp_path: Path) -> None:
    short = ("run", "quick", "--set", "run.generations=0")
    warned = evoframe(*short, "--set", "simulator.duration=0.14", "--out", "here")
    assert warned.returncode == 0, warned.stderr
    assert "Warning: here: the objective 'tip-dz' looks at the first 0.067 s of 0.14 s\n" in warned.stderr
    assert "Warning" not in evoframe(*short, "--out", "there").stderr


def test_without_variants_says_nothing_of_a_verification(evoframe: Evoframe, tmp_path: Path) -> None:
    (tmp_path / "toy.toml").write_text(toys.CONFIGURATION)
    ran = evoframe("run", "-p", toys.__file__, "toy.toml", "--out", "here")
    assert (ran.returncode, "verify" in ran.stderr, "unchanged" in ran.stdout) == (0, False, False)


def test_a_moving_champion_is_promised_only_with_a_geometry(evoframe: Evoframe) -> None:
    drawn = evoframe("run", "quick", "--set", "run.generations=0", "--out", "drawn")
    plain = evoframe("run", "functions", "--set", "run.generations=0", "--out", "plain")
    assert (drawn.returncode, plain.returncode) == (0, 0)
    assert "moving:\n  evoframe report drawn\n" in drawn.stderr
    assert plain.stderr.endswith("\nNext, figures:\n  evoframe report plain\n")


def test_a_verification_that_fails_is_an_error_after_the_summary(evoframe: Evoframe, tmp_path: Path) -> None:
    (tmp_path / "toy.toml").write_text(toys.CONFIGURATION)
    ran = evoframe(
        "run", "-p", toys.__file__, "toy.toml", "--set", "simulator=toy-unverifiable", "--out", "here"
    )
    assert ran.returncode == 1
    assert "best pair" in ran.stdout
    assert ran.stderr.splitlines()[-1].startswith("Error: here: ")
    assert ran.stderr.splitlines()[-1].endswith(": no variant fits")
    assert package.load_run(tmp_path / "here").summary()["turns"] == 8


def test_an_interrupt_of_the_verification_leaves_the_complete_run(tmp_path: Path) -> None:
    with slow_run(tmp_path, "simulator={name='toy-unverifiable', delay=3600.0}") as process:
        told(process, "verifying")
        process.send_signal(signal.SIGINT)
        assert "evoframe verify here" in told(process, "Interrupted")
        assert ended(process) == 130
    assert package.load_run(tmp_path / "here").summary()["turns"] == 8


def test_interrupt_stops_after_the_turn_and_keeps_it(tmp_path: Path) -> None:
    with slow_run(tmp_path, "simulator={name='toy-slow', delay=0.2}", "run.generations=100") as process:
        told(process, "turn 0")
        process.send_signal(signal.SIGINT)
        told(process, "Interrupted")
        assert ended(process) == 130
    turns = package.load_run(tmp_path / "here").turns()
    assert 2 <= len(turns) < 200


def test_a_second_interrupt_stops_at_once(tmp_path: Path) -> None:
    with slow_run(tmp_path, "simulator={name='toy-slow', delay=3600.0}") as process:
        told(process, "seed 3: 8 turns")
        process.send_signal(signal.SIGINT)
        told(process, "Ctrl-C")
        process.send_signal(signal.SIGINT)
        told(process, "Interrupted")
        assert ended(process) == 130
    assert package.load_run(tmp_path / "here").turns() == []
