"""Writing of the reports of runs and studies."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from evoframe.analysis.data.studies import load_study
from evoframe.analysis.output.listing import announce, listed, refuse_overwriting, settle
from evoframe.analysis.output.writing import prepare_directory, write_files
from evoframe.analysis.report.draft import Draft
from evoframe.analysis.report.run_report import draft_of_run
from evoframe.analysis.report.study_report import draft_of_study
from evoframe.analysis.statistics.corrections import Correction
from evoframe.errors import InputError
from evoframe.files import is_file, parsed_toml, shown_name
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
    force: bool = False,
    plugins: Plugins | None = None,
) -> Report:
    """Write figures, tables, conclusions and a page of a run or a study, finished or not.

    An earlier report of the same run or study is renewed: its files are overwritten, and outdated ones
    removed. Files that were modified or come from elsewhere are not overwritten without *force*.

    Args:
        source: A run, its directory, or the directory of a study.
        out: Directory of the report; by default ``report`` in the directory of the run or study.
        correction: Correction of pairwise p-values for multiple comparisons; ``none`` is what the paper does.
        force: Whether to overwrite files that evoframe did not write for this run or study.
        plugins: Plugins that configurations name; by default the installed ones.

    Raises:
        ConfigurationError: The source cannot be read with these plugins.
        InputError: The source is neither a run nor a study, has nothing to report yet, or is damaged; or
            *out* cannot be created, or contains a run, a study, a measurement, the report of another run or
            study, or a file that would be overwritten.
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
    draft, of = _draft(source, directory, plugins or discover(), correction)
    files = draft.all_files()
    if not force:
        if out is not None and before.files and before.of != of:
            raise InputError(
                "contains the report of another run or study; overwrite it with --force, or choose another "
                "directory with --out",
                source=target,
            )
        refuse_overwriting(target, files, before)
    prepare_directory(target)
    announce(target, of, files, before)
    written = write_files(files, target)
    return Report(target, draft.words, (*written, settle(target, of, before, written)))


def _draft(
    source: Run | str | Path, directory: Path, plugins: Plugins, correction: Correction
) -> tuple[Draft, str]:
    """Return the contents of the report, and the digest of the run or study."""
    if isinstance(source, Run):
        return draft_of_run(source, plugins, correction), _digest(source.config)
    if is_file(directory / STUDY_FILE):
        data = load_study(directory, plugins=plugins)
        tables = parsed_toml(data.settings, str(directory / STUDY_FILE))
        return draft_of_study(data, plugins, correction), _digest(tables, shown_name(directory))
    if is_file(directory / CONFIG_FILE):
        with open_run(directory) as run:
            return draft_of_run(run, plugins, correction), _digest(run.config)
    raise InputError(
        f"found no {CONFIG_FILE} and no {STUDY_FILE}, expected the directory of a run or a study",
        source=directory,
    )


def _digest(tables: Mapping[str, Any], name: str = "") -> str:
    """Return the digest of what identifies a run, or a study, whose runs and grid may grow."""
    changing = ("provenance", "executor", "runs", "grid")
    kept = {key: value for key, value in tables.items() if key not in changing}
    text = json.dumps([name, kept], sort_keys=True, default=str)
    return hashlib.sha256(text.encode()).hexdigest()
