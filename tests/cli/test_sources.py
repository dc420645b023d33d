"""Arguments that name runs, studies, presets or files."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
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


PRACTICE = Path(__file__).parents[1] / "data" / "vxa" / "practice"


class TestFileOptions:
    """Reading of files of other programs: ``--dialect`` and ``--base``, for all commands that read files."""

    @pytest.fixture
    def swimmer(self, tmp_path: Path) -> Path:
        """A file whose weight depends on a dialect that it does not tell."""
        text = (PRACTICE / "line_fluid_75000.vxa").read_text()
        path = tmp_path / "swimmer.vxa"
        path.write_text(
            text.replace(
                "<GravEnabled>0</GravEnabled><GravAcc>0<", "<GravEnabled>1</GravEnabled><GravAcc>-1<"
            )
        )
        return path

    @pytest.mark.parametrize(
        "command",
        [
            ["simulate"],
            ["verify"],
            ["export", "--to", "npz", "--out", "-"],
            ["robustness", "--controllers", "1"],
        ],
    )
    def test_are_asked_for_by_name(self, evoframe: Evoframe, swimmer: Path, command: list[str]) -> None:
        refused = evoframe(command[0], "swimmer.vxa", *command[1:])
        assert refused.returncode == 2
        assert refused.stderr.startswith("Error: swimmer.vxa: Environment/FluidEnvironment: ")
        assert "--dialect fork or --dialect evosoro" in refused.stderr

    def test_are_named_on_standard_error_and_in_json(self, evoframe: Evoframe, swimmer: Path) -> None:
        scores = {}
        for dialect in ("fork", "evosoro"):
            shown = evoframe("simulate", "swimmer.vxa", "--dialect", dialect, "--json")
            assert shown.stderr.startswith(f"swimmer.vxa: read by the rules of {dialect}")
            assert json.loads(shown.stdout)["dialect"] == [dialect]
            scores[dialect] = json.loads(shown.stdout)["score"]
            [verified] = json.loads(evoframe("verify", "swimmer.vxa", "--dialect", dialect, "--json").stdout)
            assert verified["dialect"] == dialect
        assert scores["fork"] != scores["evosoro"]

    def test_are_not_named_if_only_the_output_is_asked_for(self, evoframe: Evoframe, swimmer: Path) -> None:
        assert evoframe("simulate", "-q", "swimmer.vxa", "--dialect", "fork").stderr == ""

    def test_are_kept_with_a_measurement(self, evoframe: Evoframe, swimmer: Path, tmp_path: Path) -> None:
        command = ["swimmer.vxa", "--dialect", "evosoro", "--controllers", "1", "--out", "measured"]
        measured = evoframe("robustness", *command)
        assert measured.returncode == 0, measured.stderr
        assert "read by the rules of evosoro" in measured.stderr
        kept = json.loads((tmp_path / "measured" / "robustness.json").read_text())
        assert [body["dialect"] for body in kept["bodies"]] == ["evosoro"]

    def test_complete_a_file(self, evoframe: Evoframe, tmp_path: Path) -> None:
        base, path = PRACTICE / "walker_ascii.vxa", PRACTICE / "walker.vxd"
        shown = evoframe("simulate", path, "--base", base, "--json")
        alone = evoframe("simulate", base, "--json")
        assert json.loads(shown.stdout)["score"] == json.loads(alone.stdout)["score"]

    def test_a_base_is_an_input_that_is_not_overwritten(self, evoframe: Evoframe, tmp_path: Path) -> None:
        (tmp_path / "b.vxa").write_bytes((PRACTICE / "walker_ascii.vxa").read_bytes())
        command = ["simulate", PRACTICE / "walker.vxd", "--base", "b.vxa", "--trace", "b.vxa", "--force"]
        refused = evoframe(*command)
        assert (refused.returncode, "\nError: b.vxa: is an input" in refused.stderr) == (2, True)

    @pytest.mark.parametrize("option", [["--dialect", "fork"], ["--base", "b.vxa"]])
    def test_are_refused_for_sources_without_a_choice(
        self, evoframe: Evoframe, tmp_path: Path, option: list[str]
    ) -> None:
        np.savez(tmp_path / "a.npz", material=np.ones((2, 2, 2), np.uint8), phase_cycles=np.zeros((2, 2, 2)))
        refused = evoframe("simulate", "a.npz", *option)
        assert (refused.returncode, refused.stderr.startswith(f"Error: {option[0]}: a.npz ")) == (2, True)

    def test_an_unknown_dialect_is_refused_with_the_known_ones(self, evoframe: Evoframe) -> None:
        refused = evoframe("simulate", PRACTICE / "walker_ascii.vxa", "--dialect", "voxcad")
        assert refused.returncode == 2
        assert "fork, evosoro, voxcraft" in refused.stderr


def test_an_empty_body_does_not_refuse_the_others_of_its_file(evoframe: Evoframe, tmp_path: Path) -> None:
    material = np.ones((2, 4, 2, 2), np.uint8)
    material[0] = 0
    np.savez(tmp_path / "two.npz", material=material, phase_cycles=np.zeros(material.shape))
    shown = json.loads(evoframe("simulate", "two.npz", "--json").stdout)
    assert (shown["diverged"], shown["diverged_at"]) == ([True, False], [0, None])
    verified = evoframe("verify", "two.npz", "--json")
    assert verified.returncode == 0, verified.stderr


def test_a_body_is_exported_as_arrays_and_simulates_the_same(evoframe: Evoframe, tmp_path: Path) -> None:
    (tmp_path / "body.vxa").write_bytes((PRACTICE / "walker_ascii.vxa").read_bytes())
    exported = evoframe("export", "body.vxa", "--to", "npz")
    assert (exported.returncode, exported.stdout) == (0, "body.npz\n")
    assert "not exported: the settings" in exported.stderr
    again = np.load(tmp_path / "body.npz")
    assert again["material"].shape == again["phase_cycles"].shape == (3, 2, 3)
    first = (tmp_path / "body.npz").read_bytes()
    assert evoframe("export", "body.vxa", "--to", "npz", "--force").returncode == 0
    assert (tmp_path / "body.npz").read_bytes() == first
