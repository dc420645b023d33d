"""``evoframe simulate``."""

from __future__ import annotations

import csv
import io
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
    span,
    warn_overlooked,
    warn_unreproduced,
    workers_option,
)
from evoframe.cli.sources import RUN_STUDY_OR_FILE, file_options, files_of, read_jobs
from evoframe.cli.streams import echo
from evoframe.cli.writing import STDOUT, files_of_settings, force_option, refuse_inputs, write_file
from evoframe.config import Layer, Layers
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
@file_options
@preset_option
@set_option
@click.option(
    "--json",
    "as_json",
    is_flag=True,
    help="Print JSON with full precision: the lists labels, score, objective, unit, first_time and last_time "
    "(s, between which the score is measured), diverged, diverged_at and missing (reason why there is no "
    "score) with one entry for each design; if every unit is m, also displacement, equal to score; if files "
    "have dialects, also dialect.",
)
@click.option(
    "--trace",
    type=click.Path(path_type=Path, dir_okay=False),
    metavar="OUT.csv",
    help="Write the positions of the traced points of one body after every step.",
)
@force_option
@workers_option
@common_options
@click.pass_context
def simulate(
    ctx: click.Context,
    files: tuple[Path, ...],
    preset: Layers | None,
    overrides: tuple[str, ...],
    as_json: bool,
    trace: Path | None,
    force: bool,
    workers: list[Layer],
) -> None:
    """Simulate designs and print their scores.

    A RUN is the directory of a run, or its champion.json: the champion is simulated with the run's settings.
    A STUDY is the directory of a study, for the champions of its runs.
    A FILE is an .npz file with the arrays material ([X,Y,Z] or [N,X,Y,Z]; codes: 0 empty, 1 passive,
    3 contractile) and phase_cycles of the same shape; a .vxa file, which contains its own settings; a .vxd
    file, which completes one; or a .vxc file, a body without settings. How a file was read is on standard
    error.

    Unless --set or --preset choose an objective, a file with its own settings is scored from the first to
    the last step: a body that is held somewhere by the displacement of its free face, a free body by the
    distance that it travels. A simulation that is too short for the objective has no score.
    """
    if as_json and trace == STDOUT:
        raise InputError("expected a file, since --json prints to standard output", source="--trace -")
    jobs = read_jobs(ctx, files, preset, [*overrides, *workers], scored=False)
    if trace is not None:
        inputs = [*files_of(ctx, files), *files_of_settings(ctx, preset)]
        refuse_inputs(trace, inputs)  # before the simulation, which takes time
        write_file(trace, _trace(jobs), force=force, inputs=inputs)
    scored_jobs = [(job, simulate_job(job)) for job in jobs]
    bodies = [
        _Body(
            label,
            score,
            job.config.objective.name,
            unit_of(job.config.objective.component),
            job.unscored,
            job.dialect,
        )
        for job, scores in scored_jobs
        for label, score in zip(job.labels, scores, strict=True)
    ]
    if as_json:
        echo(json.dumps(_document(bodies)))
    else:
        output().print(_table(bodies))
        for job in jobs:
            if job.unscored:
                echo(f"{job.path} has no score: objective '{job.config.objective.name}': {job.unscored}")
    for job, scores in scored_jobs:
        warn_overlooked(ctx, job.path, job.config, job.designs, scores)
        if job.run is not None and job.score is not None:
            warn_unreproduced(ctx, job.run, job.config, job.score, scores[0])


@attrs.frozen
class _Body:
    """A simulated design and its score."""

    label: str
    score: Score
    objective: str
    unit: str
    unscored: str
    dialect: str

    @property
    def times(self) -> tuple[float, float] | tuple[None, None]:
        """First and last time on which the score depends, s."""
        return self.score.window or (None, None)

    @property
    def outcome(self) -> str:
        """The score with its unit, or the reason why there is none."""
        if self.score.diverged_at is not None:
            return f"diverged at step {self.score.diverged_at}"
        return "missing" if self.unscored else scored(self.score.value, self.unit)


def _document(bodies: list[_Body]) -> dict[str, Any]:
    """Return parallel lists with one entry for each body."""
    values = [body.score.value for body in bodies]
    document: dict[str, Any] = {
        "labels": [body.label for body in bodies],
        "score": values,
        "objective": [body.objective for body in bodies],
        "unit": [body.unit for body in bodies],
        "first_time": [body.times[0] for body in bodies],
        "last_time": [body.times[1] for body in bodies],
        "diverged": [body.score.diverged_at is not None for body in bodies],
        "diverged_at": [body.score.diverged_at for body in bodies],
        "missing": [body.unscored or None for body in bodies],
    }
    if any(body.dialect for body in bodies):
        document["dialect"] = [body.dialect or None for body in bodies]
    return {**document, "displacement": values} if _are_lengths(bodies) else document


def _are_lengths(bodies: list[_Body]) -> bool:
    return all(body.unit == "m" for body in bodies)


def _table(bodies: list[_Body]) -> Table:
    table = Table(box=None, header_style="bold")
    table.add_column("design", overflow="fold")
    table.add_column("score", overflow="fold")
    table.add_column("objective", overflow="fold")
    table.add_column("measured", overflow="fold")
    for body in bodies:
        table.add_row(body.label, body.outcome, body.objective, span(body.score.window))
    return table


def _trace(jobs: list[Job]) -> bytes:
    """Return the trace of a single design as CSV.

    Raises:
        InputError: There are several designs.
    """
    given = [(job, design) for job in jobs for design in job.designs]
    if len(given) != 1:
        raise InputError(f"expected one design to trace, found {len(given)}", source="--trace")
    [(job, design)] = given
    text = io.StringIO()
    with naming(job.path):
        csv.writer(text, lineterminator="\n").writerows(trace_of(job.config.simulator.component, design))
    return text.getvalue().encode()
