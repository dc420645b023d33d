"""The program ``evoframe``: its global options, its commands, and those that plugins add."""

from __future__ import annotations

import signal
import sys
import warnings
from typing import Any

import click

from evoframe._version import __version__
from evoframe.cli.completion import completion
from evoframe.cli.config import config
from evoframe.cli.context import common_options, plugins_of
from evoframe.cli.doctor import doctor
from evoframe.cli.export import export
from evoframe.cli.plugins import plugins
from evoframe.cli.report import report
from evoframe.cli.resume import resume
from evoframe.cli.robustness import robustness
from evoframe.cli.run import run
from evoframe.cli.signals import exit_code
from evoframe.cli.simulate import simulate
from evoframe.cli.study import study
from evoframe.cli.verify import verify
from evoframe.errors import EvoframeError, PluginWarning, RunError
from evoframe.registry.observers import Observers

__all__ = ["cli", "main"]


class _Failure(click.ClickException):
    """An error of ours, shown as one message."""

    exit_code = 2


class _RunFailure(_Failure):
    """A run that cannot go on, although its input was good."""

    exit_code = 1


def _failure(error: EvoframeError) -> _Failure:
    return (_RunFailure if isinstance(error, RunError) else _Failure)(str(error))


class _Program(click.Group):
    """A group that knows the commands of plugins too; built-in ones cannot be replaced."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        return sorted({*super().list_commands(ctx), *self._of_plugins(ctx).commands})

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        built_in = super().get_command(ctx, cmd_name)
        return built_in or self._of_plugins(ctx).commands.get(cmd_name)

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
        try:
            Observers(plugins_of(ctx).manager).tell("evoframe_commands", cli=group)
        except EvoframeError as error:
            raise _failure(error) from error
        return group


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


for command in (
    completion,
    config,
    doctor,
    export,
    plugins,
    report,
    resume,
    robustness,
    run,
    simulate,
    study,
    verify,
):
    cli.add_command(command)


def main() -> None:
    """Run the program with the arguments of the process."""
    warnings.showwarning = _show_warning
    warnings.simplefilter("always", PluginWarning)
    cli(prog_name="evoframe")


def _show_warning(message: Warning | str, category: type[Warning], *_: Any, **__: Any) -> None:
    text = str(message) if issubclass(category, PluginWarning) else f"{category.__name__}: {message}"
    sys.stderr.write(f"Warning: {text}\n")
