"""The report of a directory: of a run, or of a study."""

from __future__ import annotations

from pathlib import Path

import attrs

from evoframe.analysis.output.listing import listed, settle
from evoframe.analysis.output.writing import Written
from evoframe.analysis.report.run_report import write_run_report
from evoframe.analysis.report.study_report import write_study_report
from evoframe.analysis.statistics.corrections import Correction
from evoframe.errors import InputError
from evoframe.files.reading import is_file
from evoframe.record.store import CONFIG_FILE
from evoframe.registry.registry import Plugins
from evoframe.robustness.files import SETTING_FILE
from evoframe.study.conduct import STUDY_FILE

__all__ = ["write_report"]


def write_report(directory: Path, target: Path, plugins: Plugins, correction: Correction = "holm") -> Written:
    """Write the report of a run or a study.

    Files of an earlier report in its place that it does not have any more are removed.

    Args:
        directory: Of a run or a study, finished or not.
        target: Where to.
        plugins: The plugins that configurations name.
        correction: Of the p-values of pairs; ``none`` is what the paper does.

    Raises:
        ConfigurationError: The directory cannot be read with these plugins.
        InputError: It is of neither, has nothing to report yet, or is damaged; or *target* cannot be made, or
            is a place of something else.
        RunError: The report cannot be written.
    """
    _refuse_occupied(target)
    before = listed(target)
    written = _write(directory, target, plugins, correction)
    return attrs.evolve(written, files=(*written.files, settle(target, before, written.files)))


def _write(directory: Path, target: Path, plugins: Plugins, correction: Correction) -> Written:
    if is_file(directory / STUDY_FILE):
        return write_study_report(directory, target, plugins, correction)
    if is_file(directory / CONFIG_FILE):
        return write_run_report(directory, target, plugins, correction)
    raise InputError(
        f"{directory}: is no directory of a run or a study: there is no {CONFIG_FILE} and no {STUDY_FILE}"
    )


def _refuse_occupied(target: Path) -> None:
    """Refuse to write between the files of a run, a study or a measurement, some of which have our names."""
    for name in (CONFIG_FILE, STUDY_FILE, SETTING_FILE):
        if is_file(target / name):
            raise InputError(
                f"{target}: is no place for a report: it has a {name}; choose another with --out"
            )
