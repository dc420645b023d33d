"""``evoframe run``."""

from __future__ import annotations

import re
from pathlib import Path

import toys
from processes import Evoframe, with_pipe

import evoframe as package
from evoframe.messages import quantity


def test_ends_with_a_summary_and_the_directory(evoframe: Evoframe, tmp_path: Path) -> None:
    ran = evoframe("run", "quick", "--seed", 4)
    assert ran.returncode == 0
    champion = package.load_run(tmp_path / "runs" / "quick-4").champion()
    assert quantity(champion.score, "m") in ran.stdout
    assert "runs/quick-4" in ran.stdout
    assert re.search(r"turn 10/10 .* morphology \S+ mm .* controller \S+ mm .*/s .*%", ran.stderr)


def test_a_directory_that_is_in_use_is_refused(evoframe: Evoframe, tmp_path: Path) -> None:
    assert evoframe("run", "quick", "--set", "run.generations=0", "--out", "here").returncode == 0
    before = (tmp_path / "here" / "run.db").read_bytes()
    again = evoframe("run", "quick", "--set", "run.generations=0", "--out", "here")
    assert again.returncode == 2
    assert again.stderr.startswith("Error: here: ")
    assert "--out" in again.stderr
    assert (tmp_path / "here" / "run.db").read_bytes() == before


def test_the_fittest_who_have_not_met_do_at_the_end(evoframe: Evoframe, tmp_path: Path) -> None:
    (tmp_path / "toy.toml").write_text(toys.CONFIGURATION)
    last = ["--set", "collaboration={name='toy-last'}"]
    ran = evoframe("run", "-p", toys.__file__, "toy.toml", *last, "--out", "here")
    assert ran.returncode == 0, ran.stderr
    assert re.search(r"\b8 turns, .* here$", ran.stderr, re.MULTILINE)
    finished = package.load_run(tmp_path / "here")
    assert finished.summary()["turns"] == 8
    assert sum(pair["turn"] == 9 for pair in finished.pairs()) == 1


def test_a_configuration_may_come_from_a_pipe(tmp_path: Path) -> None:
    """It is read once, as from a process substitution of a shell."""
    given = "extends = 'quick'\n[run]\ngenerations = 0"
    ran = with_pipe(given, "run", "--out", "here", "-q", directory=tmp_path)
    assert (ran.returncode, ran.stderr) == (0, "")
    assert package.load_run(tmp_path / "here").config["run"]["generations"] == 0
