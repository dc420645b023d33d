"""``evoframe report``."""

from __future__ import annotations

from pathlib import Path

import click

from evoframe.cli.context import common_options, is_quiet, plugins_of
from evoframe.errors import InputError

__all__ = ["report"]

_EPILOG = """\b
Examples:
  evoframe report studies/paper
  evoframe report studies/paper --correction none --out article
"""


@click.command(epilog=_EPILOG)
@click.argument("directory", metavar="STUDY", type=click.Path(path_type=Path))
@click.option(
    "--out", type=click.Path(path_type=Path), metavar="DIR", help="Where to; by default STUDY/report."
)
@click.option(
    "--correction",
    type=click.Choice(["holm", "bonferroni", "fdr_bh", "none"]),
    default="holm",
    show_default=True,
    help="Of the p-values for the number of pairs; the paper uses none.",
)
@common_options
@click.pass_context
def report(ctx: click.Context, directory: Path, out: Path | None, correction: str) -> None:
    """Write figures, tables and conclusions of a study, finished or not.

    STUDY is the directory of a study. The last key of its grid is what is compared; each combination of the
    others has figures and tests of its own, on two yardsticks: the score of the best pair that was simulated,
    and the averaged fitness.
    """
    try:
        from evoframe.analysis.report import write_report  # noqa: PLC0415 - takes a second, and an extra
        from evoframe.analysis.study_data import load_study  # noqa: PLC0415
    except ModuleNotFoundError as error:
        raise InputError(
            f"{error.name} is not installed; for reports: pip install 'evoframe[report]'"
        ) from error
    target = out or directory / "report"
    written = write_report(load_study(directory, plugins=plugins_of(ctx)), target, correction)  # type: ignore[arg-type]
    if is_quiet(ctx):
        click.echo(target)
        return
    click.echo((target / "conclusions.txt").read_text(encoding="utf-8"))
    click.echo(f"{len(written)} files are in {target}", err=True)
