"""``evoframe report``."""

from __future__ import annotations

from pathlib import Path

import click

from evoframe.analysis.statistics.corrections import Correction
from evoframe.cli.context import common_options, correction_option, is_quiet, needing_extra, plugins_of
from evoframe.cli.sources import RUN_OR_STUDY
from evoframe.cli.streams import echo
from evoframe.errors import InputError

__all__ = ["report"]

_EPILOG = """\b
Examples:
  evoframe report runs/paper-1
  evoframe report studies/paper
  evoframe report studies/paper --correction none --out article
"""


@click.command(epilog=_EPILOG)
@click.argument("directories", metavar="RUN|STUDY...", nargs=-1, required=True, type=RUN_OR_STUDY)
@click.option(
    "--out",
    type=click.Path(path_type=Path),
    metavar="DIR",
    help="Directory to write to; only with one RUN or STUDY.  [default: RUN/report or STUDY/report]",
)
@click.option(
    "--force", is_flag=True, help="Overwrite files that evoframe did not write for this RUN or STUDY."
)
@correction_option
@common_options
@click.pass_context
def report(
    ctx: click.Context, directories: tuple[Path, ...], out: Path | None, force: bool, correction: Correction
) -> None:
    """Write the report of a run or study: figures, tables, conclusions and an interactive page.

    RUN or STUDY is a directory; the run or study need not be finished. The report of a study compares the
    values of the grid's last key, separately for each combination of the other keys, by two measures: the
    score of the best pair, and the fitness. The page report.html contains everything in one file. A report of
    the same RUN or STUDY is renewed; other files are not overwritten without --force.
    """
    with needing_extra("report", "reports"):
        from evoframe.analysis import report as room  # noqa: PLC0415 - takes a second, and an extra

        write = room.report
    if out is not None and len(directories) > 1:
        raise InputError(f"expected one RUN or STUDY, found {len(directories)}", source=f"--out {out}")
    for directory in directories:
        written = write(directory, out=out, correction=correction, force=force, plugins=plugins_of(ctx))
        if is_quiet(ctx):
            echo(written.directory)
        else:
            echo(written.words)
            page = written.directory / "report.html"
            click.echo(f"{len(written.files)} files written; open {page} in a browser", err=True)
