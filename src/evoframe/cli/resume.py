"""``evoframe resume``."""

from __future__ import annotations

from pathlib import Path

import click

from evoframe.cli.context import common_options, plugins_of, set_option, workers_option
from evoframe.cli.playing import play, show_end
from evoframe.config import Layer
from evoframe.record import open_run
from evoframe.runs import configuration_of, is_finished, reopen

__all__ = ["resume"]

_EPILOG = """\b
Examples:
  evoframe resume runs/paper-1
  evoframe resume runs/paper-1 --workers 4
  evoframe resume runs/paper-1 --set "executor={name='processes', batch_time_limit=60.0}"
"""


@click.command(epilog=_EPILOG)
@click.argument("directory", metavar="RUN", type=click.Path(path_type=Path))
@click.option(
    "--allow-different-versions",
    is_flag=True,
    help="Go on although versions or the machine have changed since the run began; the run notes it.",
)
@set_option
@workers_option
@common_options
@click.pass_context
def resume(
    ctx: click.Context,
    directory: Path,
    allow_different_versions: bool,
    overrides: tuple[str, ...],
    workers: list[Layer],
) -> None:
    """Go on with a run that was interrupted, from its last complete turn.

    RUN is the run's directory. The result is the same, bit for bit, as if the run had never been
    interrupted, whatever the number of workers. What is not as when the run began (its configuration,
    versions, the type of machine) is named, and the run does not go on; only settings of the executor may
    be others.
    """
    plugins = plugins_of(ctx)
    settings: list[str | Layer] = [*overrides, *workers]
    with open_run(directory) as run:
        if not is_finished(run):
            execution = reopen(run, settings, plugins, allow_different_versions=allow_different_versions)
        else:
            unverified = run.verification() is None
            if settings or unverified:  # also to refuse what would have been another run
                config = configuration_of(run, settings, plugins)
            click.echo(f"{directory}: is finished", err=True)
            if unverified:
                run.read_all()
                show_end(ctx, config, run)
            return
    play(ctx, execution)
