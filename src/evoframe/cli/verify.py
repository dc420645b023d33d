"""``evoframe verify``."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import click
from rich.table import Table

from evoframe.cli.context import (
    common_options,
    output,
    preset_option,
    set_option,
    span,
    warn_overlooked,
    warn_unreproduced,
    workers_option,
)
from evoframe.cli.sources import RUN_STUDY_OR_FILE, file_options, read_jobs
from evoframe.cli.streams import echo
from evoframe.config import Layer, Layers
from evoframe.designs import Job, keep_of_job, verdict, verify_job
from evoframe.messages import quantity, unit_name
from evoframe.record import Finding, Verification

__all__ = ["verification_table", "verify"]

_EPILOG = """\b
Examples:
  evoframe verify runs/paper-1
  evoframe verify body.vxa bodies.npz --json
  evoframe verify runs/paper-1 --set objective=face-yz
"""


@click.command(epilog=_EPILOG)
@click.argument("sources", metavar="RUN|STUDY|FILE...", nargs=-1, required=True, type=RUN_STUDY_OR_FILE)
@file_options
@preset_option
@set_option
@click.option("--json", "as_json", is_flag=True, help="Print JSON with full precision.")
@workers_option
@common_options
@click.pass_context
def verify(
    ctx: click.Context,
    sources: tuple[Path, ...],
    preset: Layers | None,
    overrides: tuple[str, ...],
    as_json: bool,
    workers: list[Layer],
) -> None:
    """Test what a score depends on: simulate again with one setting changed at a time.

    A RUN is the directory of a run, for its champion; the table is also saved there, unless --preset or
    --set change the simulation. A STUDY is the directory of a study, for its runs. A FILE is any file that
    evoframe simulate reads.
    """
    jobs = read_jobs(ctx, sources, preset, [*overrides, *workers])
    found = [(job, verify_job(job)) for job in jobs]
    if as_json:
        labelled = [
            (job, label, each) for job, made in found for label, each in zip(job.labels, made, strict=True)
        ]
        echo(json.dumps([_document(job, label, each) for job, label, each in labelled]))
    else:
        for job, verifications in found:
            _print(job, verifications)
    for job, verifications in found:
        unchanged = [each.unchanged for each in verifications]
        warn_overlooked(ctx, job.path, job.config, job.designs, unchanged)
        if job.run is not None and job.score is not None:
            warn_unreproduced(ctx, job.run, job.config, job.score, unchanged[0])
    for job, verifications in found:  # after printing, which needs no writable directory
        keep_of_job(job, verifications)


def _document(job: Job, label: str, verification: Verification) -> dict[str, Any]:
    first, last = verification.unchanged.window or (None, None)
    measure = {"objective": job.config.objective.name, "first_time": first, "last_time": last}
    dialect = {"dialect": job.dialect} if job.dialect else {}
    return {"body": label, **dialect, **measure, **verification.to_json()}


def _print(job: Job, verifications: Sequence[Verification]) -> None:
    console = output()
    for label, design, verification in zip(job.labels, job.designs, verifications, strict=True):
        console.print(label, style="bold", soft_wrap=True)
        console.print(_measure(job, verification), soft_wrap=True)
        console.print(verification_table(verification))
        console.print(verdict(verification, job.config, design), soft_wrap=True)


def _measure(job: Job, verification: Verification) -> str:
    """Return the objective, its unit, and the times between which it measures the unchanged design."""
    unit, window = unit_name(verification.unit), verification.unchanged.window
    parts = [f"objective {job.config.objective.name}"]
    parts += [f"in {unit}"] if unit else []
    return ", ".join([*parts, *([f"from {span(window)}"] if window else [])])


def verification_table(verification: Verification) -> Table:
    """Return a verification as a table; the first row is the unchanged design."""
    unit = verification.unit
    table = Table(box=None, header_style="bold")
    table.add_column("variant", overflow="fold")
    table.add_column("score", overflow="fold")
    table.add_column("of unchanged", justify="right", no_wrap=True)
    for finding in verification.rows:
        share = verification.share(finding)
        table.add_row(finding.name, _outcome(finding, unit), "-" if share is None else f"{share:z.0%}")
    if verification.score is not None and verification.score != verification.unchanged.value:
        table.add_row("score in the run", quantity(verification.score, unit), "")
    return table


def _outcome(finding: Finding, unit: str) -> str:
    """Return the score of a variant, or the median and range of its draws."""
    values, lost = finding.values, finding.diverged_at
    parts = [] if finding.median is None else [quantity(finding.median, unit)]
    if len(values) > 1:
        least, greatest = (quantity(value, unit) for value in (values[0], values[-1]))
        parts.append(f"{least} to {greatest} in {len(values)} draws")
    if lost:
        share = "" if len(finding.scores) == 1 else f"{len(lost)} of {len(finding.scores)} "
        steps = f"step {lost[0]}" if lost[0] == lost[-1] else f"steps {lost[0]} to {lost[-1]}"
        parts.append(f"{share}diverged at {steps}")
    return ", ".join(parts)
