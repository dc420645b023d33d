"""Analysis for scripts and notebooks; the libraries of the extra ``report`` are loaded by the first call."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from evoframe.analysis.data import StudyData
    from evoframe.analysis.report import Report
    from evoframe.analysis.statistics.corrections import Correction
    from evoframe.record import Run
    from evoframe.registry import Plugins

__all__ = ["load_study", "report"]


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
    from evoframe.analysis import data  # noqa: PLC0415 - takes a second, and an extra

    return data.load_study(directory, plugins=plugins)


def report(
    source: Run | str | Path,
    *,
    out: str | Path | None = None,
    correction: Correction = "holm",
    plugins: Plugins | None = None,
) -> Report:
    """Write the report of a run or a study, as the command ``evoframe report`` does.

    Args:
        source: A run, its directory, or the directory of a study; finished or not.
        out: The directory of the report; by default ``report`` within that of the source.
        correction: Of pairwise p-values, for the number of pairs.
        plugins: The plugins that the source names; by default those that are installed.

    Returns:
        The report that was written: its directory, its files, and its conclusions.

    Raises:
        ModuleNotFoundError: The extra ``report`` is not installed.
        ConfigurationError: The source cannot be read with these plugins.
        InputError: The source cannot be reported, or *out* cannot be used.
        RunError: The report cannot be written.
    """
    from evoframe.analysis import report as room  # noqa: PLC0415 - takes a second, and an extra

    return room.report(source, out=out, correction=correction, plugins=plugins)
