"""``evoframe study``."""

from __future__ import annotations

from pathlib import Path

import click
import numpy as np
from click.shell_completion import CompletionItem
from rich.table import Table

from evoframe.cli.context import common_options, is_quiet, modules_of, output, plugins_of, set_option
from evoframe.cli.signals import stop_on_signals
from evoframe.cli.study_progress import StudyProgress, duration, table_of_cells
from evoframe.study import StudyPlan, StudyResult, plan_study, read_study, run_study, study_names

__all__ = ["study"]

_EPILOG = """\b
Examples:
  evoframe study small                        a minute, to see what a study is
  evoframe study paper --dry-run              600 runs: how long, how much room?
  evoframe study paper --out studies/paper    run it; again, to go on with it
  evoframe study paper --set 'grid={"collaboration.n"=[2], aggregator=["am", "wm"]}'
  evoframe study paper --import docs/results/paper/rows.csv
"""


def _complete(_: click.Context, __: click.Parameter, incomplete: str) -> list[CompletionItem]:
    names = [CompletionItem(name) for name in study_names() if name.startswith(incomplete)]
    return [*names, CompletionItem(incomplete, type="file")]


@click.command(epilog=_EPILOG)
@click.argument("source", metavar="STUDY", shell_complete=_complete)
@set_option
@click.option(
    "--out",
    type=click.Path(path_type=Path),
    metavar="DIR",
    help="The study's directory; by default studies/<study>.",
)
@click.option(
    "--workers",
    type=click.IntRange(min=0),
    default=0,
    metavar="N",
    help="Number of parallel runs; 0: one per core.",
)
@click.option("--dry-run", is_flag=True, help="Print what would run, with estimated time and disk space.")
@click.option("--retry", is_flag=True, help="Run what has failed once more.")
@click.option(
    "--import",
    "tables",
    multiple=True,
    type=click.Path(path_type=Path),
    metavar="ROWS.csv",
    help="Take finished runs from the rows.csv of another session. Repeatable.",
)
@common_options
@click.pass_context
def study(
    ctx: click.Context,
    source: str,
    overrides: tuple[str, ...],
    out: Path | None,
    workers: int,
    dry_run: bool,
    retry: bool,
    tables: tuple[Path, ...],
) -> None:
    """Run a grid of configurations, each several times; go on where that was left.

    STUDY is a TOML file with a base (extends), the number of runs and a grid, or the name of a study that
    comes with evoframe, such as paper or small. Only what is missing is run, in an order that leaves a
    partial study balanced. Seeds are derived: those of one configuration depend on no other. At the end,
    rows.csv has a row for each run, and curves.csv how it got there.
    """
    found = read_study(source, overrides, plugins_of(ctx))
    modules = modules_of(ctx)
    if dry_run:
        plan = plan_study(found, out=out, workers=workers, retry=retry, tables=tables, modules=modules)
        output().print(_planned(plan))
        _print_failed(plan.found)
        return
    with stop_on_signals("the turns in progress") as stop, StudyProgress(quiet=is_quiet(ctx)) as progress:
        result = run_study(
            found,
            out=out,
            workers=workers,
            retry=retry,
            tables=tables,
            modules=modules,
            watcher=progress,
            stop=stop.is_asked,
        )
    if is_quiet(ctx):
        click.echo(result.directory)
    else:
        output().print(_results(result))
    _print_failed(result)
    if stop.is_asked():
        what = f"{len(result.left)} runs are left in {result.directory}"
        click.echo(f"Interrupted; {what}; the same command goes on", err=True)
        ctx.exit(stop.exit_code)
    ctx.exit(int(bool(result.left)))


def _planned(plan: StudyPlan) -> Table:
    found, to_verify = plan.found, len(plan.found.unverified)
    table = Table(box=None, show_header=False)
    table.add_column(style="bold", no_wrap=True)
    table.add_column(overflow="fold")
    table.add_row("configurations", f"{len(found.study.cells)}, {found.study.runs} runs each")
    unverified = f", of which {to_verify} to verify" if to_verify else ""
    table.add_row("runs", f"{len(found.rows)} finished{unverified}, {len(plan.to_run)} to run")
    table.add_row("pairs", f"{sum(planned.cell.pairs for planned in plan.to_run):,} to score")
    on = "1 core" if plan.cores == 1 else f"{plan.cores} cores"
    seconds, measured = plan.estimate.seconds / plan.cores, plan.estimate.measured
    table.add_row("time", f"{duration(seconds)} on {on}, from {measured}")
    table.add_row("room", f"{plan.estimate.megabytes:,.0f} MB in {found.directory}")
    return table


def _print_failed(result: StudyResult) -> None:
    failed = result.failed
    for planned, cause in failed.items():
        click.echo(f"failed: {planned.label}: {cause}", err=True)
    if failed:
        what = "1 run has failed" if len(failed) == 1 else f"{len(failed)} runs have failed"
        click.echo(f"{what}; --retry runs what failed once more", err=True)


def _results(result: StudyResult) -> Table:
    """Return the medians of the best pairs and of the last fitness, and how the first are spread."""
    study = result.study
    table = table_of_cells(study.headings, ("runs", "best pair", "quartiles", "best", "fitness"))
    for cell in study.cells:
        rows = [row for planned, row in result.rows.items() if planned.cell is cell]
        figures = ["", "", "", ""]
        if scores := [row.score for row in rows]:
            low, middle, high = np.quantile(scores, [0.25, 0.5, 0.75])
            fitness = np.median([row.fitness for row in rows])
            spread = f"{low:.5g} to {high:.5g}"
            figures = [f"{middle:.5g}", spread, f"{max(scores):.5g}", f"{fitness:.5g}"]
        table.add_row(*cell.values, f"{len(rows)}/{study.runs}", *figures)
    return table
