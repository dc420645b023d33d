"""Arguments that name runs, studies, presets or files."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Iterator, Sequence
from pathlib import Path
from typing import Any, TypeVar

import attrs
import click

from evoframe.cli.context import command, is_quiet, plugins_of
from evoframe.config import Layer, Layers, preset_names, read_layers
from evoframe.contract import FileOptions
from evoframe.designs import Job, read_job
from evoframe.errors import ConfigurationError, InputError
from evoframe.files import exists, is_directory, is_file
from evoframe.record import CONFIG_FILE, RECORD_FILES
from evoframe.study import TABLES, describes_study, is_study, runs_in, study_names

__all__ = [
    "RUN_OR_FILE",
    "RUN_OR_STUDY",
    "RUN_STUDY_OR_FILE",
    "file_options",
    "file_options_of",
    "files_of",
    "print_notes",
    "read_configuration",
    "read_jobs",
    "refuse_preset",
    "with_runs_of_studies",
]


F = TypeVar("F", bound=Callable[..., Any])

_FILE_OPTIONS = f"{__name__}.file_options"  # in the context, since only the readers of files need them


class _SourcePath(click.Path):
    """Type of an argument: the path of a run, study or file, which must exist.

    Args:
        expected: What the path may name, for the error.
    """

    def __init__(self, expected: str) -> None:
        super().__init__(path_type=Path)
        self._expected = expected

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Path:
        """Return the path.

        Raises:
            InputError: It does not exist, or is a device or pipe.
        """
        path = Path(os.fsdecode(super().convert(value, param, ctx)))
        if exists(path):
            if not is_file(path) and not is_directory(path):
                raise InputError(f"is neither a file nor a directory; expected {self._expected}", source=path)
            return path
        if ctx is not None and str(path) in preset_names():
            todo = f"run it first ({command(ctx, 'run', path)}), then name the directory of the run"
            raise InputError(f"is a preset; {todo}", source=path)
        raise InputError(f"does not exist; expected {self._expected}", source=path)


RUN_OR_FILE = _SourcePath("the directory of a run, or a file with a design")
RUN_OR_STUDY = _SourcePath("the directory of a run or study")
RUN_STUDY_OR_FILE = _SourcePath("the directory of a run or study, or a file with designs")


def with_runs_of_studies(ctx: click.Context, paths: Iterable[Path]) -> list[Path]:
    """Return *paths* with the directory of each study replaced by those of its runs."""
    found: list[Path] = []
    for path in paths:
        found += runs_in(path, plugins_of(ctx)) if is_study(path) else [path]
    return found


def file_options(function: F) -> F:
    """Add ``--dialect`` and ``--base`` to a command that reads files with designs."""
    for option in (
        click.option(
            "--base",
            type=click.Path(path_type=Path, dir_okay=False),
            expose_value=False,
            callback=_keep_file_option,
            metavar="BASE.vxa",
            help="File that completes a .vxd or .vxc file.  [default for .vxd: base.vxa, or the only .vxa "
            "file in its directory]",
        ),
        click.option(
            "--dialect",
            expose_value=False,
            callback=_keep_file_option,
            metavar="D",
            help="Program by whose rules files are read: the simulator vox knows fork (the paper's engine), "
            "evosoro and voxcraft.  [default: told by the tags of the file]",
        ),
    ):
        function = option(function)
    return function


def _keep_file_option(ctx: click.Context, parameter: click.Parameter, value: Any) -> None:
    if value is not None:
        ctx.meta[_FILE_OPTIONS] = attrs.evolve(file_options_of(ctx), **{str(parameter.name): value})


def file_options_of(ctx: click.Context) -> FileOptions:
    """Return the choices for reading files that the user made with :func:`file_options`."""
    options: FileOptions = ctx.meta.get(_FILE_OPTIONS, FileOptions())
    return options


def print_notes(ctx: click.Context, path: Path, notes: Iterable[str]) -> None:
    """Print how a file was read to standard error, unless only the requested output is printed."""
    if not is_quiet(ctx):
        for note in notes:
            click.echo(f"{path}: {note}", err=True)


def files_of(ctx: click.Context, paths: Iterable[Path]) -> Iterator[Path]:
    """Yield the files that contain the data of runs, studies and files; some need not exist."""
    base = file_options_of(ctx).base
    if base is not None:
        yield base
    for path in paths:
        if not path.is_dir():
            yield path
            continue
        yield from (path / name for name in (*RECORD_FILES, *TABLES))
        if is_study(path):
            yield from files_of(ctx, runs_in(path, plugins_of(ctx)))


def read_jobs(
    ctx: click.Context,
    paths: Iterable[Path],
    preset: Layers | None,
    overrides: Sequence[str | Layer],
    *,
    scored: bool = True,
) -> list[Job]:
    """Read the designs of files, of runs, and of the runs of studies, as by :func:`read_job`; print notes."""
    plugins, options = plugins_of(ctx), file_options_of(ctx)
    jobs = []
    for path in with_runs_of_studies(ctx, paths):
        jobs.append(read_job(path, preset, overrides, plugins, scored=scored, options=options))
        print_notes(ctx, path, jobs[-1].notes)
    return jobs


def read_configuration(ctx: click.Context, source: str) -> Layers:
    """Return the layers of a preset or file; suggest the command for a *source* that is a run or a study.

    Raises:
        ConfigurationError: It is one, or cannot be read.
    """
    if source in preset_names():
        return read_layers(source)
    if exists(Path(source)) and is_file(Path(source) / CONFIG_FILE):
        todo = f"to resume it: {command(ctx, 'resume', source)}"
        raise ConfigurationError(f"is the directory of a run; {todo}", source=source)
    for_study = ConfigurationError(f"is a study; to run it: {command(ctx, 'study', source)}", source=source)
    if source in study_names() or is_study(Path(source)):
        raise for_study
    layers = read_layers(source)  # once: it may be a pipe
    if describes_study(layers):
        raise for_study
    return layers


def refuse_preset(ctx: click.Context, source: str) -> None:
    """Suggest the command for a *source* that is a preset, not a study.

    Raises:
        ConfigurationError: It is one.
    """
    if source in preset_names() and source not in study_names():
        raise ConfigurationError(f"is a preset; to run it: {command(ctx, 'run', source)}", source=source)
