"""Options and output that several commands share."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
import toys
from processes import Evoframe, with_pipe

from evoframe import InputError, load_run
from evoframe.cli.context import needing_extra, scored


@pytest.mark.parametrize("before", [True, False])
def test_quiet_says_only_where_the_run_is(evoframe: Evoframe, before: bool) -> None:
    command = ["run", "quick", "--set", "run.generations=0"]
    ran = evoframe("-q", *command) if before else evoframe(*command, "--quiet")
    assert (ran.stdout, ran.stderr) == ("runs/quick-generations0-1\n", "")


def test_no_colour_where_there_is_no_terminal_or_none_is_wanted(evoframe: Evoframe) -> None:
    ran = evoframe("run", "quick", "--set", "run.generations=0", NO_COLOR="1", FORCE_COLOR="1")
    assert not re.search(r"\x1b\[[0-9;]*3[0-7]m", ran.stdout + ran.stderr)


def test_verbose_tells_of_better_pairs_and_doubly_verbose_of_every_turn(evoframe: Evoframe) -> None:
    def told(*flags: str) -> str:
        return evoframe(*flags, "run", "quick", "--set", "run.generations=2").stderr

    assert "turn 0: " not in told()
    assert "turn 0: " in told("-v")
    assert "turn 4: controller: " not in told("-v")
    assert "turn 4: controller: " in told("-vv")


def test_names_are_shown_as_they_are_written(evoframe: Evoframe) -> None:
    ran = evoframe("run", "quick", "--set", "run.generations=0", "--out", "r[/a] [bold]x :smile:")
    assert ran.returncode == 0, ran.stderr
    assert "directory" in ran.stdout
    assert "r[/a] [bold]x :smile:" in ran.stdout


def test_a_score_is_shown_with_its_unit() -> None:
    assert scored(0.0037813379, "m") == "3.781 mm"
    assert scored(2.0, "") == "2"
    assert scored(None, "m") == "diverged"


def test_what_an_extra_brings_is_named_where_it_is_missing() -> None:
    with pytest.raises(InputError) as caught, needing_extra("report", "tea"):
        raise ModuleNotFoundError(name="nowhere.near")
    for part in ("tea", "nowhere", "pip install '.[report]'"):
        assert part in str(caught.value)


@pytest.mark.parametrize(
    "placed", [("-q", "config", "show"), ("config", "-q", "show"), ("config", "show", "-q")]
)
def test_common_options_stand_anywhere(evoframe: Evoframe, placed: tuple[str, ...]) -> None:
    assert evoframe(*placed).returncode == 0


@pytest.mark.parametrize(
    "command",
    [
        ("simulate", "one.toy", "two.toy"),
        ("simulate", "one.toy", "--trace", "trace.csv"),
        ("verify", "one.toy", "two.toy"),
        ("export", "one.toy", "--to", "toy", "--out", "exported.toy"),
        ("robustness", "one.toy", "two.toy", "--controllers", "2", "--out", "measured"),
        ("robustness", "--published", "--controllers", "2", "--out", "measured"),
    ],
    ids=" ".join,
)
def test_a_preset_may_come_from_a_pipe(evoframe: Evoframe, tmp_path: Path, command: tuple[str, ...]) -> None:
    """It is read once, also for several files; a second command refuses to write anything else."""
    text = toys.CONFIGURATION
    (tmp_path / "toy.toml").write_text(text)
    for name in ("one", "two"):
        (tmp_path / f"{name}.toy").write_text("designs = [{ a = 2.0, b = 3.0 }]\nsettings = { gain = 2.0 }\n")
    simulator = "toy-steered" if command[0] == "robustness" else "toy-varied"
    words = [*command, "-p", toys.__file__, "--set", f"simulator={simulator}", "--preset"]
    from_file, piped = evoframe(*words, "toy.toml"), with_pipe(text, *words, directory=tmp_path)
    assert from_file.returncode == 0, from_file.stderr
    assert (piped.returncode, piped.stdout, piped.stderr) == (0, from_file.stdout, from_file.stderr)


NUMBERED = """
import attrs, toys
from evoframe import hookimpl

@attrs.frozen
class Numbered(toys.Varied):
    bit_generation = {number}

    def _amplified(self, outcome):
        return attrs.evolve(outcome, tracks={{"value": {factor!r} * outcome.tracks["value"]}})

@hookimpl
def evoframe_simulators():
    return {{"numbered": Numbered}}
"""


def test_scores_of_another_bit_generation_are_named_where_they_differ(
    evoframe: Evoframe, tmp_path: Path
) -> None:
    def numbered(*command: str, number: int, factor: float) -> tuple[int, str]:
        (tmp_path / "numbered.py").write_text(NUMBERED.format(number=number, factor=factor))
        plugins = ["-p", toys.__file__, "-p", "numbered.py"]
        ran = evoframe(*command, *plugins, PYTHONPATH=str(Path(toys.__file__).parent))
        return ran.returncode, ran.stderr

    (tmp_path / "toy.toml").write_text(toys.CONFIGURATION)
    made = ("run", "toy.toml", "--set", "simulator=numbered", "--out", "here", "-q")
    assert numbered(*made, number=1, factor=1.0) == (0, "")
    score = load_run(tmp_path / "here").champion().score
    warning = (
        f"Warning: here: scored {score!r} in the run; bit generation of simulator 'numbered': 1 then, 2 now\n"
    )
    for command in (("simulate", "here"), ("verify", "here")):
        assert numbered(*command, number=2, factor=1.0) == (0, "")
        assert numbered(*command, number=2, factor=1.0 + 1e-12) == (0, warning)
        assert numbered(*command, "-q", number=2, factor=1.0 + 1e-12) == (0, "")
    assert load_run(tmp_path / "here").verification() is not None
    (tmp_path / "here" / "verification.json").unlink()
    verified = numbered("resume", "here", number=2, factor=1.0 + 1e-12)
    assert verified[0] == 0
    assert warning in verified[1]
    assert numbered("doctor", "here", number=2, factor=1.0 + 1e-12) == (0, "")
