"""``evoframe doctor``."""

from __future__ import annotations

import json
from pathlib import Path

import attrs
import click
from rich.table import Table
from rich.text import Text

from evoframe.cli.context import common_options, output, plugins_of
from evoframe.cli.sources import with_runs_of_studies
from evoframe.cli.streams import echo
from evoframe.errors import InputError
from evoframe.messages import full_text
from evoframe.registry import Plugins
from evoframe.runs import Check, State, check_installation, check_run

__all__ = ["doctor"]

_EPILOG = """\b
Examples:
  evoframe doctor                             check the installation
  evoframe doctor runs/paper-1                check one run
  evoframe doctor runs/* --json
"""

_STYLES: dict[State, str] = {"ok": "green", "note": "yellow", "problem": "bold red"}


@click.command(epilog=_EPILOG)
@click.argument("directories", metavar="[RUN|STUDY]...", nargs=-1, type=click.Path(path_type=Path))
@click.option("--json", "as_json", is_flag=True, help="Print JSON.")
@common_options
@click.pass_context
def doctor(ctx: click.Context, directories: tuple[Path, ...], as_json: bool) -> None:
    """Check the installation, or the directories of runs and studies.

    Without an argument, checks plugins, versions, the solver's kernel and a few simulations. For a run,
    checks its database, the completeness of its turns, that it can be resumed, and that simulating its
    champion again gives the recorded score to the last digit. Nothing is changed. Exit code 1: a problem was
    found; 2: a directory is not that of a run, or another process is writing to it.
    """
    found = plugins_of(ctx)
    refused: list[InputError] = []
    checks = {
        str(directory): _checks(directory, found, refused)
        for directory in with_runs_of_studies(ctx, directories)
    }
    if not directories:
        checks["installation"] = list(check_installation(found))
    if as_json:
        documents = {name: [attrs.asdict(check) for check in listed] for name, listed in checks.items()}
        echo(json.dumps(documents, indent=2))
    else:
        for name, listed in checks.items():
            _print(name, listed)
    if refused:
        ctx.exit(2)
    if any(check.state == "problem" for listed in checks.values() for check in listed):
        ctx.exit(1)


def _checks(directory: Path, plugins: Plugins, refused: list[InputError]) -> list[Check]:
    """Return the checks of a run; an unreadable directory is a problem of that run only."""
    try:
        return list(check_run(directory, plugins))
    except InputError as error:
        refused.append(error)
        return [Check("directory", "problem", full_text(error))]


def _print(name: str, checks: list[Check]) -> None:
    console = output()
    console.print(name, style="bold", soft_wrap=True)
    table = Table(box=None, show_header=False)
    table.add_column(no_wrap=True)
    table.add_column(no_wrap=True)
    table.add_column(overflow="fold")
    for check in checks:
        table.add_row(Text(check.state, _STYLES[check.state]), check.subject, check.finding)
    console.print(table)
