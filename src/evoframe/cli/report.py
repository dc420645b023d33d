"""``evoframe report``."""

from __future__ import annotations

from pathlib import Path

import click

from evoframe.analysis.statistics.corrections import Correction
from evoframe.cli.context import common_options, correction_option, is_quiet, needing_extra, plugins_of
from evoframe.errors import InputError

__all__ = ["report"]

_EPILOG = """\b
Examples:
  evoframe report runs/paper-1
  evoframe report studies/paper
  evoframe report studies/paper --correction none --out article
"""


@click.command(epilog=_EPILOG)
@click.argument("directories", metavar="DIR...", nargs=-1, required=True, type=click.Path(path_type=Path))
@click.option(
    "--out",
    type=click.Path(path_type=Path),
    metavar="DIR",
    help="Where to, if it is one report; by default DIR/report.",
)
@correction_option
@common_options
@click.pass_context
def report(
    ctx: click.Context, directories: tuple[Path, ...], out: Path | None, correction: Correction
) -> None:
    """Write figures, tables, conclusions and a page of runs and studies, finished or not.

    DIR is the directory of a run or of a study. The last key of a study's grid is what is compared; each
    combination of the others has figures and tests of its own, on two yardsticks: the score of the best pair
    that was simulated, and the averaged fitness. The page, report.html, has all in one file.
    """
    with needing_extra("report", "reports"):
        from evoframe.analysis import report as room  # noqa: PLC0415 - takes a second, and an extra

        write = room.report
    if out is not None and len(directories) > 1:
        raise InputError(f"--out {out}: is one place, but {len(directories)} reports are asked for")
    for directory in directories:
        written = write(directory, out=out, correction=correction, plugins=plugins_of(ctx))
        if is_quiet(ctx):
            click.echo(written.directory)
        else:
            click.echo(written.words)
            place = f"{len(written.files)} files are in {written.directory}"
            click.echo(f"{place}; to be looked at: report.html", err=True)
