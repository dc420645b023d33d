"""The report of a study: figures, tables and words, each as files of its own."""

from __future__ import annotations

import io
import re
from pathlib import Path
from typing import Any

import matplotlib as mpl
import pandas as pd
from matplotlib.figure import Figure

from evoframe.analysis.figures import NAMES, curves, finals, title_of
from evoframe.analysis.statistics import Correction
from evoframe.analysis.study_data import YARDSTICKS, StudyData
from evoframe.analysis.tables import Compared, comparisons, pairs_table, ranking_table, summary_table
from evoframe.analysis.words import conclusion
from evoframe.errors import InputError
from evoframe.store import write_atomically

__all__ = ["write_report"]

# Nothing of the time or the program: the same study gives the same files.
_FORMATS: dict[str, dict[str, Any]] = {
    "pdf": {"metadata": {"CreationDate": None, "Creator": None, "Producer": None}},
    "svg": {"metadata": {"Date": None, "Creator": None}},
    "png": {"metadata": {"Software": None}, "dpi": 300},
}


def write_report(data: StudyData, directory: Path, correction: Correction = "holm") -> list[Path]:
    """Write the report of a study.

    Args:
        data: The study.
        directory: Where to.
        correction: Of the p-values of pairs; ``none`` is what the paper does.

    Returns:
        What was written.

    Raises:
        InputError: No run is finished, or the directory cannot be made.
        RunError: It cannot be written.
    """
    if not data.rows:
        raise InputError(f"{data.label}: no run of this study is finished, so there is nothing to report")
    try:
        directory.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InputError(f"{directory}: cannot be used for a report: {error.strerror}") from error
    found = comparisons(data, correction)
    written = _figures(data, directory)
    for name, table in (
        ("summary", summary_table(found)),
        ("pairs", pairs_table(found)),
        ("ranking", ranking_table(found)),
    ):
        written += _table(table, directory / name)
    path = directory / "conclusions.txt"
    write_atomically(path, _words(data, found).encode())
    return [*written, path]


def _figures(data: StudyData, directory: Path) -> list[Path]:
    written = []
    for panel in data.panels:
        for yardstick in YARDSTICKS:
            name = re.sub(r"[^A-Za-z0-9.]+", "-", f"{yardstick} {title_of(panel)}").strip("-")
            written += _drawn(curves(data, panel, yardstick), directory / f"curves-{name}")
            written += _drawn(finals(data, panel, yardstick), directory / f"finals-{name}")
    return written


def _drawn(figure: Figure, path: Path) -> list[Path]:
    """Write a figure in all formats."""
    written = []
    with mpl.rc_context({"svg.hashsalt": path.name, "pdf.fonttype": 42, "svg.fonttype": "none"}):
        for ending, options in _FORMATS.items():
            data = io.BytesIO()
            figure.savefig(data, format=ending, **options)
            target = path.with_name(f"{path.name}.{ending}")
            write_atomically(target, data.getvalue())
            written.append(target)
    return written


def _table(table: pd.DataFrame, path: Path) -> list[Path]:
    texts = {
        "csv": table.to_csv(index=False),
        "tex": table.to_latex(index=False, float_format="%.4g", escape=True),
    }
    written = []
    for ending, text in texts.items():
        target = path.with_name(f"{path.name}.{ending}")
        write_atomically(target, text.encode())
        written.append(target)
    return written


def _words(data: StudyData, found: Compared) -> str:
    finished = f"{len(data.rows)} of {data.planned} runs are finished."
    if len(data.rows) < data.planned:
        finished += " What follows may change with the others."
    parts = [f"{data.label}: {finished}"]
    for panel, yardstick, comparison in found:
        what = f"the {NAMES[yardstick]}"
        heading = ", ".join(filter(None, [title_of(panel), NAMES[yardstick]]))
        parts.append(f"{heading}: {comparison.ranking}\n{conclusion(comparison, what)}")
    return "\n\n".join(parts) + "\n"
