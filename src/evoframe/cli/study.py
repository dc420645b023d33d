"""``evoframe study``."""

from __future__ import annotations

from pathlib import Path

import click
import numpy as np
from click.shell_completion import CompletionItem
from rich.table import Table

from evoframe.cli.context import command, common_options, is_quiet, modules_of, output, plugins_of, set_option
from evoframe.cli.signals import stop_on_signals
from evoframe.cli.sources import refuse_preset
from evoframe.cli.streams import echo
from evoframe.cli.study_progress import StudyProgress, duration, table_of_cells
from evoframe.messages import quantity
from evoframe.study import (
    STUDY_FILE,
    StudyPlan,
    StudyResult,
    is_study,
    plan_study,
    read_study,
    run_study,
    study_names,
)

__all__ = ["study"]

_EPILOG = """\b
Examples:
  evoframe study small                        an example, in seconds
  evoframe study paper --dry-run              600 runs: time and disk space
  evoframe study paper                        start it, in studies/paper
  evoframe study studies/paper                continue it
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
    help="Directory to write the study to.  [default: studies/STUDY]",
)
@click.option(
    "--workers",
    type=click.IntRange(min=0),
    default=0,
    metavar="N",
    help="Number of parallel runs (0: one per core).  [default: 0]",
)
@click.option("--dry-run", is_flag=True, help="Print what would run, with estimated time and disk space.")
@click.option("--retry", is_flag=True, help="Repeat runs that have failed.")
@click.option(
    "--import",
    "tables",
    multiple=True,
    type=click.Path(path_type=Path),
    metavar="ROWS.csv",
    help="Import finished runs from the rows.csv of another session. Repeatable.",
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
    """Run a grid of configurations, several runs each.

    STUDY is a TOML file (extends, runs, grid), a built-in study such as paper or small, or the directory of a
    study to continue. Only missing runs are executed, in an order that keeps a partial study balanced. The
    seed of each run derives from its configuration and index alone. At the end, rows.csv has one row for each
    run, and curves.csv its best fitness and score in each generation.
    """
    refuse_preset(ctx, source)
    if is_study(Path(source)):
        out, source = out or Path(source), str(Path(source) / STUDY_FILE)
    found = read_study(source, overrides, plugins_of(ctx))
    modules = modules_of(ctx)
    if dry_run:
        plan = plan_study(found, out=out, workers=workers, retry=retry, tables=tables, modules=modules)
        output().print(_planned(plan))
        _print_failed(plan.found)
        return
    stopping = stop_on_signals(
        "the turns in progress", lambda: "Interrupted; to continue, repeat the same command"
    )
    with stopping as stop, StudyProgress(quiet=is_quiet(ctx)) as progress:
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
        echo(result.directory)
    else:
        output().print(_results(result))
        done, total = len(result.rows), len(result.study.cells) * result.study.runs
        click.echo(f"{done} of {total} runs are finished, in {result.directory}", err=True)
        if not result.left:
            click.echo(
                f"\nNext, figures, tests and a page:\n  {command(ctx, 'report', result.directory)}", err=True
            )
    _print_failed(result)
    if stop.is_asked():
        what = f"{len(result.left)} runs remain in {result.directory}"
        click.echo(f"Interrupted; {what}; to continue, repeat the same command", err=True)
        ctx.exit(stop.exit_code)
    ctx.exit(int(bool(result.left)))


def _planned(plan: StudyPlan) -> Table:
    found, to_verify = plan.found, len(plan.found.unverified)
    table = Table(box=None, show_header=False)
    table.add_column(style="bold", no_wrap=True)
    table.add_column(overflow="fold")
    table.add_row("configurations", f"{len(found.study.cells)}, with {found.study.runs} runs each")
    unverified = f", of which {to_verify} to verify" if to_verify else ""
    table.add_row("runs", f"{len(found.rows)} finished{unverified}, {len(plan.to_run)} to run")
    table.add_row("pairs", f"{sum(planned.cell.pairs for planned in plan.to_run):,} to score")
    on = "1 core" if plan.cores == 1 else f"{plan.cores} cores"
    bound, estimate = plan.estimate.bound, plan.estimate
    table.add_row("time", f"{bound} {duration(plan.seconds)} on {on}, estimated from {estimate.measured}")
    table.add_row("disk space", f"{bound} {estimate.megabytes:,.0f} MB in {found.directory}")
    return table


def _print_failed(result: StudyResult) -> None:
    failed = result.failed
    for planned, cause in failed.items():
        click.echo(f"failed: {planned.label}: {cause}", err=True)
    if failed:
        what = "1 run failed" if len(failed) == 1 else f"{len(failed)} runs failed"
        click.echo(f"{what}; to repeat, add --retry", err=True)


def _results(result: StudyResult) -> Table:
    """Return the results of each configuration: scores of the best pairs, and the last best fitness."""
    study = result.study
    table = table_of_cells(
        study.headings, ("runs", "best pair (median)", "quartiles", "maximum", "best fitness (median)")
    )
    for cell in study.cells:
        rows = [row for planned, row in result.rows.items() if planned.cell is cell]
        figures = ["", "", "", ""]
        if scores := [row.score for row in rows]:
            quartiles = np.quantile(scores, [0.25, 0.5, 0.75])
            values = [*quartiles, max(scores), np.median([row.fitness for row in rows])]
            low, middle, high, best, fitness = (quantity(value, cell.unit) for value in values)
            figures = [middle, f"{low} to {high}", best, fitness]
        table.add_row(*cell.values, f"{len(rows)}/{study.runs}", *figures)
    return table
