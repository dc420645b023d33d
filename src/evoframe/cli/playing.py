"""What `run` and `resume` do with a run: play it, say what came of it, and stop on demand."""

from __future__ import annotations

import contextlib
import signal

import click
from rich.table import Table

from evoframe.cli.context import is_quiet, output, scored
from evoframe.cli.progress import Progress
from evoframe.cli.signals import exit_code, stop_on_signals
from evoframe.cli.verify import verification_table
from evoframe.contract import RunConfig, SupportsVariants, unit_of
from evoframe.record import Run
from evoframe.runs import Execution, verify_champion

__all__ = ["play", "show_end"]


def play(ctx: click.Context, execution: Execution) -> None:
    """Run to the end, and show and verify what came of it; or stop where a signal demands it."""
    if not is_quiet(ctx):
        execution.plugins.manager.register(Progress(), name="evoframe:progress")
    run: Run | None = None
    with stop_on_signals("this turn") as stop, contextlib.suppress(KeyboardInterrupt):
        run = execution.play(stop.is_asked)
    if run is None or not run.finished():
        last, directory = execution.last_turn, execution.directory
        saved = "no turn was finished" if last is None else f"all turns up to {last} are saved"
        todo = f"to go on: evoframe resume {directory}"
        click.echo(f"Interrupted; {saved} in {directory}; {todo}", err=True)
        ctx.exit(stop.exit_code)
    show_end(ctx, execution.config, run)


def show_end(ctx: click.Context, config: RunConfig, run: Run) -> None:
    """Show what came of a run that has come to its end, and verify its champion."""
    quiet, directory = is_quiet(ctx), run.directory
    if quiet:
        click.echo(directory)
    else:
        output().print(_summary(run, unit_of(config.objective.component)))
    try:
        if not quiet and isinstance(config.simulator.component, SupportsVariants):
            click.echo("verifying the champion", err=True)
        verification = verify_champion(config, run)
    except KeyboardInterrupt:
        click.echo(
            f"Interrupted; the run is complete and saved in {directory}, but not verified; "
            f"evoframe verify {directory} does that",
            err=True,
        )
        ctx.exit(exit_code(signal.SIGINT))
    if verification is not None and not quiet:
        console = output()
        console.print()
        console.print(verification_table(verification))


def _summary(finished: Run, unit: str) -> Table:
    table = Table(box=None, show_header=False)
    table.add_column(style="bold", no_wrap=True)
    table.add_column(overflow="fold")
    result, work = finished.summary(), finished.workload()
    pairs, simulations = (sum(row[key] for row in work) for key in ("pairs", "simulations"))
    diverged = sum(row["score"] is None for row in finished.pairs())
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
