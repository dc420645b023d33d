"""Analysis for scripts and notebooks; the first call loads the libraries of the extra ``report``."""

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
    """Return a study and its finished runs: data frames, and views for its figures.

    Args:
        directory: Directory of the study.
        plugins: Plugins that its configurations name; by default the installed ones.

    Raises:
        ModuleNotFoundError: The extra ``report`` is not installed.
        ConfigurationError: The study cannot be read with these plugins.
        InputError: *directory* does not contain a study, or one of its runs is damaged.
    """
    from evoframe.analysis import data  # noqa: PLC0415 - takes a second, and an extra

    return data.load_study(directory, plugins=plugins)


def report(
    source: Run | str | Path,
    *,
    out: str | Path | None = None,
    correction: Correction = "holm",
    force: bool = False,
    plugins: Plugins | None = None,
) -> Report:
    """Write the report of a run or a study, as the command ``evoframe report`` does.

    Args:
        source: A run, its directory, or the directory of a study; finished or not.
        out: Directory of the report; by default ``report`` in the directory of the source.
        correction: Correction of pairwise p-values for multiple comparisons.
        force: Whether to overwrite files that evoframe did not write for this run or study.
        plugins: Plugins that the source names; by default the installed ones.

    Returns:
        The report: its directory, its files, and its conclusions.

    Raises:
        ModuleNotFoundError: The extra ``report`` is not installed.
        ConfigurationError: The source cannot be read with these plugins.
        InputError: The source cannot be reported, or *out* cannot be used.
        RunError: The report cannot be written.
    """
    from evoframe.analysis import report as room  # noqa: PLC0415 - takes a second, and an extra

    return room.report(source, out=out, correction=correction, force=force, plugins=plugins)
