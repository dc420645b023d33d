"""Directories of studies, and the directories of runs in them."""

from __future__ import annotations

from pathlib import Path

from evoframe.errors import InputError
from evoframe.files import is_file
from evoframe.record import CONFIG_FILE
from evoframe.registry import Plugins
from evoframe.study.conduct import STUDY_FILE
from evoframe.study.plan import read_study

__all__ = ["is_study", "runs_in"]


def is_study(path: Path) -> bool:
    """Return whether a path is the directory of a study."""
    return is_file(path / STUDY_FILE)


def runs_in(directory: Path, plugins: Plugins) -> list[Path]:
    """Return the directories of the runs of a study that have started, in the order of work.

    Args:
        directory: The directory of the study.
        plugins: The plugins to choose components from.

    Raises:
        ConfigurationError: The study is not valid.
        InputError: The study cannot be read, or none of its runs has started.
    """
    planned = read_study(directory / STUDY_FILE, (), plugins).planned(directory)
    started = [run.directory for run in planned if is_file(run.directory / CONFIG_FILE)]
    if not started:
        raise InputError("no run of this study has started", source=directory)
    return started
