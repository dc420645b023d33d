"""``evoframe simulate``."""

from __future__ import annotations

import csv
import json
from pathlib import Path
from typing import Any

import attrs
import click
from rich.table import Table

from evoframe.cli.context import (
    common_options,
    output,
    preset_option,
    scored,
    set_option,
    workers_option,
)
from evoframe.cli.sources import RUN_STUDY_OR_FILE, read_jobs
from evoframe.cli.streams import echo, lend_descriptor
from evoframe.config import Layer
from evoframe.contract import Score, unit_of
from evoframe.designs import Job, naming, simulate_job, trace_of
from evoframe.errors import InputError

__all__ = ["simulate"]

_EPILOG = """\b
Examples:
  evoframe simulate runs/paper-1
  evoframe simulate bodies.npz --json
  evoframe simulate body.npz --set simulator.expansion_coefficient=0 --trace trace.csv
"""


@click.command(epilog=_EPILOG)
@click.argument("files", metavar="RUN|STUDY|FILE...", nargs=-1, required=True, type=RUN_STUDY_OR_FILE)
@preset_option
@set_option
@click.option(
    "--json",
    "as_json",
    is_flag=True,
    help="Print JSON with full precision: the lists labels, score, objective, unit, diverged and diverged_at "
    "with one entry for each design; if every unit is m, also displacement, equal to score.",
)
@click.option(
    "--trace",
    type=click.Path(path_type=Path, dir_okay=False),
    metavar="OUT.csv",
    help="Write the positions of the traced points of one body after every step.",
)
@workers_option
@common_options
@click.pass_context
def simulate(
    ctx: click.Context,
    files: tuple[Path, ...],
    preset: str | None,
    overrides: tuple[str, ...],
    as_json: bool,
    trace: Path | None,
    workers: list[Layer],
) -> None:
    """Simulate designs and print their scores.

    A RUN is the directory of a run, or its champion.json: the champion is simulated with the run's settings.
    A STUDY is the directory of a study, for the champions of its runs.
    A FILE is an .npz file with the arrays material ([X,Y,Z] or [N,X,Y,Z]; codes: 0 empty, 1 passive,
    3 contractile) and phase_cycles of the same shape, or a .vxa file, which contains its own settings.
    """
    jobs = read_jobs(ctx, files, preset, [*overrides, *workers])
    if trace is not None:
        _write_trace(trace, jobs)
    scored_jobs = [(job, simulate_job(job)) for job in jobs]
    bodies = [
        _Body(label, score, job.config.objective.name, unit_of(job.config.objective.component))
        for job, scores in scored_jobs
        for label, score in zip(job.labels, scores, strict=True)
    ]
    if as_json:
        echo(json.dumps(_document(bodies)))
    else:
        output().print(_table(bodies))


@attrs.frozen
class _Body:
    """A simulated design and its score."""

    label: str
    score: Score
    objective: str
    unit: str


def _document(bodies: list[_Body]) -> dict[str, Any]:
    """Return parallel lists with one entry for each body."""
    values = [body.score.value for body in bodies]
    document = {
        "labels": [body.label for body in bodies],
        "score": values,
        "objective": [body.objective for body in bodies],
        "unit": [body.unit for body in bodies],
        "diverged": [value is None for value in values],
        "diverged_at": [body.score.diverged_at for body in bodies],
    }
    return {**document, "displacement": values} if _are_lengths(bodies) else document


def _are_lengths(bodies: list[_Body]) -> bool:
    return all(body.unit == "m" for body in bodies)


def _table(bodies: list[_Body]) -> Table:
    table = Table(box=None, header_style="bold")
    table.add_column("design", overflow="fold")
    table.add_column("score", overflow="fold")
    for body in bodies:
        step = f" at step {body.score.diverged_at}" if body.score.value is None else ""
        table.add_row(body.label, scored(body.score.value, body.unit) + step)
    return table


def _write_trace(path: Path, jobs: list[Job]) -> None:
    given = [(job, design) for job in jobs for design in job.designs]
    if len(given) != 1:
        raise InputError(f"expected one design to trace, found {len(given)}", source="--trace")
    [(job, design)] = given
    with naming(job.path):
        rows = list(trace_of(job.config.simulator.component, design))
    try:
        with lend_descriptor(), path.open("w", newline="", encoding="utf-8") as file:
            csv.writer(file, lineterminator="\n").writerows(rows)
    except OSError as error:
        raise InputError(f"cannot be written: {error.strerror}", source=path) from error
