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
@click.option("--to", "format_", metavar="FORMAT", required=True, help="A format of the simulator: vxa.")
@click.option(
    "--out",
    type=click.Path(path_type=Path, allow_dash=True),
    metavar="PATH",
    help="Where to; - is standard output.  [default: RUN/champion.FORMAT, or the FILE with this ending]",
)
@click.option("--force", is_flag=True, help="Replace a file that is there and holds something else.")
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
    """Write a design with its settings as a file of another program.

    A RUN is a run's directory and stands for its champion. A FILE is what evoframe simulate takes, with one
    design. What the format cannot say is named on standard error.
    """
    job = read_job(source, preset, overrides, plugins_of(ctx), runs=True)
    exported = export_job(job, format_)
    for entry in exported.left_out:
        click.echo(f"Warning: left out: {entry}", err=True)
    default = job.path / f"champion.{format_}" if job.run else job.path.with_suffix(f".{format_}")
    path = out or default
    if path == _STDOUT:
        click.echo(exported.data, nl=False)
    else:
        _write(path, exported.data, force)
        click.echo(path)


def _write(path: Path, data: bytes, force: bool) -> None:
    """Write a file, unless something else is there that nobody allowed to replace."""
    try:
        if path.exists() and not path.is_file():
            path.write_bytes(data)  # a device or a pipe; a directory refuses
            return
        if path.exists() and path.read_bytes() == data:
            return
        if path.exists() and not force:
            raise InputError(
                f"{path}: holds something else; replace it with --force, or choose another --out"
            )
        write_atomically(path, data)
    except OSError as error:
        raise InputError(f"{path}: cannot be written: {error.strerror}") from error
    except RunError as error:
        raise InputError(str(error)) from error
