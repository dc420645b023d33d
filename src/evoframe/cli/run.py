"""``evoframe run``."""

from __future__ import annotations

import contextlib
import signal
from collections.abc import Iterator
from pathlib import Path
from types import FrameType

import click
from rich.table import Table

from evoframe.cli.context import (
    common_options,
    configuration_argument,
    is_quiet,
    output,
    plugins_of,
    scored,
    set_option,
    unit_of,
    workers_option,
)
from evoframe.cli.progress import Progress
from evoframe.cli.verify import verification_table
from evoframe.layers import Layer, layer_of
from evoframe.loading import Run, load_run
from evoframe.observers import Observers
from evoframe.resolve import load_config
from evoframe.run import Execution, prepare
from evoframe.verification import can_verify

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

    Ctrl-C stops after the turn in progress; everything up to then is saved. At the end the champion is
    verified, as evoframe verify does.
    """
    extra = [] if seed is None else [layer_of(f"--seed {seed}", "run.seed", seed)]
    config = load_config(source, overrides=[*overrides, *extra, *workers], plugins=plugins_of(ctx))
    if not is_quiet(ctx):
        config.discovered.manager.register(Progress(), name="evoframe:progress")
    execution = prepare(config, out)
    if not _play(execution):
        click.echo(_interrupted(load_run(execution.directory)), err=True)
        ctx.exit(_INTERRUPTED)
    quiet = is_quiet(ctx)
    if quiet:
        click.echo(execution.directory)
    else:
        output().print(_summary(load_run(execution.directory), unit_of(config)))
    try:
        _verify(execution, quiet)
    except KeyboardInterrupt:
        directory = execution.directory
        click.echo(
            f"Interrupted; the run is complete and saved in {directory}, but not verified; "
            f"evoframe verify {directory} does that",
            err=True,
        )
        ctx.exit(_INTERRUPTED)


def _play(execution: Execution) -> bool:
    """Run, and return whether to the end; a second interrupt gives the turn in progress up."""
    with _stop_on_interrupt() as stop:
        try:
            return execution.play(Observers(execution.config.discovered.manager), stop.is_asked)
        except KeyboardInterrupt:
            return False


def _verify(execution: Execution, quiet: bool) -> None:
    """Verify the champion, if that can be done, and show what came of it."""
    if not quiet and can_verify(execution.config.simulator.component):
        click.echo("verifying the champion", err=True)
    verification = execution.verify()
    if verification is not None and not quiet:
        console = output()
        console.print()
        console.print(verification_table(verification))


def _interrupted(stopped: Run) -> str:
    turns = [row["turn"] for row in stopped.workload]
    saved = f"all turns up to {turns[-1]} are saved" if turns else "no turn was finished"
    return f"Interrupted; {saved} in {stopped.directory}"


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


def _summary(finished: Run, unit: str) -> Table:
    table = Table(box=None, show_header=False)
    table.add_column(style="bold", no_wrap=True)
    table.add_column(overflow="fold")
    result, work = finished.summary, finished.workload
    pairs, simulations = (sum(row[key] for row in work) for key in ("pairs", "simulations"))
    diverged = sum(row["score"] is None for row in finished.pairs)
    best = finished.table("best_pairs")[-1]
    table.add_row("best pair simulated", f"{scored(best['score'], unit)}, in turn {best['turn']}")
    for population, fittest in result["fittest"].items():
        table.add_row(
            f"fittest {population}", f"{scored(fittest['fitness'], unit)}, genome {fittest['genome_id']}"
        )
    table.add_row("fittest pair", scored(result["fittest_pair_score"], unit))
    table.add_row("pairs", f"{pairs:,}, of which {simulations:,} simulated and {diverged:,} diverged")
    table.add_row("time", f"{sum(row['seconds'] for row in work):.1f} s")
    table.add_row("directory", str(finished.directory))
    return table
