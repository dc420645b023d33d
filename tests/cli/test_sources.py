"""Arguments that name runs, studies, presets or files."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
import toys
from processes import Evoframe
from toy_study import STUDY

TOYS = ("-p", toys.__file__)


@pytest.fixture
def study(evoframe: Evoframe, tmp_path: Path) -> Path:
    (tmp_path / "toy.toml").write_text(toys.CONFIGURATION)
    (tmp_path / "grid.toml").write_text(STUDY.replace('"toy-product", ', ""))
    made = evoframe("study", *TOYS, "grid.toml", "--set", "runs=1", "--out", "s")
    assert made.returncode == 0, made.stderr
    return tmp_path / "s"


def test_a_study_stands_for_its_runs(evoframe: Evoframe, study: Path, tmp_path: Path) -> None:
    runs = [str(path.parent.relative_to(tmp_path)) for path in sorted(study.glob("*/*/00/config.toml"))]
    assert len(runs) == 2
    for command in ("simulate", "verify"):
        shown = evoframe(command, *TOYS, "s", "--json")
        assert (shown.returncode, shown.stdout) == (0, evoframe(command, *TOYS, *runs, "--json").stdout)
    assert list(json.loads(evoframe("doctor", *TOYS, "s", "--json").stdout)) == runs


def test_no_file_of_a_study_or_its_runs_is_overwritten(
    evoframe: Evoframe, study: Path, tmp_path: Path
) -> None:
    [first, *_] = sorted(study.glob("*/*/00"))
    for path in (study / "rows.csv", study / "study.toml", first / "champion.json", first / "run.db"):
        before = path.read_bytes()
        name = str(path.relative_to(tmp_path))
        refused = evoframe("simulate", *TOYS, "s", "--trace", name, "--force")
        assert refused.returncode == 2
        assert refused.stderr.startswith(f"Error: {name}: is an input")
        assert path.read_bytes() == before


@pytest.mark.parametrize("command", ["study", "resume"])
def test_a_directory_continues_its_study(evoframe: Evoframe, study: Path, command: str) -> None:
    rows = (study / "rows.csv").read_bytes()
    again = evoframe(command, *TOYS, "s")
    assert (again.returncode, "runs done" in again.stderr) == (0, False)
    assert (study / "rows.csv").read_bytes() == rows


def test_a_directory_continues_a_study_that_was_interrupted(evoframe: Evoframe, study: Path) -> None:
    [first, _] = sorted(study.glob("*/*/00"))
    for path in first.iterdir():
        path.unlink()
    again = evoframe("study", *TOYS, "s", "--workers", 1)
    assert again.returncode == 0, again.stderr
    assert "2/2 runs" in again.stderr
    assert (first / "champion.json").is_file()


@pytest.mark.parametrize(
    ("words", "todo"),
    [
        ("run small", "evoframe study small"),
        ("run s", "evoframe study s"),
        ("study quick", "evoframe run quick"),
    ],
)
def test_the_command_for_a_name_of_another_kind_is_suggested(
    evoframe: Evoframe, study: Path, words: str, todo: str
) -> None:
    refused = evoframe(*words.split())
    assert refused.returncode == 2
    assert refused.stderr.startswith(f"Error: {words.split()[1]}: ")
    assert refused.stderr.endswith(f"{todo}\n")


def test_a_run_is_not_a_configuration(evoframe: Evoframe, tmp_path: Path) -> None:
    assert evoframe("run", "quick", "--set", "run.generations=0", "--out", "here").returncode == 0
    refused = evoframe("run", "here")
    assert refused.returncode == 2
    assert refused.stderr.endswith("evoframe resume here\n")
