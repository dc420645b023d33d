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
from evoframe.cli.context import common_options, modules_of, plugin_options, plugins_of
from evoframe.cli.signals import ended_by_signal, exit_code
from evoframe.cli.streams import divert_plugin_text, finish_streams, prepare_streams, restore_descriptor
from evoframe.errors import EvoframeError, PluginWarning, RunError
from evoframe.messages import full_text

__all__ = ["cli", "main"]


class _Failure(click.ClickException):
    """An error that evoframe raises on purpose, printed as one message."""

    exit_code = 2


class _RunFailure(_Failure):
    """A run that failed although its input was valid."""

    exit_code = 1


def _failure(ctx: click.Context, error: EvoframeError) -> _Failure:
    text, options = full_text(error), plugin_options(ctx)
    if options and "evoframe resume " in text:  # the core does not know the options of this command
        text += f"\n  with the plugins of this command: {options}"
    return (_RunFailure if isinstance(error, RunError) else _Failure)(text)


COMMANDS: Mapping[str, str] = {
    "completion": "Print the shell script that completes commands, options and presets.",
    "config": "Print configurations, or write a new one.",
    "doctor": "Check the installation, or the directories of runs and studies.",
    "export": "Write a design and its settings in the file format of another program.",
    "plugins": "List plugins and the components that they offer.",
    "report": "Write the report of a run or study: figures, tables, conclusions and an interactive page.",
    "resume": "Resume an interrupted run from its last complete turn, or a study.",
    "robustness": "Compare bodies by their scores under the same random controllers.",
    "run": "Run one coevolution.",
    "simulate": "Simulate designs and print their scores.",
    "study": "Run a grid of configurations, several runs each.",
    "verify": "Test what a score depends on: simulate again with one setting changed at a time.",
}
"""Name of a built-in command and of its module -> first line of its help, so that help loads no command."""


class _Program(click.Group):
    """A group that loads a command when it is called; plugins add commands and cannot replace any."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        return sorted({*COMMANDS, *self._of_plugins(ctx).commands})

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        if cmd_name in COMMANDS:
            command: click.Command = getattr(importlib.import_module(f"evoframe.cli.{cmd_name}"), cmd_name)
            return command
        added = self._of_plugins(ctx).commands.get(cmd_name)
        if added is not None:
            restore_descriptor()
        return added

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        added = {
            name: added.get_short_help_str(120) for name, added in self._of_plugins(ctx).commands.items()
        }
        with formatter.section("Commands"):
            formatter.write_dl(sorted({**added, **COMMANDS}.items()))

    def invoke(self, ctx: click.Context) -> Any:
        try:
            return super().invoke(ctx)
        except click.NoSuchOption as error:
            from evoframe.cli.unknown_options import with_hint  # noqa: PLC0415 - reads a preset

            raise with_hint(error) from error
        except EvoframeError as error:
            raise _failure(ctx, error) from error
        except KeyboardInterrupt as interrupt:
            click.echo("Interrupted", err=True)
            raise click.exceptions.Exit(exit_code(signal.SIGINT)) from interrupt

    def _of_plugins(self, ctx: click.Context) -> click.Group:
        group = click.Group("evoframe")
        if not modules_of(ctx) and not _plugins_of_others():
            return group  # the built-in plugins add no commands and take a second to load
        from evoframe.registry import Observers  # noqa: PLC0415 - as they do

        try:
            with divert_plugin_text():
                Observers(plugins_of(ctx).manager).tell("evoframe_commands", cli=group)
        except EvoframeError as error:
            raise _failure(ctx, error) from error
        return group


def _plugins_of_others() -> bool:
    """Return whether a distribution other than evoframe's own offers plugins."""
    points = importlib.metadata.entry_points(group="evoframe")
    return any(point.dist is None or point.dist.name != "evoframe" for point in points)


_EPILOG = """\b
Examples:
  evoframe run                                the published experiment
  evoframe run quick                          a small version of it, in seconds
  evoframe run --set aggregator=hm --seed 7   with other settings
  evoframe resume runs/paper-1                continue after an interruption
  evoframe report runs/paper-1                figures, and a page that shows the champion moving
  evoframe verify runs/paper-1                what does the champion's score depend on?
  evoframe simulate runs/paper-1              simulate the champion again
  evoframe robustness runs/paper-1 --published
  evoframe export runs/paper-1 --to vxa       for VoxCAD
  evoframe study paper --dry-run              the published study: 600 runs
  evoframe config show --comments             every setting, with its meaning and range
  evoframe plugins list
  evoframe doctor                             check the installation
"""


@click.group(
    cls=_Program,
    epilog=_EPILOG,
    context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 100},
)
@click.version_option(__version__, prog_name="evoframe", message="%(prog)s %(version)s")
@common_options
def cli() -> None:
    """Design soft robots by cooperative coevolution.

    Two populations of networks evolve together: one encodes bodies, the other controllers. The fitness of an
    individual is an average of the scores that it reaches with collaborators from the other population.
    """


def main() -> None:
    """Run the program with the arguments of the process."""
    prepare_streams()
    warnings.showwarning = _show_warning
    warnings.simplefilter("always", PluginWarning)
    try:
        with ended_by_signal():
            cli(prog_name="evoframe")
    except SystemExit as end:
        sys.exit(finish_streams() if end.code in (None, 0) else end.code)


def _show_warning(message: Warning | str, category: type[Warning], *_: Any, **__: Any) -> None:
    text = str(message) if issubclass(category, PluginWarning) else f"{category.__name__}: {message}"
    sys.stderr.write(f"Warning: {text}\n")
