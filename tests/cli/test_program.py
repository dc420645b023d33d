"""What everyone expects of a command."""

from __future__ import annotations

import contextlib
import re
import signal
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest
import toys
from processes import Evoframe, on_a_terminal, started, told

import evoframe as package


def slow_run(directory: Path, *settings: str) -> contextlib.AbstractContextManager[subprocess.Popen[str]]:
    """Start a run of toys that takes its time."""
    (directory / "toy.toml").write_text(toys.CONFIGURATION)
    options = [option for setting in settings for option in ("--set", setting)]
    return started(directory, "run", "-v", "-p", toys.__file__, "toy.toml", "--out", "here", *options)


def test_says_its_version(evoframe: Evoframe) -> None:
    assert evoframe("--version").stdout == f"evoframe {package.__version__}\n"


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


@pytest.mark.parametrize("shell", ["bash", "zsh", "fish"])
def test_shells_complete(evoframe: Evoframe, shell: str) -> None:
    assert "_EVOFRAME_COMPLETE" in evoframe("completion", shell).stdout


def test_presets_are_completed(evoframe: Evoframe) -> None:
    completed = evoframe(COMP_WORDS="evoframe run pa", COMP_CWORD="2", _EVOFRAME_COMPLETE="bash_complete")
    assert "plain,paper" in completed.stdout


def test_config_show_prints_what_can_be_run(evoframe: Evoframe, tmp_path: Path) -> None:
    shown = evoframe("config", "show", "quick", "--set", "aggregator=hm")
    assert shown.returncode == 0
    tables = tomllib.loads(shown.stdout)
    assert tables["aggregator"] == {"name": "hm", "floor": 1e-5, "clip": False}
    (tmp_path / "shown.toml").write_text(shown.stdout)
    assert evoframe("config", "show", "shown.toml").stdout == shown.stdout


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
    assert "plugin module 'theirs' cannot be used: ModuleNotFoundError" in missing.stderr


class TestRun:
    def test_ends_with_a_summary_and_the_directory(self, evoframe: Evoframe, tmp_path: Path) -> None:
        ran = evoframe("run", "quick", "--seed", 4)
        assert ran.returncode == 0
        champion = package.load_run(tmp_path / "runs" / "quick-4").champion()
        assert repr(champion.score) in ran.stdout
        assert "runs/quick-4" in ran.stdout
        assert re.search(r"turn 10/10 .* morphology \S+ .* controller \S+ .* sim/s .*% cached", ran.stderr)

    @pytest.mark.parametrize("before", [True, False])
    def test_quiet_says_only_where_the_run_is(self, evoframe: Evoframe, before: bool) -> None:
        command = ["run", "quick", "--set", "run.generations=0"]
        ran = evoframe("-q", *command) if before else evoframe(*command, "--quiet")
        assert (ran.stdout, ran.stderr) == ("runs/quick-1\n", "")

    def test_no_colour_where_there_is_no_terminal_or_none_is_wanted(self, evoframe: Evoframe) -> None:
        ran = evoframe("run", "quick", "--set", "run.generations=0", NO_COLOR="1", FORCE_COLOR="1")
        assert not re.search(r"\x1b\[[0-9;]*3[0-7]m", ran.stdout + ran.stderr)

    def test_a_directory_that_is_in_use_is_refused(self, evoframe: Evoframe, tmp_path: Path) -> None:
        assert evoframe("run", "quick", "--set", "run.generations=0", "--out", "here").returncode == 0
        before = (tmp_path / "here" / "run.db").read_bytes()
        again = evoframe("run", "quick", "--set", "run.generations=0", "--out", "here")
        assert again.returncode == 2
        assert (
            again.stderr.splitlines()[-1]
            == "Error: here: is not empty: it holds a finished run; choose another directory with --out"
        )
        assert (tmp_path / "here" / "run.db").read_bytes() == before

    def test_verbose_tells_of_better_pairs_and_doubly_verbose_of_every_turn(self, evoframe: Evoframe) -> None:
        def told(*flags: str) -> str:
            return evoframe(*flags, "run", "quick", "--set", "run.generations=2").stderr

        assert "a pair with the score" not in told()
        assert "turn 0: a pair with the score" in told("-v")
        assert "turn 4: controller: best" not in told("-v")
        assert "turn 4: controller: best" in told("-vv")

    def test_the_summary_counts_the_pairs_that_diverged(self, evoframe: Evoframe, tmp_path: Path) -> None:
        (tmp_path / "toy.toml").write_text(toys.CONFIGURATION)
        ran = evoframe(
            "-p", toys.__file__, "run", "toy.toml", "--set", "simulator.limit=0.15", "--out", "here"
        )
        assert ran.returncode == 0, ran.stderr
        pairs = package.load_run(tmp_path / "here").pairs()
        diverged = sum(pair["score"] is None for pair in pairs)
        assert diverged > 0
        assert f"simulated and {diverged} diverged" in ran.stdout

    def test_on_a_terminal_there_is_a_bar_that_is_taken_away_at_the_end(self, tmp_path: Path) -> None:
        (tmp_path / "toy.toml").write_text(toys.CONFIGURATION)
        slow = ["--set", "simulator={name='toy-slow', delay=0.15}"]
        shown = on_a_terminal(["run", "-p", toys.__file__, "toy.toml", *slow], tmp_path)
        assert re.search(r"turn \d+/8 .*\d:\d\d:\d\d\S* left", shown)
        assert re.search(r"a \S+  b \S+  \d+ sim/s  \d+% cached", shown)
        hidden, back = shown.count("\x1b[?25l"), shown.count("\x1b[?25h")
        assert hidden == back > 0  # the cursor

    def test_the_fittest_who_have_not_met_do_at_the_end(self, evoframe: Evoframe, tmp_path: Path) -> None:
        (tmp_path / "toy.toml").write_text(toys.CONFIGURATION)
        last = ["--set", "collaboration={name='toy-last'}"]
        ran = evoframe("run", "-p", toys.__file__, "toy.toml", *last, "--out", "here")
        assert ran.returncode == 0, ran.stderr
        assert "8 turns into here" in ran.stderr
        finished = package.load_run(tmp_path / "here")
        assert finished.summary()["turns"] == 8
        assert sum(pair["turn"] == 9 for pair in finished.pairs()) == 1

    def test_ends_with_the_verification_of_its_champion(self, evoframe: Evoframe, tmp_path: Path) -> None:
        (tmp_path / "toy.toml").write_text(toys.CONFIGURATION)
        command = ["run", "-p", toys.__file__, "toy.toml", "--set", "simulator=toy-varied"]
        ran = evoframe(*command, "--out", "here")
        assert ran.returncode == 0, ran.stderr
        summary, table = ran.stdout.split("\n\n")
        assert "best pair simulated" in summary
        assert [line.split()[0] for line in table.splitlines()] == [
            "variant", "unchanged", "gain", "no", "one",
        ]  # fmt: skip
        assert "verifying the champion" in ran.stderr
        quiet = evoframe("-q", *command, "--out", "quiet")
        assert (quiet.stdout, quiet.stderr) == ("quiet\n", "")
        stored = [(tmp_path / name / "verification.json").read_bytes() for name in ("here", "quiet")]
        assert stored[0] == stored[1]

    def test_without_variants_says_nothing_of_a_verification(
        self, evoframe: Evoframe, tmp_path: Path
    ) -> None:
        (tmp_path / "toy.toml").write_text(toys.CONFIGURATION)
        ran = evoframe("run", "-p", toys.__file__, "toy.toml", "--out", "here")
        assert (ran.returncode, "verify" in ran.stderr, "unchanged" in ran.stdout) == (0, False, False)

    def test_a_verification_that_fails_is_an_error_after_the_summary(
        self, evoframe: Evoframe, tmp_path: Path
    ) -> None:
        (tmp_path / "toy.toml").write_text(toys.CONFIGURATION)
        ran = evoframe(
            "run", "-p", toys.__file__, "toy.toml", "--set", "simulator=toy-unverifiable", "--out", "here"
        )
        assert ran.returncode == 1
        assert "best pair simulated" in ran.stdout
        assert ran.stderr.splitlines()[-1] == (
            "Error: here: the run is complete and saved, but its champion cannot be verified: no variant fits"
        )
        assert package.load_run(tmp_path / "here").summary()["turns"] == 8

    def test_an_interrupt_of_the_verification_leaves_the_complete_run(self, tmp_path: Path) -> None:
        with slow_run(tmp_path, "simulator={name='toy-unverifiable', delay=3600.0}") as process:
            told(process, "verifying the champion")
            process.send_signal(signal.SIGINT)
            told(process, "Interrupted; the run is complete and saved in here, but not verified")
            assert process.wait(60) == 130
        assert package.load_run(tmp_path / "here").summary()["turns"] == 8

    def test_names_are_shown_as_they_are_written(self, evoframe: Evoframe) -> None:
        ran = evoframe("run", "quick", "--set", "run.generations=0", "--out", "r[/a] [bold]x :smile:")
        assert ran.returncode == 0, ran.stderr
        assert "directory" in ran.stdout
        assert "r[/a] [bold]x :smile:" in ran.stdout

    def test_interrupt_stops_after_the_turn_and_keeps_it(self, tmp_path: Path) -> None:
        with slow_run(tmp_path, "simulator={name='toy-slow', delay=0.2}", "run.generations=100") as process:
            told(process, "turn 0: a pair with the score")
            process.send_signal(signal.SIGINT)
            told(process, "Interrupted; all turns up to ")
            assert process.wait(60) == 130
        turns = package.load_run(tmp_path / "here").turns()
        assert 2 <= len(turns) < 200

    def test_a_second_interrupt_stops_at_once(self, tmp_path: Path) -> None:
        with slow_run(tmp_path, "simulator={name='toy-slow', delay=3600.0}") as process:
            told(process, "toy, seed 3: 8 turns into here")
            process.send_signal(signal.SIGINT)
            told(process, "press Ctrl-C again to stop at once")
            process.send_signal(signal.SIGINT)
            told(process, "Interrupted; no turn was finished in here")
            assert process.wait(60) == 130
        assert package.load_run(tmp_path / "here").turns() == []


def test_an_interrupt_of_any_command_is_no_failure(tmp_path: Path) -> None:
    (tmp_path / "toy.toml").write_text(toys.CONFIGURATION)
    (tmp_path / "body.toy").write_text("designs = [{a = 1.0, b = 1.0}]")
    slow = "simulator={name='toy-unverifiable', delay=3600.0}"
    command = ["verify", "-v", "-p", toys.__file__, "body.toy", "--preset", "toy.toml", "--set", slow]
    with started(tmp_path, *command) as process:
        told(process, "looking for variants")
        process.send_signal(signal.SIGINT)
        told(process, "Interrupted")
        assert process.wait(60) == 130


FAULTS = [
    (
        ["--set", "aggregator=wn"],
        ["--set aggregator=wn: aggregator: unknown aggregator 'wn'; did you mean 'wm'?"],
    ),
    (["--set", "collaboration.n=4"], ["aggregator", "wm has no weights for 4 collaborators"]),
    (["--set", "collaboration.n=30"], ["--set collaboration.n=30: collaboration: ", "30", "25"]),
    (["--set", "simulator.step=1"], ["--set simulator.step=1: simulator.step: unknown option"]),
    (["--set", "run.generations=many"], ['run.generations: expected a whole number, found "many"']),
    (["nowhere.toml"], ["nowhere.toml: cannot be read: No such file or directory"]),
    (["papre"], ["there is no preset 'papre'; did you mean 'paper'?"]),
    (
        ["--set", "aggregator=wn", "--set", "collaboration.n=30"],
        ["2 faults", "aggregator=wn", "collaboration.n=30"],
    ),
    (["bad.toml"], ["bad.toml: aggregator.weights[1]: expected a number", "bad.toml: simulatr: unknown key"]),
    (["syntax.toml"], ["syntax.toml: not valid TOML"]),
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
