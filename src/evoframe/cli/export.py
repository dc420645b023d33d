"""``evoframe export``."""

from __future__ import annotations

from pathlib import Path

import click

from evoframe.cli.context import common_options, plugins_of, preset_option, set_option
from evoframe.cli.sources import RUN_OR_FILE, file_options, file_options_of, files_of, print_notes
from evoframe.cli.streams import echo
from evoframe.cli.writing import STDOUT, files_of_settings, force_option, write_file
from evoframe.config import Layers
from evoframe.designs import export_job, read_job

__all__ = ["export"]

_EPILOG = """\b
Examples:
  evoframe export runs/paper-1 --to vxa
  evoframe export body.npz --to vxa --set simulator.duration=1 --out body.vxa
  evoframe export runs/paper-1 --to vxa --out - | head
  evoframe export robot.vxd --base base.vxa --to npz
"""


@click.command(epilog=_EPILOG)
@click.argument("source", metavar="RUN|FILE", type=RUN_OR_FILE)
@click.option(
    "--to",
    "format_",
    metavar="FORMAT",
    required=True,
    help="File format; the simulator vox writes vxa and npz.",
)
@click.option(
    "--out",
    type=click.Path(path_type=Path, allow_dash=True),
    metavar="PATH",
    help="File to write (-: standard output).  [default: RUN/champion.FORMAT, or FILE with that ending]",
)
@force_option
@file_options
@preset_option
@set_option
@common_options
@click.pass_context
def export(
    ctx: click.Context,
    source: Path,
    format_: str,
    out: Path | None,
    force: bool,
    preset: Layers | None,
    overrides: tuple[str, ...],
) -> None:
    """Write a design and its settings in the file format of another program.

    A RUN is the directory of a run, for its champion. A FILE is any file that evoframe simulate reads, with
    one design. Settings that the format cannot express are listed on standard error.
    """
    options = file_options_of(ctx)
    job = read_job(source, preset, overrides, plugins_of(ctx), scored=False, options=options)
    print_notes(ctx, source, job.notes)
    exported = export_job(job, format_)
    for entry in exported.left_out:
        click.echo(f"Warning: not exported: {entry}", err=True)
    default = job.path / f"champion.{format_}" if job.run else job.path.with_suffix(f".{format_}")
    path = out or default
    inputs = [*files_of(ctx, [source]), *files_of_settings(ctx, preset)]
    write_file(path, exported.data, force=force, inputs=inputs)
    if path != STDOUT:
        echo(path)
