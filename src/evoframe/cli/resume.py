"""``evoframe resume``."""

from __future__ import annotations

from pathlib import Path

import click

from evoframe.cli.context import common_options, plugins_of, workers_option
from evoframe.cli.playing import play, show_end
from evoframe.layers import Layer
from evoframe.loading import load_run
from evoframe.resolve import load_config
from evoframe.resuming import is_finished, reopen
from evoframe.store import CONFIG_FILE

__all__ = ["resume"]

_EPILOG = """\b
Examples:
  evoframe resume runs/paper-1
  evoframe resume runs/paper-1 --workers 4
"""


@click.command(epilog=_EPILOG)
@click.argument("directory", metavar="RUN", type=click.Path(path_type=Path))
@click.option(
    "--allow-different-versions",
    is_flag=True,
    help="Go on although versions or the machine have changed since the run began; the run notes it.",
)
@workers_option
@common_options
@click.pass_context
def resume(ctx: click.Context, directory: Path, allow_different_versions: bool, workers: list[Layer]) -> None:
    """Go on with a run that was interrupted, from its last complete turn.

    RUN is the run's directory. The result is the same, bit for bit, as if the run had never been
    interrupted, whatever the number of workers. What is not as when the run began (its configuration,
    versions, the type of machine) is named, and the run does not go on.
    """
    if is_finished(directory):
        click.echo(f"{directory}: is finished", err=True)
        if load_run(directory).verification is None:
            config = load_config(directory / CONFIG_FILE, overrides=workers, plugins=plugins_of(ctx))
            show_end(ctx, config, directory)
        return
    play(ctx, reopen(directory, workers, plugins_of(ctx), allow_different_versions=allow_different_versions))
