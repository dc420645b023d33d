"""The program ``evoframe``: its global options, its commands, and those that plugins add."""

from __future__ import annotations

import importlib
import importlib.metadata
import signal
import sys
import warnings
from collections.abc import Mapping
from typing import Any

import click

from evoframe._version import __version__
from evoframe.cli.context import common_options, modules_of, plugins_of
from evoframe.cli.signals import exit_code
from evoframe.errors import EvoframeError, PluginWarning, RunError
from evoframe.messages import full_text

__all__ = ["cli", "main"]


class _Failure(click.ClickException):
    """An error of ours, shown as one message."""

    exit_code = 2


class _RunFailure(_Failure):
    """A run that cannot go on, although its input was good."""

    exit_code = 1


def _failure(error: EvoframeError) -> _Failure:
    return (_RunFailure if isinstance(error, RunError) else _Failure)(full_text(error))


COMMANDS: Mapping[str, str] = {
    "completion": "Print the script that completes commands, options and presets in a SHELL.",
    "config": "Look at configurations.",
    "doctor": "Look whether everything is in order: the installation, or the directories of runs.",
    "export": "Write a design with its settings as a file of another program.",
    "plugins": "Look at plugins.",
    "report": "Write figures, tables, conclusions and a page of runs and studies, finished or not.",
    "resume": "Go on with a run that was interrupted, from its last complete turn.",
    "robustness": "Simulate bodies with the same random controllers, and compare what they score.",
    "run": "Run a coevolution: a TOML file, or a preset (without argument: paper).",
    "simulate": "Simulate given bodies and print the score of each.",
    "study": "Run a grid of configurations, each several times; go on where that was left.",
    "verify": (
        "Simulate designs again with one thing changed at a time, and print what is left of their scores."
    ),
}
"""Name of a built-in command, which is that of its module -> what it does, so that help loads no command."""


class _Program(click.Group):
    """A group that loads a command when it is called; plugins add some, and replace none."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        return sorted({*COMMANDS, *self._of_plugins(ctx).commands})

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        if cmd_name in COMMANDS:
            command: click.Command = getattr(importlib.import_module(f"evoframe.cli.{cmd_name}"), cmd_name)
            return command
        return self._of_plugins(ctx).commands.get(cmd_name)

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        added = {
            name: added.get_short_help_str(120) for name, added in self._of_plugins(ctx).commands.items()
        }
        with formatter.section("Commands"):
            formatter.write_dl(sorted({**added, **COMMANDS}.items()))

    def invoke(self, ctx: click.Context) -> Any:
        try:
            return super().invoke(ctx)
        except EvoframeError as error:
            raise _failure(error) from error
        except KeyboardInterrupt as interrupt:
            click.echo("Interrupted", err=True)
            raise click.exceptions.Exit(exit_code(signal.SIGINT)) from interrupt

    def _of_plugins(self, ctx: click.Context) -> click.Group:
        group = click.Group("evoframe")
        if not modules_of(ctx) and not _plugins_of_others():
            return group  # the built-in plugins add no commands, and take a second to load
        from evoframe.registry import Observers  # noqa: PLC0415 - as they do

        try:
            Observers(plugins_of(ctx).manager).tell("evoframe_commands", cli=group)
        except EvoframeError as error:
            raise _failure(error) from error
        return group


def _plugins_of_others() -> bool:
    """Return whether a distribution other than evoframe's own offers plugins."""
    points = importlib.metadata.entry_points(group="evoframe")
    return any(point.dist is None or point.dist.name != "evoframe" for point in points)


_EPILOG = """\b
Examples:
  evoframe run                                the published experiment
  evoframe run quick                          a few seconds of it
  evoframe run --set aggregator=hm --seed 7
  evoframe resume runs/paper-1                go on with it after an interruption
  evoframe study paper --dry-run              the published study: 600 runs
  evoframe simulate runs/paper-1/champion.json
  evoframe verify runs/paper-1                is its champion real?
  evoframe robustness runs/paper-1 --published
  evoframe export runs/paper-1 --to vxa
  evoframe plugins list
  evoframe doctor                             is everything in order?
"""


@click.group(
    cls=_Program,
    epilog=_EPILOG,
    context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 100},
)
@click.version_option(__version__, prog_name="evoframe", message="%(prog)s %(version)s")
@common_options
def cli() -> None:
    """Cooperative coevolution of soft robots.

    Two populations of networks, one of bodies and one of controllers, are evolved together: each individual
    is judged by how well it does with partners from the other population.
    """


def main() -> None:
    """Run the program with the arguments of the process."""
    warnings.showwarning = _show_warning
    warnings.simplefilter("always", PluginWarning)
    cli(prog_name="evoframe")


def _show_warning(message: Warning | str, category: type[Warning], *_: Any, **__: Any) -> None:
    text = str(message) if issubclass(category, PluginWarning) else f"{category.__name__}: {message}"
    sys.stderr.write(f"Warning: {text}\n")
