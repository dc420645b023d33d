"""Writing of the reports of runs and studies."""

from __future__ import annotations

from pathlib import Path

from evoframe.analysis.data.studies import load_study
from evoframe.analysis.output.listing import listed, settle
from evoframe.analysis.output.writing import prepare_directory, write_files
from evoframe.analysis.report.draft import Draft
from evoframe.analysis.report.run_report import draft_of_run
from evoframe.analysis.report.study_report import draft_of_study
from evoframe.analysis.statistics.corrections import Correction
from evoframe.errors import InputError
from evoframe.files import is_file
from evoframe.record import CONFIG_FILE, Report, Run, open_run
from evoframe.registry import Plugins, discover
from evoframe.robustness import SETTING_FILE
from evoframe.study import STUDY_FILE

__all__ = ["Report", "report"]


def report(
    source: Run | str | Path,
    *,
    out: str | Path | None = None,
    correction: Correction = "holm",
    plugins: Plugins | None = None,
) -> Report:
    """Write figures, tables, conclusions and a page of a run or a study, finished or not.

    Outdated files of an earlier report in the same directory are removed, unless they were modified.

    Args:
        source: A run, its directory, or the directory of a study.
        out: Directory of the report; by default ``report`` in the directory of the run or study.
        correction: Correction of pairwise p-values for multiple comparisons; ``none`` is what the paper does.
        plugins: Plugins that configurations name; by default the installed ones.

    Raises:
        ConfigurationError: The source cannot be read with these plugins.
        InputError: The source is neither a run nor a study, has nothing to report yet, or is damaged; or
            *out* cannot be created, or contains a run, a study or a measurement.
        ComponentError: A simulator or an evolver fails, or returns something that cannot be drawn.
        RunError: The report cannot be written.
    """
    directory = source.directory if isinstance(source, Run) else Path(source)
    target = directory / "report" if out is None else Path(out)
    for name in (CONFIG_FILE, STUDY_FILE, SETTING_FILE):  # a report there could overwrite their files
        if is_file(target / name):
            raise InputError(
                f"contains a {name}, so no report is written here; choose another directory with --out",
                source=target,
            )
    before = listed(target)
    draft = _draft(source, directory, plugins or discover(), correction)
    prepare_directory(target)
    written = write_files(draft.all_files(), target)
    return Report(target, draft.words, (*written, settle(target, before, written)))


def _draft(source: Run | str | Path, directory: Path, plugins: Plugins, correction: Correction) -> Draft:
    if isinstance(source, Run):
        return draft_of_run(source, plugins, correction)
    if is_file(directory / STUDY_FILE):
        return draft_of_study(load_study(directory, plugins=plugins), plugins, correction)
    if is_file(directory / CONFIG_FILE):
        with open_run(directory) as run:
            return draft_of_run(run, plugins, correction)
    raise InputError(
        f"found no {CONFIG_FILE} and no {STUDY_FILE}, expected the directory of a run or a study",
        source=directory,
    )
