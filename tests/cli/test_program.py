"""What everyone expects of a command."""

from __future__ import annotations

import importlib
import pkgutil
import re
import signal
import subprocess
import sys
from pathlib import Path

import click
import pytest
import toys
from processes import Evoframe, ended, python, started, told

import evoframe as package
from evoframe import cli
from evoframe.cli.program import COMMANDS


def test_says_its_version(evoframe: Evoframe) -> None:
    assert evoframe("--version").stdout == f"evoframe {package.__version__}\n"


def test_help_says_of_each_command_what_its_own_help_says() -> None:
    for name, text in COMMANDS.items():
        command = getattr(importlib.import_module(f"evoframe.cli.{name}"), name)
        assert command.get_short_help_str(limit=200) == text


def test_help_lists_every_module_with_a_command_of_its_name() -> None:
    modules = [module.name for module in pkgutil.iter_modules(cli.__path__)]
    of_commands = [
        name
        for name in modules
        if isinstance(getattr(importlib.import_module(f"evoframe.cli.{name}"), name, None), click.Command)
    ]
    assert of_commands == sorted(COMMANDS)


@pytest.mark.parametrize("option", ["--version", "--help"])
def test_what_loads_no_command_loads_neither_numpy_nor_a_plugin(option: str) -> None:
    program = (
        "import atexit, sys\n"
        "from evoframe.cli import main\n"
        "atexit.register(lambda: print(*sys.modules, file=sys.stderr))\n"
        f"sys.argv = ['evoframe', {option!r}]\n"
        "main()\n"
    )
    loaded = python("-c", program).stderr.split()
    assert "evoframe.cli.program" in loaded
    assert [name for name in loaded if name.split(".")[0] == "numpy" or name.startswith("evoframe_")] == []


@pytest.mark.parametrize(
    "command",
    [
        [],
        ["run"],
        ["simulate"],
        ["verify"],
        ["export"],
        ["plugins"],
        ["plugins", "list"],
        ["config"],
        ["robustness"],
        ["config", "show"],
        ["completion"],
    ],
)
def test_every_command_has_help(evoframe: Evoframe, command: list[str]) -> None:
    helped = evoframe(*command, "--help")
    assert helped.returncode == 0
    assert "Usage: evoframe" in helped.stdout


@pytest.mark.parametrize(
    "command",
    [
        ["run"],
        ["simulate"],
        ["verify"],
        ["export"],
        ["plugins", "list"],
        ["config", "show"],
        ["completion"],
    ],
)
def test_help_has_examples(evoframe: Evoframe, command: list[str]) -> None:
    assert re.search(r"Examples?:\n\s+\S*.*evoframe", evoframe(*command, "-h").stdout)


def test_unknown_commands_are_refused(evoframe: Evoframe) -> None:
    refused = evoframe("rnu")
    assert refused.returncode == 2
    assert "No such command 'rnu'" in refused.stderr


PLUGIN = """
import attrs, click
from evoframe import hookimpl

@attrs.frozen
class Worst:
    domain = (-1e100, 1e100)
    def check(self, n): pass
    def aggregate(self, scores): return float(min(scores))

@hookimpl
def evoframe_aggregators():
    return {"lowest": Worst}

@hookimpl
def evoframe_commands(cli):
    @cli.command()
    def greet():
        click.echo("hello")
"""


def test_a_local_module_is_a_plugin_with_components_and_commands(evoframe: Evoframe, tmp_path: Path) -> None:
    (tmp_path / "mine.py").write_text(PLUGIN)
    assert evoframe("-p", "mine", "greet").stdout == "hello\n"
    assert "greet" in evoframe("-p", "mine", "--help").stdout
    ran = evoframe(
        "-p", "mine.py", "run", "quick", "--set", "aggregator=lowest", "--set", "run.generations=1"
    )
    assert ran.returncode == 0, ran.stderr
    assert evoframe("config", "show", "-p", "mine", "--set", "aggregator=lowest").returncode == 0
    missing = evoframe("run", "quick", "--plugin", "theirs")
    assert missing.returncode == 2
    assert re.search("theirs: .* ModuleNotFoundError", missing.stderr)


def test_an_interrupt_of_any_command_is_no_failure(tmp_path: Path) -> None:
    (tmp_path / "toy.toml").write_text(toys.CONFIGURATION)
    (tmp_path / "body.toy").write_text("designs = [{a = 1.0, b = 1.0}]")
    slow = "simulator={name='toy-unverifiable', delay=3600.0}"
    command = ["verify", "-v", "-p", toys.__file__, "body.toy", "--preset", "toy.toml", "--set", slow]
    with started(tmp_path, *command) as process:
        told(process, "variants")
        process.send_signal(signal.SIGINT)
        told(process, "Interrupted")
        assert ended(process) == 130


FAULTS = [
    (
        ["--set", "aggregator=wn"],
        ["--set aggregator=wn: aggregator: ", "'wn'", "'wm'"],
    ),
    (["--set", "collaboration.n=4"], ["--set collaboration.n=4: aggregator: ", "4 collaborators"]),
    (["--set", "collaboration.n=30"], ["--set collaboration.n=30: collaboration: ", "30", "25"]),
    (["--set", "simulator.step=1"], ["--set simulator.step=1: simulator.step: "]),
    (["--set", "run.generations=many"], ["--set run.generations=many: run.generations: ", '"many"']),
    (["nowhere.toml"], ["nowhere.toml: ", "preset or file"]),
    (["papre"], ["papre: ", "'paper'"]),
    (
        ["--set", "aggregator=wn", "--set", "collaboration.n=30"],
        ["--set aggregator=wn: aggregator: ", "--set collaboration.n=30: collaboration: "],
    ),
    (["bad.toml"], ["bad.toml: aggregator.weights[1]: ", "bad.toml: simulatr: "]),
    (["syntax.toml"], ["syntax.toml: ", "TOML"]),
    (["--seed", "-1"], ["-1"]),
]


@pytest.mark.parametrize(
    ("arguments", "messages"), FAULTS, ids=lambda value: " ".join(value) if value else ""
)
def test_a_users_mistake_is_one_clear_message_and_leaves_nothing(
    evoframe: Evoframe, tmp_path: Path, arguments: list[str], messages: list[str]
) -> None:
    (tmp_path / "bad.toml").write_text('[simulatr]\nx = 1\n[aggregator]\nname = "wm"\nweights = [0.5, "a"]\n')
    (tmp_path / "syntax.toml").write_text("[run\n")
    failed = evoframe("run", *arguments)
    assert failed.returncode == 2
    assert "Traceback" not in failed.stderr
    for message in messages:
        assert message in failed.stderr
    assert sorted(path.name for path in tmp_path.iterdir()) == ["bad.toml", "syntax.toml"]


def test_python_m_and_the_script_are_the_same() -> None:
    commands = [str(Path(sys.executable).with_name("evoframe"))], [sys.executable, "-m", "evoframe"]
    helps = [
        subprocess.run([*command, "run", "--help"], capture_output=True, text=True, check=True).stdout
        for command in commands
    ]
    assert helps[0] == helps[1]
    assert "evoframe run" in helps[0]
