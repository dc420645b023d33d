"""Arguments that name runs, studies, presets or files."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import Any

import click

from evoframe.cli.context import command, plugins_of
from evoframe.config import Layer, preset_names
from evoframe.designs import Job, read_job
from evoframe.errors import ConfigurationError, InputError
from evoframe.files import exists, is_file
from evoframe.record import CONFIG_FILE, RECORD_FILES
from evoframe.study import TABLES, describes_study, is_study, runs_in, study_names

__all__ = [
    "RUN_OR_FILE",
    "RUN_OR_STUDY",
    "RUN_STUDY_OR_FILE",
    "files_of",
    "read_jobs",
    "refuse_preset",
    "refuse_run_and_study",
    "with_runs_of_studies",
]


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
            InputError: It does not exist.
        """
        path = Path(os.fsdecode(super().convert(value, param, ctx)))
        if exists(path):
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


def files_of(ctx: click.Context, paths: Iterable[Path]) -> Iterator[Path]:
    """Yield the files that contain the data of runs, studies and files; some need not exist."""
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
    preset: str | None,
    overrides: Sequence[str | Layer],
    *,
    scored: bool = True,
) -> list[Job]:
    """Read the designs of files, of runs, and of the runs of studies, as by :func:`read_job`."""
    plugins = plugins_of(ctx)
    found = with_runs_of_studies(ctx, paths)
    return [read_job(path, preset, overrides, plugins, scored=scored) for path in found]


def refuse_run_and_study(ctx: click.Context, source: str) -> None:
    """Suggest the command for a *source* that is a run or a study, not a configuration.

    Raises:
        ConfigurationError: It is one.
    """
    if source in preset_names():
        return
    if exists(Path(source)) and is_file(Path(source) / CONFIG_FILE):
        todo = f"to resume it: {command(ctx, 'resume', source)}"
        raise ConfigurationError(f"is the directory of a run; {todo}", source=source)
    if source in study_names() or is_study(Path(source)) or describes_study(source):
        raise ConfigurationError(f"is a study; to run it: {command(ctx, 'study', source)}", source=source)


def refuse_preset(ctx: click.Context, source: str) -> None:
    """Suggest the command for a *source* that is a preset, not a study.

    Raises:
        ConfigurationError: It is one.
    """
    if source in preset_names() and source not in study_names():
        raise ConfigurationError(f"is a preset; to run it: {command(ctx, 'run', source)}", source=source)
