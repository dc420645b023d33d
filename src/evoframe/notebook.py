"""What a notebook asks for; the libraries for it are the extra ``report``, and are loaded when it asks."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from evoframe.registry.registry import Plugins

if TYPE_CHECKING:
    from evoframe.analysis.data.studies import StudyData

__all__ = ["load_study"]


def load_study(directory: str | Path, *, plugins: Plugins | None = None) -> StudyData:
    """Return a study and what is finished of it: data frames, and views for its figures.

    Args:
        directory: Its directory.
        plugins: The plugins that its configurations name; by default those that are installed.

    Raises:
        ModuleNotFoundError: The extra ``report`` is not installed.
        ConfigurationError: It cannot be read with these plugins.
        InputError: It is no study's directory, or one of its runs is damaged.
    """
    from evoframe.analysis.data import studies as study_data  # noqa: PLC0415 - takes a second, and an extra

    return study_data.load_study(directory, plugins=plugins)
