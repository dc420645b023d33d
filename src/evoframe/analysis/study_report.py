"""The report of a study: figures, tables, words, and a page."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path

import attrs
import pandas as pd

from evoframe.analysis.champion_report import champion_sections, drawn, write_champion
from evoframe.analysis.champions import load_champion
from evoframe.analysis.charts import finals_chart, lines_chart
from evoframe.analysis.corrections import Correction
from evoframe.analysis.figures import curves_of, finals, ranks
from evoframe.analysis.lines import Line, lines_of_view
from evoframe.analysis.page import Block, Chart, Section, Source, Table, Words, page
from evoframe.analysis.robustness import robustness_part
from evoframe.analysis.slugs import slugs
from evoframe.analysis.statistics import Comparison
from evoframe.analysis.study_data import YARDSTICKS, StudyData, View, Yardstick, load_study
from evoframe.analysis.tables import (
    Compared,
    comparisons,
    pairs_table,
    ranking_table,
    summary_table,
    versions_table,
)
from evoframe.analysis.units import NAMES, axis_title
from evoframe.analysis.words import conclusion
from evoframe.analysis.writing import Written, prepare_directory, write_bytes, write_figure, write_table
from evoframe.errors import InputError
from evoframe.loading import load_run
from evoframe.plugins import Plugins
from evoframe.study.conduct import STUDY_FILE

__all__ = ["write_study_report"]


def write_study_report(
    directory: Path, target: Path, plugins: Plugins, correction: Correction = "holm"
) -> Written:
    """Write the report of a study.

    Args:
        directory: The study, finished or not.
        target: Where to.
        plugins: The plugins that the configuration of its best run names.
        correction: Of the p-values of pairs; ``none`` is what the paper does.

    Raises:
        ConfigurationError: The study cannot be read with these plugins.
        InputError: It is no study's directory, none of its runs is finished, one is damaged, or *target*
            cannot be made.
        RunError: It cannot be written.
    """
    data = load_study(directory, plugins=plugins)
    if not data.rows:
        raise InputError(f"{data.label}: no run of this study is finished, so there is nothing to report")
    robustness = robustness_part(directory, plugins, correction)
    prepare_directory(target)
    found = comparisons(data, correction)
    all_shown = [*_shown(data, found)]
    written = _figures(data.unit, all_shown, target)
    tables = _tables(found)
    for name, table in tables.items():
        written += write_table(table, target / name)
    champion = drawn(load_champion(data.best_run, plugins)) if data.best_run else None
    if champion is not None:
        written += write_champion(champion, target)
    words = _words(data, found)
    written += [*robustness.write(target), write_bytes(words.encode(), target / "conclusions.txt")]
    rankings, *compared = _compared_sections(data.unit, all_shown, tables["ranking"])
    sections = [
        rankings,
        *(champion_sections(champion, _whose(data)) if champion else []),
        *compared,
        *robustness.sections,
        Section("Tables", _large(tables)),
        Section("Configuration", list(_sources(data))),
    ]
    written.append(write_bytes(page(data.label, _finished(data), sections), target / "report.html"))
    return Written(words, tuple(written))


@attrs.frozen
class _Shown:
    """A view on one yardstick.

    Attributes:
        view: The groups.
        yardstick: What they are compared by.
        lines: What figures and charts draw of them; none if no run has a curve.
        comparison: Of the groups, if there is more than one.
    """

    view: View
    yardstick: Yardstick
    lines: Sequence[Line]
    comparison: Comparison | None


def _shown(data: StudyData, found: Compared) -> Iterator[_Shown]:
    compared = {(view.title, yardstick): comparison for view, yardstick, comparison in found}
    for yardstick in YARDSTICKS:
        for view in data.views(yardstick):
            lines = lines_of_view(view, yardstick, data.unit)
            yield _Shown(view, yardstick, lines, compared.get((view.title, yardstick)))


def _figures(unit: str, all_shown: Sequence[_Shown], directory: Path) -> list[Path]:
    written = []
    names = slugs(f"{shown.yardstick} {shown.view.title}" for shown in all_shown)
    for shown, name in zip(all_shown, names, strict=True):
        view, yardstick, comparison = shown.view, shown.yardstick, shown.comparison
        title = f"{view.title}, {NAMES[yardstick]}"
        if shown.lines:
            curves = curves_of(shown.lines, view, yardstick, unit)
            written += write_figure(curves, directory / f"curves-{name}")
        written += write_figure(finals(view, yardstick, unit, comparison), directory / f"finals-{name}")
        if comparison is not None:
            written += write_figure(ranks(comparison, title), directory / f"ranks-{name}")
    return written


def _tables(found: Compared) -> dict[str, pd.DataFrame]:
    return {"summary": summary_table(found), "pairs": pairs_table(found), "ranking": ranking_table(found)}


def _large(tables: dict[str, pd.DataFrame]) -> list[Block]:
    captions = {
        "summary": "How the values of each group lie; groups that share a letter are not found to differ.",
        "pairs": "All pairs of groups: Dunn's test, and how often the first beats the second (A12).",
    }
    return [Table(caption, tables[name]) for name, caption in captions.items() if len(tables[name])]


def _compared_sections(unit: str, all_shown: Sequence[_Shown], rankings: pd.DataFrame) -> list[Section]:
    """Return a section for each view, with both yardsticks, after that of all rankings."""
    by_title: dict[str, list[Block]] = {}
    for shown in all_shown:
        view, name = shown.view, NAMES[shown.yardstick]
        blocks = by_title.setdefault(view.title, [])
        if shown.comparison is not None:
            blocks.append(Words(f"{shown.comparison.ranking}: {conclusion(shown.comparison, f'the {name}')}"))
        if shown.lines:
            plot = lines_chart(shown.lines, axis_title(name, unit))
            blocks.append(Chart(f"The {name} in each generation: {_over_runs(shown.lines)}.", plot))
        plot = finals_chart(view, shown.yardstick, unit)
        blocks.append(Chart(f"The {name} of every run in the end.", plot))
    summary = [Table("Rankings in the paper's notation: = is not found to differ.", rankings)]
    sections = [Section(title, blocks) for title, blocks in by_title.items()]
    return [Section("Rankings", summary if len(rankings) else []), *sections]


def _over_runs(lines: Sequence[Line]) -> str:
    banded = all(line.band is not None for line in lines)
    return "mean over runs, with 95 % bands (bootstrap)" if banded else "mean over runs"


def _sources(data: StudyData) -> Iterator[Block]:
    if data.settings:
        yield Source(STUDY_FILE, data.settings)
    if data.best_run:
        provenance = load_run(data.best_run).config.get("provenance", {})
        yield Table("What made the best run.", versions_table(provenance))


def _whose(data: StudyData) -> str:
    here = "" if data.best_run is None else f" ({data.best_run.parent.name}, run {data.best_run.name})"
    return f"of the best run whose directory is here{here}"


def _words(data: StudyData, found: Compared) -> str:
    parts = [f"{data.label}: {_finished(data)}"]
    for view, yardstick, comparison in found:
        what, heading = f"the {NAMES[yardstick]}", f"{view.title}, {NAMES[yardstick]}"
        parts.append(f"{heading}: {comparison.ranking}\n{conclusion(comparison, what)}")
    return "\n\n".join(parts) + "\n"


def _finished(data: StudyData) -> str:
    finished = f"{len(data.rows)} of {data.planned} runs are finished."
    return (
        finished if len(data.rows) == data.planned else f"{finished} What follows may change with the others."
    )
