"""The report of a study: figures, tables and words, each as files of its own."""

from __future__ import annotations

import io
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import matplotlib as mpl
import pandas as pd
from matplotlib.figure import Figure

from evoframe.analysis.figures import NAMES, curves, finals, ranks
from evoframe.analysis.statistics import Correction
from evoframe.analysis.study_data import YARDSTICKS, StudyData, View, Yardstick
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
    written = _figures(data, found, directory)
    for name, table in (
        ("summary", summary_table(found)),
        ("pairs", pairs_table(found)),
        ("ranking", ranking_table(found)),
    ):
        written += _table(table, directory / name)
    path = directory / "conclusions.txt"
    write_atomically(path, _words(data, found).encode())
    return [*written, path]


def _figures(data: StudyData, found: Compared, directory: Path) -> list[Path]:
    compared = {(view.title, yardstick): comparison for view, yardstick, comparison in found}
    written = []
    for yardstick, view in _views(data):
        name = re.sub(r"[^A-Za-z0-9.]+", "-", f"{yardstick} {view.title}").strip("-")
        comparison = compared.get((view.title, yardstick))
        written += _drawn(curves(view, yardstick, data.unit), directory / f"curves-{name}")
        written += _drawn(finals(view, yardstick, data.unit, comparison), directory / f"finals-{name}")
        if comparison is not None:
            written += _drawn(ranks(comparison, view.title), directory / f"ranks-{name}")
    return written


def _views(data: StudyData) -> Iterator[tuple[Yardstick, View]]:
    for yardstick in YARDSTICKS:
        for view in data.views(yardstick):
            yield yardstick, view


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
    for view, yardstick, comparison in found:
        what, heading = f"the {NAMES[yardstick]}", f"{view.title}, {NAMES[yardstick]}"
        parts.append(f"{heading}: {comparison.ranking}\n{conclusion(comparison, what)}")
    return "\n\n".join(parts) + "\n"
