"""The report of a study: figures, tables and words, each as files of its own."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

from evoframe.analysis.figures import NAMES, curves, finals, ranks
from evoframe.analysis.output import prepare_directory, write_figure, write_table
from evoframe.analysis.statistics import Correction
from evoframe.analysis.study_data import YARDSTICKS, StudyData, View, Yardstick
from evoframe.analysis.tables import Compared, comparisons, pairs_table, ranking_table, summary_table
from evoframe.analysis.words import conclusion
from evoframe.errors import InputError
from evoframe.store import write_atomically

__all__ = ["write_report"]


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
    prepare_directory(directory)
    found = comparisons(data, correction)
    written = _figures(data, found, directory)
    for name, table in (
        ("summary", summary_table(found)),
        ("pairs", pairs_table(found)),
        ("ranking", ranking_table(found)),
    ):
        written += write_table(table, directory / name)
    path = directory / "conclusions.txt"
    write_atomically(path, _words(data, found).encode())
    return [*written, path]


def _figures(data: StudyData, found: Compared, directory: Path) -> list[Path]:
    compared = {(view.title, yardstick): comparison for view, yardstick, comparison in found}
    written = []
    for yardstick, view in _views(data):
        name = re.sub(r"[^A-Za-z0-9.]+", "-", f"{yardstick} {view.title}").strip("-")
        comparison = compared.get((view.title, yardstick))
        written += write_figure(curves(view, yardstick, data.unit), directory / f"curves-{name}")
        written += write_figure(finals(view, yardstick, data.unit, comparison), directory / f"finals-{name}")
        if comparison is not None:
            written += write_figure(ranks(comparison, view.title), directory / f"ranks-{name}")
    return written


def _views(data: StudyData) -> Iterator[tuple[Yardstick, View]]:
    for yardstick in YARDSTICKS:
        for view in data.views(yardstick):
            yield yardstick, view


def _words(data: StudyData, found: Compared) -> str:
    finished = f"{len(data.rows)} of {data.planned} runs are finished."
    if len(data.rows) < data.planned:
        finished += " What follows may change with the others."
    parts = [f"{data.label}: {finished}"]
    for view, yardstick, comparison in found:
        what, heading = f"the {NAMES[yardstick]}", f"{view.title}, {NAMES[yardstick]}"
        parts.append(f"{heading}: {comparison.ranking}\n{conclusion(comparison, what)}")
    return "\n\n".join(parts) + "\n"
