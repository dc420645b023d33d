"""Execution of a run by ``run`` and ``resume``: progress, results, verification, and stop on a signal."""

from __future__ import annotations

import contextlib
import signal

import click
from rich.table import Table

from evoframe.cli.context import command, is_quiet, output, scored, warn_overlooked, warn_unreproduced
from evoframe.cli.progress import Progress
from evoframe.cli.signals import ended_by_signal, exit_code, stop_on_signals
from evoframe.cli.streams import echo
from evoframe.cli.verify import verification_table
from evoframe.contract import RunConfig, SupportsGeometry, SupportsVariants, fitness_unit_of, unit_of
from evoframe.designs import verdict
from evoframe.record import Run
from evoframe.runs import Execution, verify_champion

__all__ = ["play", "show_end"]


def play(ctx: click.Context, execution: Execution) -> None:
    """Execute a run to its end and print its results, or stop on a signal."""
    if not is_quiet(ctx):
        execution.plugins.manager.register(Progress(), name="evoframe:progress")
    run: Run | None = None
    stopping = stop_on_signals("this turn", lambda: _interrupted(ctx, execution))
    with stopping as stop, contextlib.suppress(KeyboardInterrupt):
        run = execution.play(stop.is_asked)
    if run is None or not run.finished():
        click.echo(_interrupted(ctx, execution), err=True)
        ctx.exit(stop.exit_code)
    show_end(ctx, execution.config, run)


def _interrupted(ctx: click.Context, execution: Execution) -> str:
    last, directory = execution.last_turn, execution.directory
    saved = "no turn was finished" if last is None else f"all turns up to {last} are saved"
    return f"Interrupted; {saved} in {directory}; to continue: {command(ctx, 'resume', directory)}"


def show_end(ctx: click.Context, config: RunConfig, run: Run) -> None:
    """Print the results of a finished run, verify its champion, and suggest the next command."""
    quiet, directory = is_quiet(ctx), run.directory
    if quiet:
        echo(directory)
    else:
        output().print(_summary(run, config))
    interrupted = (
        f"Interrupted; the run is complete and saved in {directory}, but its champion is not verified; "
        f"to verify it: {command(ctx, 'verify', directory)}"
    )
    try:
        if not quiet and isinstance(config.simulator.component, SupportsVariants):
            click.echo("verifying the champion", err=True)
        with ended_by_signal(interrupted):
            verification = verify_champion(config, run)
    except KeyboardInterrupt:
        click.echo(interrupted, err=True)
        ctx.exit(exit_code(signal.SIGINT))
    if quiet:
        return
    if verification is not None:
        console, champion = output(), run.champion()
        design, unchanged = champion.design, verification.unchanged
        console.print()
        console.print(verification_table(verification))
        console.print(verdict(verification, config, design), soft_wrap=True)
        warn_overlooked(ctx, directory, config, [design], [unchanged])
        warn_unreproduced(ctx, run, config, champion.score, unchanged)
    click.echo(f"\nNext, {_contents_of_report(config)}:\n  {command(ctx, 'report', directory)}", err=True)


def _contents_of_report(config: RunConfig) -> str:
    if isinstance(config.simulator.component, SupportsGeometry):
        return "figures and a page that shows the champion moving"
    return "figures"


def _summary(finished: Run, config: RunConfig) -> Table:
    unit = unit_of(config.objective.component)
    table = Table(box=None, show_header=False)
    table.add_column(style="bold", no_wrap=True)
    table.add_column(overflow="fold")
    result, work = finished.summary(), finished.workload()
    pairs, simulations = (sum(row[key] for row in work) for key in ("pairs", "simulations"))
    diverged = sum(row["score"] is None for row in finished.pairs())
    best = finished.table("best_pairs")[-1]
    score = f"{scored(best['score'], unit)} ({config.objective.name}), found in turn {best['turn']}"
    table.add_row("best pair", score)
    for population, fittest in result["fittest"].items():
        fitness = scored(fittest["fitness"], fitness_unit_of(config, population))
        fitness = f"fitness {fitness}, genome {fittest['genome_id']}"
        table.add_row(f"fittest {population}", fitness)
    table.add_row("pair of the fittest", scored(result["fittest_pair_score"], unit))
    counts = f"{simulations:,} simulated, {pairs - simulations:,} repeats, {diverged:,} diverged"
    table.add_row("pairs", f"{pairs:,}: {counts}")
    table.add_row("time", f"{sum(row['seconds'] for row in work):.1f} s")
    table.add_row("directory", str(finished.directory))
    return table
