"""``evoframe robustness``."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import click
from rich import progress
from rich.table import Table

from evoframe.analysis.statistics.corrections import Correction
from evoframe.cli.context import (
    common_options,
    correction_option,
    is_quiet,
    messages,
    needing_extra,
    output,
    plugins_of,
    preset_option,
    set_option,
    warn_overlooked,
    workers_option,
)
from evoframe.cli.progress import bar_columns
from evoframe.cli.sources import RUN_STUDY_OR_FILE, file_options, file_options_of, print_notes
from evoframe.cli.streams import echo
from evoframe.config import Layer, Layers
from evoframe.messages import unit_factor, unit_name
from evoframe.robustness import (
    Candidates,
    Setting,
    first_simulation,
    measure,
    read_candidates,
    refuse_another,
    setting_of,
    write_measurement,
)

__all__ = ["robustness"]

_EPILOG = """\b
Examples:
  evoframe robustness runs/paper-1 --published
  evoframe robustness --published --controllers 1000 --correction none
  evoframe robustness studies/paper --controllers 100
"""


@click.command(epilog=_EPILOG)
@click.argument("sources", metavar="[RUN|STUDY|FILE]...", nargs=-1, type=RUN_STUDY_OR_FILE)
@click.option(
    "--controllers",
    type=click.IntRange(1, 1_000_000),
    default=1000,
    show_default=True,
    metavar="N",
    help="Number of random controllers, the same for all bodies.",
)
@click.option("--published", is_flag=True, help="Include the published bodies that the simulator provides.")
@click.option(
    "--seed",
    type=click.IntRange(min=0),
    default=1,
    show_default=True,
    metavar="N",
    help="Seed of the random controllers.",
)
@click.option(
    "--out",
    type=click.Path(path_type=Path),
    metavar="DIR",
    help="Directory to write to.  [default: DIR/robustness for one directory, else ./robustness]",
)
@click.option("--force", is_flag=True, help="Overwrite a measurement made with different settings.")
@click.option("--json", "as_json", is_flag=True, help="Print JSON with all scores.")
@correction_option
@file_options
@preset_option
@set_option
@workers_option
@common_options
@click.pass_context
def robustness(
    ctx: click.Context,
    sources: tuple[Path, ...],
    controllers: int,
    published: bool,
    seed: int,
    out: Path | None,
    force: bool,
    as_json: bool,
    correction: Correction,
    preset: Layers | None,
    overrides: tuple[str, ...],
    workers: list[Layer],
) -> None:
    """Compare bodies by their scores under the same random controllers.

    A RUN is the directory of a run, for its champion. A STUDY is the directory of a study: the champions of
    each configuration form one group. A FILE is any file that evoframe simulate reads. Writes a figure,
    tables, scores and conclusions.
    """
    with needing_extra("report", "statistics and figures"):
        from evoframe.analysis import robustness as analysis  # noqa: PLC0415 - takes a second, and an extra
        from evoframe.analysis.output.writing import prepare_directory  # noqa: PLC0415
    settings: list[str | Layer] = [*overrides, *workers]
    options = file_options_of(ctx)
    candidates = read_candidates(
        sources, preset, settings, plugins_of(ctx), published=published, options=options
    )
    for path, notes in candidates.notes:
        print_notes(ctx, path, notes)
    setting = setting_of(candidates, seed, controllers)
    directory = out or Path("robustness")
    if out is None and len(sources) == 1 and sources[0].is_dir():
        directory = sources[0] / "robustness"
    refuse_another(directory, setting, force=force)
    prepare_directory(directory)  # fails before the measurement, which takes time
    with _bar(len(setting.bodies) * controllers, quiet=is_quiet(ctx)) as on_progress:
        measured = measure(candidates, setting, on_progress)
    _warn_overlooked(ctx, candidates, setting)
    written = write_measurement(measured, directory)  # saved even if the analysis fails
    found = analysis.find(measured, correction)
    written += analysis.write_findings(found, directory)
    if as_json:
        echo(json.dumps(analysis.as_json(found)))
        return
    output().print(_table(analysis.records(analysis.groups_table(found)), setting.unit))
    echo(f"\n{analysis.conclusions(found)}", nl=False)
    if not is_quiet(ctx):
        click.echo(f"{len(written)} files written to {directory}", err=True)


def _warn_overlooked(ctx: click.Context, candidates: Candidates, setting: Setting) -> None:
    """Warn if simulations are longer than the objective looks at, as that of the first body shows."""
    design, score = first_simulation(candidates, setting)
    warn_overlooked(ctx, candidates.bodies[0].source, candidates.config, [design], [score])


@contextmanager
def _bar(total: int, *, quiet: bool) -> Iterator[Callable[[int], None]]:
    """Show the number of finished simulations on a terminal; yield a function that adds to it."""
    console = messages()
    bar = progress.Progress(
        *bar_columns("{task.completed:,} of {task.total:,} simulations"),
        console=console,
        transient=True,
        expand=True,
        disable=quiet or not console.is_terminal,
    )
    with bar:
        task = bar.add_task("", total=total)
        yield lambda done: bar.advance(task, done)


def _table(groups: list[dict[str, Any]], unit: str) -> Table:
    """Return a table with a row for each group; scores in meters are shown in millimeters."""
    factor, shown = unit_factor(unit), unit_name(unit)
    table = Table(box=None, header_style="bold")
    table.add_column("", overflow="fold")
    for heading in (
        "bodies",
        f"median ({shown})" if shown else "median",
        "quartiles",
        "range",
        "positive",
        "diverged",
    ):
        table.add_column(heading, justify="right", overflow="fold")
    for row in groups:
        figures = ["", "", "", ""]
        if row["median"] is not None:
            names = ("median", "first quartile", "third quartile", "least", "greatest")
            middle, low, high, least, greatest = (f"{factor * row[name]:z.4g}" for name in names)
            figures = [middle, f"{low} to {high}", f"{least} to {greatest}", f"{row['positive']:.1%}"]
        table.add_row(row["group"], str(row["bodies"]), *figures, str(row["diverged"]))
    return table
