"""The report of a study: figures, tables, words, and a page."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path

import attrs
import pandas as pd

from evoframe.analysis.data.champions import load_champion
from evoframe.analysis.data.studies import StudyData, load_study
from evoframe.analysis.data.tables import (
    Compared,
    comparisons,
    pairs_table,
    ranking_table,
    summary_table,
    versions_table,
)
from evoframe.analysis.data.units import NAMES, axis_title
from evoframe.analysis.figures.lines import Line, lines_of_view
from evoframe.analysis.figures.studies import curves_of, finals, ranks
from evoframe.analysis.output.slugs import slugs
from evoframe.analysis.output.writing import (
    Written,
    prepare_directory,
    write_bytes,
    write_figure,
    write_table,
)
from evoframe.analysis.page.charts import finals_chart, lines_chart
from evoframe.analysis.page.page import Block, Chart, Section, Source, Table, Words, page
from evoframe.analysis.report.champion_report import champion_sections, drawn, write_champion
from evoframe.analysis.robustness import robustness_part
from evoframe.analysis.statistics.corrections import Correction
from evoframe.analysis.statistics.words import conclusion
from evoframe.errors import InputError
from evoframe.record.run import load_run
from evoframe.registry.registry import Plugins
from evoframe.study.conduct import STUDY_FILE

__all__ = ["write_study_report"]

_RANKINGS = (
    "Rankings in the paper's notation, from the greatest mean rank down. What stands between two neighbours "
    "is said of these two: = is not found to differ. Others may differ, as letters and pairs say."
)


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
    drawings = [_Drawing(each, lines_of_view(each.view, each.yardstick, data.unit)) for each in found]
    written = _figures(data.unit, drawings, target)
    tables = _tables(found, data.unit)
    for name, table in tables.items():
        written += write_table(table, target / name)
    champion = drawn(load_champion(data.best_run, plugins)) if data.best_run else None
    if champion is not None:
        written += write_champion(champion, target)
    words = _words(data, found)
    written += [*robustness.write(target), write_bytes(words.encode(), target / "conclusions.txt")]
    rankings, *compared = _compared_sections(data.unit, drawings, tables["ranking"])
    sections = [
        rankings,
        *(champion_sections(champion, _whose(data, directory)) if champion else []),
        *compared,
        *robustness.sections,
        Section("Tables", _large(tables)),
        Section("Configuration", list(_sources(data))),
    ]
    written.append(write_bytes(page(data.label, _lead(data), sections), target / "report.html"))
    return Written(words, tuple(written))


@attrs.frozen
class _Drawing:
    """A view on one yardstick, and what figures and charts draw of it.

    Attributes:
        compared: The view.
        lines: Of its groups; none if no run has a curve.
    """

    compared: Compared
    lines: Sequence[Line]


def _figures(unit: str, drawings: Sequence[_Drawing], directory: Path) -> list[Path]:
    written = []
    names = slugs(f"{each.compared.yardstick} {each.compared.view.title}" for each in drawings)
    for each, name in zip(drawings, names, strict=True):
        view, yardstick, comparison = each.compared.view, each.compared.yardstick, each.compared.comparison
        if each.lines:
            curves = curves_of(each.lines, view, yardstick, unit)
            written += write_figure(curves, directory / f"curves-{name}")
        written += write_figure(finals(view, yardstick, unit, comparison), directory / f"finals-{name}")
        if comparison is not None:
            written += write_figure(ranks(comparison, _heading(each.compared)), directory / f"ranks-{name}")
    return written


def _heading(compared: Compared) -> str:
    return f"{compared.view.title}, {NAMES[compared.yardstick]} by {compared.view.key}"


def _tables(found: Sequence[Compared], unit: str) -> dict[str, pd.DataFrame]:
    return {
        "summary": summary_table(found, unit),
        "pairs": pairs_table(found),
        "ranking": ranking_table(found),
    }


def _large(tables: dict[str, pd.DataFrame]) -> list[Block]:
    captions = {
        "summary": "How the values of each group lie; groups that share a letter are not found to differ.",
        "pairs": "All pairs of groups: Dunn's test, and how often the first is the greater (A12).",
    }
    return [Table(caption, tables[name]) for name, caption in captions.items()]


def _compared_sections(unit: str, drawings: Sequence[_Drawing], rankings: pd.DataFrame) -> list[Section]:
    """Return a section for each view, with both yardsticks, after that of all rankings."""
    by_title: dict[str, list[Block]] = {}
    for each in drawings:
        view, yardstick = each.compared.view, each.compared.yardstick
        name, blocks = NAMES[yardstick], by_title.setdefault(view.title, [])
        first, *more = _said(each.compared)
        blocks += [Words(f"The {name} by {view.key}: {first}"), *map(Words, more)]
        if each.lines:
            plot = lines_chart(each.lines, axis_title(name, unit))
            blocks.append(Chart(f"The {name} in each generation: {_over_runs(each.lines)}.", plot))
        plot = finals_chart(view, yardstick, unit)
        blocks.append(Chart(f"The {name} of every run in the end.", plot))
    sections = [Section(title, blocks) for title, blocks in by_title.items()]
    return [Section("Rankings", [Table(_RANKINGS, rankings)]), *sections]


def _over_runs(lines: Sequence[Line]) -> str:
    banded = all(line.band is not None for line in lines)
    return "mean over runs, with 95 % bands (bootstrap)" if banded else "mean over runs"


def _sources(data: StudyData) -> Iterator[Block]:
    if data.settings:
        yield Source(STUDY_FILE, data.settings)
    if data.best_run:
        provenance = load_run(data.best_run).config.get("provenance", {})
        yield Table("What made the best run.", versions_table(provenance))


def _whose(data: StudyData, directory: Path) -> str:
    here = "" if data.best_run is None else f" ({data.best_run.relative_to(directory).as_posix()})"
    return f"of the best run whose directory is here{here}"


def _words(data: StudyData, found: Sequence[Compared]) -> str:
    parts = [f"{data.label}: {_lead(data)}"]
    parts += [f"{_heading(each)}: {_lines(each)}" for each in found]
    return "\n\n".join(parts) + "\n"


def _lines(compared: Compared) -> str:
    return "\n".join(_said(compared))


def _said(compared: Compared) -> list[str]:
    """Return the ranking of a view, and a paragraph on what it is worth."""
    if compared.comparison is None:
        [group] = compared.groups
        return [f"{group.name} is the only group, so there is nothing that it could be compared with."]
    return [compared.comparison.ranking, conclusion(compared.comparison, f"the {NAMES[compared.yardstick]}")]


def _lead(data: StudyData) -> str:
    said = [f"{len(data.rows)} of {data.planned} runs are finished."]
    if len(data.rows) < data.planned:
        said.append("What follows may change with the others.")
    if not data.alike:
        said.append(
            "The configurations do not all simulate and score in one way, so a score need not mean the same "
            "in all of them."
        )
    return " ".join(said)
