"""``evoframe export``."""

from __future__ import annotations

from pathlib import Path

import click

from evoframe.cli.context import common_options, plugins_of, preset_option, set_option
from evoframe.designs import export_job, read_job
from evoframe.errors import InputError, RunError
from evoframe.files import write_atomically

__all__ = ["export"]

_STDOUT = Path("-")
_EPILOG = """\b
Examples:
  evoframe export runs/paper-1 --to vxa
  evoframe export body.npz --to vxa --set simulator.duration=1 --out body.vxa
  evoframe export runs/paper-1 --to vxa --out - | head
"""


@click.command(epilog=_EPILOG)
@click.argument("source", metavar="RUN|FILE", type=click.Path(path_type=Path))
@click.option(
    "--to", "format_", metavar="FORMAT", required=True, help="File format; the simulator vox writes vxa."
)
@click.option(
    "--out",
    type=click.Path(path_type=Path, allow_dash=True),
    metavar="PATH",
    help="File to write (-: standard output).  [default: RUN/champion.FORMAT, or FILE with that ending]",
)
@click.option("--force", is_flag=True, help="Overwrite a file with different content.")
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
    preset: str | None,
    overrides: tuple[str, ...],
) -> None:
    """Write a design and its settings in the file format of another program.

    A RUN is the directory of a run, for its champion. A FILE is any file that evoframe simulate reads, with
    one design. Settings that the format cannot express are listed on standard error.
    """
    job = read_job(source, preset, overrides, plugins_of(ctx), runs=True)
    exported = export_job(job, format_)
    for entry in exported.left_out:
        click.echo(f"Warning: not exported: {entry}", err=True)
    default = job.path / f"champion.{format_}" if job.run else job.path.with_suffix(f".{format_}")
    path = out or default
    if path == _STDOUT:
        click.echo(exported.data, nl=False)
    else:
        _write(path, exported.data, force)
        click.echo(path)


def _write(path: Path, data: bytes, force: bool) -> None:
    """Write a file; overwrite different content only with *force*."""
    try:
        if path.exists() and not path.is_file():
            path.write_bytes(data)  # a device or a pipe; a directory refuses
            return
        if path.exists() and path.read_bytes() == data:
            return
        if path.exists() and not force:
            raise InputError(
                "exists with different content; overwrite it with --force, or choose another --out",
                source=path,
            )
        write_atomically(path, data)
    except OSError as error:
        raise InputError(f"cannot be written: {error.strerror}", source=path) from error
    except RunError as error:
        raise InputError(error.problem, source=error.source, key=error.key) from error
