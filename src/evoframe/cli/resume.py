"""``evoframe resume``."""

from __future__ import annotations

from pathlib import Path

import click

from evoframe.cli.context import command, common_options, plugins_of, set_option, workers_option
from evoframe.cli.playing import play, show_end
from evoframe.cli.sources import RUN_OR_STUDY
from evoframe.cli.study import study
from evoframe.config import Layer
from evoframe.record import open_run
from evoframe.runs import configuration_of, is_finished, reopen
from evoframe.study import is_study

__all__ = ["resume"]

_EPILOG = """\b
Examples:
  evoframe resume runs/paper-1
  evoframe resume runs/paper-1 --workers 4
  evoframe resume runs/paper-1 --set "executor={name='processes', batch_time_limit=60.0}"
"""


@click.command(epilog=_EPILOG)
@click.argument("directory", metavar="RUN|STUDY", type=RUN_OR_STUDY)
@click.option(
    "--allow-different-versions",
    is_flag=True,
    help="Resume although versions or the type of machine have changed; the run records this.",
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
    """Resume an interrupted run from its last complete turn, or a study.

    RUN is the directory of a run. The result is bit for bit that of an uninterrupted run, with any number
    of workers. Only settings of the executor may change: with another configuration, other versions or
    another type of machine, evoframe reports the differences and does not resume. STUDY is the directory of
    a study, which continues as with evoframe study.
    """
    if is_study(directory):
        at_once = next((layer.tree["executor"]["workers"] for layer in workers), 0)
        ctx.invoke(study, source=str(directory), overrides=overrides, workers=at_once)
        return
    plugins = plugins_of(ctx)
    settings: list[str | Layer] = [*overrides, *workers]
    with open_run(directory) as run:
        if not is_finished(run):
            execution = reopen(run, settings, plugins, allow_different_versions=allow_different_versions)
        else:
            unverified = run.verification() is None
            if settings or unverified:  # refuses settings that differ from those of the run
                config = configuration_of(run, settings, plugins)
            todo = "" if unverified else f"; for figures and a page: {command(ctx, 'report', directory)}"
            click.echo(f"{directory}: the run is finished{todo}", err=True)
            if unverified:
                run.read_all()
                show_end(ctx, config, run)
            return
    play(ctx, execution)
