"""All texts that people read most, in one file: help, errors, results and conclusions.

The snapshot `__snapshots__/test_texts.ambr` is reviewed like prose. After changing a text, update it with
`pytest tests/texts --snapshot-update`. Other tests assert types and data, not sentences.
"""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Iterator
from pathlib import Path

import click
import numpy as np
import pytest
import toys
from click.testing import CliRunner, Result
from syrupy.assertion import SnapshotAssertion
from toy_study import STUDY

from evoframe.cli.program import COMMANDS, cli

TOYS = ("-p", toys.__file__)
Run = Callable[..., Result]


def commands() -> Iterator[tuple[str, ...]]:
    """Yield every command of the program, with those of its groups."""
    yield ()
    context = click.Context(cli)
    for name in COMMANDS:
        yield (name,)
        command = cli.get_command(context, name)
        if isinstance(command, click.Group):
            yield from ((name, inner) for inner in command.commands)


@pytest.fixture
def run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Run:
    """Run the program in an empty directory."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "toy.toml").write_text(toys.CONFIGURATION)
    monkeypatch.setenv("COLUMNS", "100")
    runner = CliRunner()
    return lambda *arguments: runner.invoke(cli, list(map(str, arguments)), prog_name="evoframe")


def plain(text: str) -> str:
    """Return a text without what differs between computers and times."""
    text = text.replace(toys.__file__, "toys.py")
    text = re.sub(r"\b\d+(\.\d+)? s\b", "N s", text)
    text = re.sub(r"[\d,]+ (simulations|pairs)/s", r"N \1/s", text)
    text = re.sub(r"[\d,]+ MB", "N MB", text)
    text = re.sub(r"on \d+ cores?", "on N cores", text)
    return "\n".join(line.rstrip() for line in text.splitlines())


@pytest.mark.parametrize("command", list(commands()), ids=" ".join)
def test_help(run: Run, snapshot: SnapshotAssertion, command: tuple[str, ...]) -> None:
    result = run(*command, "--help")
    assert result.exit_code == 0
    assert result.output == snapshot


def files(directory: Path) -> None:
    """Write the files that the mistakes below are about."""
    texts = {
        "bad.toml": '[simulatr]\nx = 1\n[aggregator]\nname = "wm"\nweights = [0.5, "a"]\n',
        "syntax.toml": "[run\n",
        "circle.toml": 'extends = "circle.toml"\n',
        "champion.json": "{}",
        "body.vxa": "<VXA><Simulator/></VXA>",
        "letter.npz": "Dear",
        "rows.csv": "a,b\n1,2\n",
        "grid.toml": 'extends = "toy.toml"\nruns = 0\n[grid]\n"run.seed" = [1]\n',
        "full/letter.txt": "Dear",
        "broken/config.toml": "extends = false\n",
        "mine.py": "import nothing_of_that_name\n",
    }
    for name, text in texts.items():
        (directory / name).parent.mkdir(exist_ok=True)
        (directory / name).write_text(text)
    solid, still = np.ones((2, 3, 2, 2), np.uint8), np.zeros((2, 3, 2, 2))
    np.savez(directory / "two.npz", material=solid, phase_cycles=still)
    np.savez(directory / "code.npz", material=2 * solid, phase_cycles=still)
    (directory / "empty").mkdir()


MISTAKES = [  # without those that click reports in its own words
    "run papre",
    "run small",
    "run grid.toml",
    "run nowhere.toml",
    "run bad.toml",
    "run syntax.toml",
    "run circle.toml",
    "run empty",
    "run --out full",
    "run -p mine.py",
    "run -p nowhere.py",
    "run --set aggregator=wn",
    "run --set aggregator",
    "run --set generations=3",
    "run --set n=5",
    "run --set strategy=worst",
    "run --set collaboration=hm",
    "run --set collaboration.n=4",
    "run --set collaboration.n=30",
    "run --set simulator.step=1",
    "run --set run.generations=many",
    "run --set run.seed=-1",
    "run --set aggregator=wn --set collaboration.n=30",
    "run --set simulator.duration=0.02",
    "run --set populations.controller.size=1",
    "resume nowhere",
    "resume empty",
    "resume broken",
    "simulate nowhere.npz",
    "simulate quick",
    "simulate letter.npz",
    "simulate code.npz",
    "simulate champion.json",
    "simulate body.vxa",
    "simulate empty",
    "simulate two.npz --trace trace.csv",
    "verify empty",
    "export two.npz --to vxa",
    "export two.npz --to stl",
    "report nowhere",
    "report empty",
    "robustness",
    "robustness nowhere",
    "study papre",
    "study quick",
    "study grid.toml",
    "study toy.toml",
    "study small --import rows.csv",
    "study small --out full",
    "doctor nowhere",
    "config new bad.toml",
]


@pytest.mark.parametrize("words", MISTAKES)
def test_mistake(run: Run, snapshot: SnapshotAssertion, tmp_path: Path, words: str) -> None:
    files(tmp_path)
    before = {path: path.read_bytes() for path in tmp_path.rglob("*") if path.is_file()}
    result = run(*words.split())
    assert result.exit_code == 2
    assert result.output == snapshot
    assert {path: path.read_bytes() for path in before} == before


@pytest.fixture
def toy_run(run: Run) -> Result:
    result = run(*TOYS, "run", "toy.toml", "--set", "simulator=toy-varied", "--out", "here")
    assert result.exit_code == 0, result.output
    return result


def test_run(toy_run: Result, snapshot: SnapshotAssertion) -> None:
    assert plain(toy_run.output) == snapshot


AFTER_A_RUN = [
    "run toy.toml --out here",
    "resume here",
    "resume here --set run.generations=9",
    "verify here",
    "verify here --set simulator=toy-product",
    "simulate here",
    "export here --to tyo",
    "doctor here",
    "report here",
]


@pytest.mark.parametrize("words", AFTER_A_RUN)
def test_after_a_run(run: Run, toy_run: Result, snapshot: SnapshotAssertion, words: str) -> None:
    assert plain(run(*TOYS, *words.split()).output) == snapshot


def test_a_run_of_a_local_plugin_without_it(run: Run, toy_run: Result, snapshot: SnapshotAssertion) -> None:
    assert plain(run("verify", "here").output) == snapshot


def test_damaged_run(run: Run, toy_run: Result, snapshot: SnapshotAssertion, tmp_path: Path) -> None:
    path = tmp_path / "here" / "champion.json"
    document = json.loads(path.read_text())
    path.write_text(json.dumps({**document, "score": 1.0}))
    assert plain(run(*TOYS, "doctor", "here").output) == snapshot


def test_study(run: Run, snapshot: SnapshotAssertion, tmp_path: Path) -> None:
    (tmp_path / "grid.toml").write_text(STUDY)
    texts = [
        run(*TOYS, "study", "grid.toml", "--dry-run", "--workers", 1),
        run(*TOYS, "study", "grid.toml", "--workers", 1, "--out", "s"),
        run(*TOYS, "study", "grid.toml", "--set", "populations.a.size=7", "--out", "s"),
        run(*TOYS, "report", "s"),
        run(*TOYS, "robustness", "s", "--controllers", 5),
    ]
    assert [plain(result.output) for result in texts] == snapshot


def test_conclusions_of_robustness(run: Run, snapshot: SnapshotAssertion) -> None:
    settings = ("--preset", "toy.toml", "--set", "simulator=toy-steered", "--controllers", 40)
    assert plain(run(*TOYS, "robustness", "--published", *settings).output) == snapshot
