"""``evoframe run``."""

from __future__ import annotations

import contextlib
import signal
from collections.abc import Iterator
from pathlib import Path
from types import FrameType

import click
from rich.console import Console
from rich.table import Table

from evoframe.cli.context import (
    common_options,
    configuration_argument,
    is_quiet,
    plugins_of,
    set_option,
    workers_option,
)
from evoframe.cli.progress import Progress
from evoframe.config import RunConfig
from evoframe.layers import Layer, layer_of
from evoframe.loading import Run, load_run
from evoframe.observers import Observers
from evoframe.resolve import load_config
from evoframe.run import default_directory, execute

__all__ = ["run"]

_INTERRUPTED = 130
_EPILOG = """\b
Examples:
  evoframe run                                    the preset 'paper'
  evoframe run quick --seed 3 --out runs/try
  evoframe run --set aggregator=hm --set collaboration.n=5
  evoframe run my.toml --set 'aggregator={name="wm", weights=[0.7, 0.3]}'
"""


@click.command(epilog=_EPILOG)
@configuration_argument
@set_option
@click.option("--seed", type=click.IntRange(min=0), metavar="N", help="Override run.seed.")
@click.option(
    "--out",
    type=click.Path(path_type=Path),
    metavar="DIR",
    help="The run's directory; by default runs/<preset>-<seed>.",
)
@workers_option
@common_options
@click.pass_context
def run(
    ctx: click.Context,
    source: str,
    overrides: tuple[str, ...],
    seed: int | None,
    out: Path | None,
    workers: list[Layer],
) -> None:
    """Run a coevolution: a TOML file, or a preset (without argument: paper).

    Ctrl-C stops after the turn in progress; everything up to then is saved.
    """
    extra = [] if seed is None else [layer_of(f"--seed {seed}", "run.seed", seed)]
    config = load_config(source, overrides=[*overrides, *extra, *workers], plugins=plugins_of(ctx))
    directory = out or default_directory(config)
    if not is_quiet(ctx):
        config.discovered.manager.register(Progress(), name="evoframe:progress")
    with _stop_on_interrupt() as stop:
        completed = _completed(config, directory, stop)
    if not completed:
        click.echo(f"Interrupted; all turns up to here are saved in {directory}", err=True)
        ctx.exit(_INTERRUPTED)
    if is_quiet(ctx):
        click.echo(directory)
    else:
        Console().print(_summary(load_run(directory)))


def _completed(config: RunConfig, directory: Path, stop: _Stop) -> bool:
    """Run, and return whether it went to the end; a second interrupt gives the turn in progress up."""
    try:
        return execute(config, directory, Observers(config.discovered.manager), stop.is_asked)
    except KeyboardInterrupt:
        return False


class _Stop:
    """Remembers that the user asked to stop; a second request stops at once."""

    def __init__(self) -> None:
        self.asked = False

    def is_asked(self) -> bool:
        return self.asked

    def handle(self, number: int, frame: FrameType | None) -> None:
        if self.asked:
            signal.default_int_handler(number, frame)
        self.asked = True
        click.echo("\nStopping after this turn; press Ctrl-C again to stop at once.", err=True)


@contextlib.contextmanager
def _stop_on_interrupt() -> Iterator[_Stop]:
    stop = _Stop()
    previous = signal.signal(signal.SIGINT, stop.handle)
    try:
        yield stop
    finally:
        signal.signal(signal.SIGINT, previous)


def _summary(finished: Run) -> Table:
    table = Table(box=None, show_header=False, highlight=False)
    table.add_column(style="bold")
    table.add_column(overflow="fold")
    result, work = finished.summary, finished.workload
    pairs, simulations = (sum(row[key] for row in work) for key in ("pairs", "simulations"))
    diverged = sum(row["score"] is None for row in finished.pairs)
    best = finished.table("best_pairs")[-1]
    table.add_row("best pair simulated", f"{best['score']!r} m, in turn {best['turn']}")
    for population, fittest in result["fittest"].items():
        table.add_row(f"fittest {population}", f"{fittest['fitness']!r} m, genome {fittest['genome_id']}")
    table.add_row("displacement of the fittest pair", f"{result['fittest_pair_score']!r} m")
    table.add_row("pairs", f"{pairs:,}, of which {simulations:,} simulated and {diverged:,} diverged")
    table.add_row("time", f"{sum(row['seconds'] for row in work):.1f} s")
    table.add_row("directory", str(finished.directory))
    return table
