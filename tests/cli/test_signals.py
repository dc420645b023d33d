"""What signals mean while something long goes on."""

from __future__ import annotations

import os
import signal
from pathlib import Path

import pytest
from processes import started, told

from evoframe import load_run
from evoframe.cli.signals import exit_code, stop_on_signals

ENDLESS = ("--set", "simulator.time_step_fraction=2e-5", "--set", "simulator.step_limit=1000000000")
"""Simulations in C that take minutes each."""
PLUGIN = """
import sys
from evoframe import hookimpl

@hookimpl
def evoframe_aggregators():
    return {}

print("loaded", file=sys.stderr)
"""


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_the_first_signal_asks_to_stop_and_the_second_stops(
    number: signal.Signals, capsys: pytest.CaptureFixture[str]
) -> None:
    with stop_on_signals("this turn") as stop:
        assert not stop.is_asked()
        os.kill(os.getpid(), number)
        assert stop.is_asked()
        assert stop.exit_code == exit_code(number) == 128 + number
        assert "Stopping after this turn; " in capsys.readouterr().err
        with pytest.raises(KeyboardInterrupt):
            os.kill(os.getpid(), number)


def test_signals_mean_afterwards_what_they_meant_before() -> None:
    before = [signal.getsignal(number) for number in (signal.SIGINT, signal.SIGTERM)]
    with stop_on_signals("this turn"):
        assert [signal.getsignal(number) for number in (signal.SIGINT, signal.SIGTERM)] != before
    assert [signal.getsignal(number) for number in (signal.SIGINT, signal.SIGTERM)] == before


@pytest.mark.parametrize("executor", ["serial", "threads", "processes"])
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_the_second_signal_ends_a_long_simulation(
    tmp_path: Path, executor: str, number: signal.Signals
) -> None:
    with started(
        tmp_path, "run", "quick", "--set", f"executor={executor}", *ENDLESS, "--out", "r"
    ) as process:
        told(process, "saved in r")
        process.send_signal(number)
        told(process, "Stopping after this turn; ")  # at once, although the simulation goes on
        process.send_signal(number)
        assert "evoframe resume r" in told(process, "Interrupted; no turn was finished in r")
        assert process.wait(60) == exit_code(number)


def test_what_was_saved_stays_saved(tmp_path: Path) -> None:
    """Turn 0 takes a moment, and the next one does not end."""
    slow = ("--set", "executor=serial", "--set", "run.generations=100000", "--out", "r")
    with started(tmp_path, "run", "quick", "-v", *slow) as process:
        told(process, "turn 3")
        process.send_signal(signal.SIGSTOP)
        process.send_signal(signal.SIGINT)
        process.send_signal(signal.SIGTERM)
        process.send_signal(signal.SIGCONT)
        process.wait(60)
    assert len(load_run(tmp_path / "r").workload()) >= 3


@pytest.mark.parametrize("command", ["simulate", "verify"])
def test_the_first_signal_ends_a_command_that_saves_nothing(tmp_path: Path, command: str) -> None:
    with started(tmp_path, "run", "quick", "--out", "r", "-q") as process:
        process.wait(60)
    (tmp_path / "ready.py").write_text(PLUGIN)
    arguments = [command, "r", "-p", "ready.py", "--set", "executor=serial", *ENDLESS]
    with started(tmp_path, *arguments) as process:
        told(process, "loaded")
        process.send_signal(signal.SIGINT)
        told(process, "Interrupted")
        assert process.wait(60) == exit_code(signal.SIGINT)
