"""Start-up time of the command line."""

from __future__ import annotations

import functools
import resource
import subprocess
import sys

from benchmarks.report import Row, Section, Table
from benchmarks.timing import Action, Effort, interleaved

__all__ = ["startup"]

_PYTHON = "import click, rich.console"  # the libraries of the command line
_COMMANDS = {
    f'python -c "{_PYTHON}"': ["-c", _PYTHON],
    "evoframe --version": ["-m", "evoframe", "--version"],
    "evoframe --help": ["-m", "evoframe", "--help"],
}


def startup(effort: Effort) -> Section:
    """Time the calls that load no command, and a program that only imports their libraries."""
    actions: dict[str, Action] = {
        name: functools.partial(_run, arguments) for name, arguments in _COMMANDS.items()
    }
    taken = interleaved(actions, effort, _cpu_of_children)
    least = next(iter(taken.values()))
    rows: list[Row] = [(name, seconds * 1e3, seconds / least) for name, seconds in taken.items()]
    table = Table(
        "Commands that need no plugin",
        ("", "CPU, ms", "ratio"),
        rows,
        "CPU time of the process; the median of interleaved rounds. Goal: ratios of at most 3.",
    )
    return Section("start of the command line", (table,))


def _run(arguments: list[str]) -> None:
    subprocess.run([sys.executable, *arguments], check=True, stdout=subprocess.DEVNULL)


def _cpu_of_children() -> float:
    """Return the CPU time of all processes that have ended, s."""
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime
