"""Arguments that name runs, studies, presets or files."""

from __future__ import annotations

import json
from pathlib import Path

import pausing
import pytest
import toys
from processes import Evoframe, started, told
from toy_study import STUDY

from evoframe import load_run

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
    ("words", "code"),
    [
        ("resume RUN", 2),
        ("report RUN", 2),
        ("report s", 2),
        ("verify RUN", 2),
        ("simulate RUN", 2),
        ("simulate s", 2),
        ("export RUN --to toy --out champion.toy", 2),
        ("robustness RUN", 2),
        ("robustness s", 2),
        ("study s", 2),
        ("doctor RUN", 1),
    ],
)
def test_a_run_whose_configuration_was_edited_is_refused_with_the_difference(
    evoframe: Evoframe, study: Path, tmp_path: Path, words: str, code: int
) -> None:
    config = min(study.glob("*/*/00/config.toml"))
    config.write_text(config.read_text().replace("generations = 4", "generations = 5"))
    run = str(config.parent.relative_to(tmp_path))
    command, *arguments = words.replace("RUN", run).split()
    refused = evoframe(command, *TOYS, *arguments)
    assert refused.returncode == code, refused.stdout + refused.stderr
    assert "run.generations: 4 recorded, 5 in config.toml" in refused.stdout + refused.stderr
    assert f"{run}/config.toml" in refused.stdout + refused.stderr


PLUGIN = """
import attrs
from evoframe import hookimpl

@attrs.frozen
class Extreme:
    domain = (-1e100, 1e100)
    def check(self, n): pass
    def aggregate(self, scores): return float(max(scores))

@hookimpl
def evoframe_aggregators():
    return {"extreme": Extreme}
"""


def test_a_local_plugin_that_was_edited_is_refused_until_it_is_allowed(
    evoframe: Evoframe, study: Path, tmp_path: Path
) -> None:
    (tmp_path / "mine.py").write_text(PLUGIN)
    options = (*TOYS, "-p", "mine.py")
    (tmp_path / "pause").touch()
    arguments = ["-p", pausing.__file__, "-v", "toy.toml", "--set", "aggregator=extreme", "--out", "r"]
    with started(tmp_path, "run", *options, *arguments) as process:
        told(process, "turn 0")
    (tmp_path / "mine.py").write_text(PLUGIN.replace("max", "min"))
    refused = evoframe("resume", *options, "r")
    assert refused.returncode == 2
    assert "\n  local_plugins.mine: 'sha256:" in refused.stderr
    checked = evoframe("doctor", *options, "r")
    assert "local_plugins.mine: 'sha256:" in checked.stdout + checked.stderr
    allowed = evoframe("resume", *options, "r", "--allow-different-versions")
    assert allowed.returncode == 0, allowed.stderr
    [resumed] = load_run(tmp_path / "r").resumes()
    assert "local_plugins.mine" in resumed["differences"]


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
