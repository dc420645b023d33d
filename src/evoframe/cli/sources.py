"""Arguments that name runs, studies, presets or files."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

import click

from evoframe.cli.context import command, plugins_of
from evoframe.config import preset_names
from evoframe.errors import ConfigurationError
from evoframe.files import is_file
from evoframe.record import CONFIG_FILE
from evoframe.study import is_study, runs_in, study_names

__all__ = ["refuse_preset", "refuse_run_and_study", "with_runs_of_studies"]


def with_runs_of_studies(ctx: click.Context, paths: Iterable[Path]) -> list[Path]:
    """Return *paths* with the directory of each study replaced by those of its runs."""
    found: list[Path] = []
    for path in paths:
        found += runs_in(path, plugins_of(ctx)) if is_study(path) else [path]
    return found


def refuse_run_and_study(ctx: click.Context, source: str) -> None:
    """Suggest the command for a *source* that is a run or a study, not a configuration.

    Raises:
        ConfigurationError: It is one.
    """
    if source in preset_names():
        return
    if source in study_names() or is_study(Path(source)):
        raise ConfigurationError(f"is a study; to run it: {command(ctx, 'study', source)}", source=source)
    if is_file(Path(source) / CONFIG_FILE):
        todo = f"to resume it: {command(ctx, 'resume', source)}"
        raise ConfigurationError(f"is the directory of a run; {todo}", source=source)


def refuse_preset(ctx: click.Context, source: str) -> None:
    """Suggest the command for a *source* that is a preset, not a study.

    Raises:
        ConfigurationError: It is one.
    """
    if source in preset_names() and source not in study_names():
        raise ConfigurationError(f"is a preset; to run it: {command(ctx, 'run', source)}", source=source)
