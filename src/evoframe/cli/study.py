"""``evoframe study``."""

from __future__ import annotations

import contextlib
from collections.abc import Mapping, Sequence
from pathlib import Path

import attrs
import click
import numpy as np
from click.shell_completion import CompletionItem
from rich.table import Table

from evoframe.cli.context import common_options, is_quiet, modules_of, output, plugins_of, set_option
from evoframe.cli.signals import stop_on_signals
from evoframe.cli.study_progress import StudyProgress, duration, table_of_cells
from evoframe.study.conduct import alone, claim, conduct, refuse_another, survey
from evoframe.study.estimate import estimated
from evoframe.study.gathered import gather, import_rows, imported_rows
from evoframe.study.plan import Planned, Study, read_study, study_names
from evoframe.study.progress import Status
from evoframe.study.rows import ROWS_FILE, Row, write_rows
from evoframe.study.worker import Order
from evoframe.workers.cores import available_cores

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
    help="So many runs at once; 0: one a core.",
)
@click.option("--dry-run", is_flag=True, help="Only say what would be run, and what time and room it takes.")
@click.option("--retry", is_flag=True, help="Run what has failed once more.")
@click.option(
    "--import",
    "tables",
    multiple=True,
    type=click.Path(path_type=Path),
    metavar="ROWS.csv",
    help="Take finished runs from the table of another sitting. Repeatable.",
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
    directory = out or Path("studies") / found.label
    if not dry_run:
        claim(found, directory)
    elif directory.exists():
        refuse_another(found, directory)
    imported = _imported(found, directory, tables, dry_run=dry_run)
    sitting = _Sitting(ctx, found, directory, imported, survey(found, directory, imported), retry)
    if dry_run:
        sitting.tell(workers or available_cores())
        return
    sitting.work(workers or available_cores())


def _imported(study: Study, directory: Path, tables: Sequence[Path], *, dry_run: bool) -> dict[Planned, Row]:
    """Return the rows that came from elsewhere, and keep those of more tables, if that is no dry run."""
    if dry_run or not tables:
        return imported_rows(study, directory, tables)
    with alone(directory):
        return import_rows(study, directory, tables)


@attrs.frozen
class _Sitting:
    """One call of the command."""

    ctx: click.Context
    study: Study
    directory: Path
    imported: Mapping[Planned, Row]
    statuses: Mapping[Planned, Status]
    retry: bool

    @property
    def to_run(self) -> list[Planned]:
        return self._that_are("missing", "begun", *(["failed"] if self.retry else []))

    @property
    def to_verify(self) -> list[Planned]:
        return [planned for planned in self._that_are("finished") if not self.statuses[planned].verified]

    def _that_are(self, *states: str) -> list[Planned]:
        return [planned for planned, status in self.statuses.items() if status.state in states]

    def tell(self, workers: int) -> None:
        """Say what would be run by so many workers."""
        estimate = estimated(self.to_run, self._that_are("finished"))
        done = self._that_are("finished", "imported")
        cores = max(1, min(workers, available_cores(), len(self.to_run)))  # that have something to do
        table = Table(box=None, show_header=False)
        table.add_column(style="bold", no_wrap=True)
        table.add_column(overflow="fold")
        table.add_row("configurations", f"{len(self.study.cells)}, {self.study.runs} runs each")
        unverified = f", of which {len(self.to_verify)} to verify" if self.to_verify else ""
        table.add_row("runs", f"{len(done)} finished{unverified}, {len(self.to_run)} to run")
        table.add_row("pairs", f"{sum(planned.cell.pairs for planned in self.to_run):,} to score")
        on = "1 core" if cores == 1 else f"{cores} cores"
        table.add_row("time", f"{duration(estimate.seconds / cores)} on {on}, from {estimate.measured}")
        table.add_row("room", f"{estimate.megabytes:,.0f} MB in {self.directory}")
        output().print(table)
        self._tell_failed(self.statuses)

    def work(self, workers: int) -> None:
        """Run what is missing, and show what came of it."""
        todo = [*self.to_verify, *self.to_run]
        rows = gather(self.statuses, self.imported)
        before = {planned: row.score for planned, row in rows.items() if self.statuses[planned].is_complete}
        study, modules = self.study, modules_of(self.ctx)
        orders = {run: Order(run.directory, study.layers_of(run), study.label, modules) for run in todo}
        with stop_on_signals("the turns in progress") as stop:
            progress = StudyProgress(study.headings, todo, before, quiet=is_quiet(self.ctx))
            with contextlib.suppress(KeyboardInterrupt), progress:  # the second signal: it is asked to stop
                conduct(orders, workers, progress, stop.is_asked)
        self._end(stop.exit_code if stop.is_asked() else 0)

    def _end(self, code: int) -> None:
        """Show what there is, and leave with an exit code that says whether that is all."""
        with alone(self.directory):  # so that the last process to write has seen what all of them made
            statuses = survey(self.study, self.directory, self.imported)
            rows = gather(statuses, self.imported)
            write_rows(list(rows.values()), self.directory / ROWS_FILE)
        if is_quiet(self.ctx):
            click.echo(self.directory)
        else:
            output().print(_results(self.study, rows))
        self._tell_failed(statuses)
        left = sum(not status.is_complete for status in statuses.values())
        if code:
            click.echo(
                f"Interrupted; {left} runs are left in {self.directory}; the same command goes on", err=True
            )
        self.ctx.exit(code or int(left > 0))

    def _tell_failed(self, statuses: Mapping[Planned, Status]) -> None:
        failed = {planned: status for planned, status in statuses.items() if status.state == "failed"}
        for planned, status in failed.items():
            click.echo(f"failed: {planned.label}: {status.cause}", err=True)
        if failed:
            what = "1 run has failed" if len(failed) == 1 else f"{len(failed)} runs have failed"
            click.echo(f"{what}; --retry runs what failed once more", err=True)


def _results(study: Study, rows: Mapping[Planned, Row]) -> Table:
    """Return the medians of the best pairs and of the last fitness, and how the first are spread."""
    table = table_of_cells(study.headings, ("runs", "best pair", "quartiles", "best", "fitness"))
    for cell in study.cells:
        found = [row for planned, row in rows.items() if planned.cell is cell]
        scores, fitness = sorted(row.score for row in found), [row.fitness for row in found]
        table.add_row(*cell.values, f"{len(found)}/{study.runs}", *_figures(scores, fitness))
    return table


def _figures(scores: list[float], fitness: list[float]) -> list[str]:
    if not scores:
        return ["", "", "", ""]
    low, middle, high = np.quantile(scores, [0.25, 0.5, 0.75])
    return [
        f"{middle:.5g}", f"{low:.5g} to {high:.5g}", f"{scores[-1]:.5g}", f"{np.median(fitness):.5g}"
    ]  # fmt: skip
