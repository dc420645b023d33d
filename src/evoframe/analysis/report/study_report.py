"""The report of a study: figures, tables, words, and sections of the page."""

from __future__ import annotations

import functools
from collections.abc import Sequence

import attrs

from evoframe.analysis.data.champions import load_champion
from evoframe.analysis.data.studies import StudyData
from evoframe.analysis.data.tables import (
    Compared,
    comparisons,
    pairs_table,
    ranking_table,
    summary_table,
    versions_table,
)
from evoframe.analysis.data.units import CURVE_CAPTIONS, CURVE_NAMES, NAMES, axis_title
from evoframe.analysis.figures.lines import Line, lines_of_view
from evoframe.analysis.figures.studies import curves_of, finals, ranks
from evoframe.analysis.output.names import slugs
from evoframe.analysis.output.texts import written
from evoframe.analysis.output.writing import figure_files, table_files
from evoframe.analysis.page.charts import finals_chart, lines_chart
from evoframe.analysis.page.html import Block, Chart, Part, Section, Source, Table, Words
from evoframe.analysis.report.champion_report import champion_part
from evoframe.analysis.report.draft import Draft
from evoframe.analysis.robustness.section import robustness_part
from evoframe.analysis.statistics.corrections import Correction
from evoframe.analysis.statistics.words import conclusion
from evoframe.errors import InputError
from evoframe.record import open_run
from evoframe.registry import Plugins
from evoframe.study import STUDY_FILE

__all__ = ["draft_of_study"]

_RANKINGS = (
    "Rankings in the paper's notation, from the greatest mean rank down. What stands between two neighbours "
    "is said of these two: = is not found to differ. Others may differ, as letters and pairs say."
)
_SUMMARY = "How the values of each group lie; groups that share a letter are not found to differ."
_PAIRS = "All pairs of groups: Dunn's test, and how often the first is the greater (A12)."


def draft_of_study(data: StudyData, plugins: Plugins, correction: Correction = "holm") -> Draft:
    """Return the report of a study.

    Args:
        data: The study, finished or not.
        plugins: The plugins that the configuration of its best run names.
        correction: Correction of pairwise p-values; ``none`` is what the paper does.

    Raises:
        ConfigurationError: Its best run cannot be read with these plugins.
        InputError: None of its runs is finished, or one is damaged.
        ComponentError: A simulator or an evolver fails, or returns something that cannot be drawn.
    """
    if not data.rows:
        raise InputError(f"{data.label}: no run of this study is finished, so there is nothing to report")
    robustness = robustness_part(data.directory, plugins, correction)
    found = comparisons(data, correction)
    shown = [_Shown(each, data.unit) for each in found]
    lead = written("lead.txt", data=data)
    words = f"{written('study.txt', data=data, found=shown)}\n"
    summary, pairs, ranking = summary_table(found, data.unit), pairs_table(found), ranking_table(found)
    champion, best_run = _best_run(data, plugins)
    by_title: dict[str, list[Block]] = {}
    for each in shown:
        by_title.setdefault(each.compared.view.title, []).extend(each.blocks())
    tables: list[Block] = [Table(_SUMMARY, summary), Table(_PAIRS, pairs)]
    configuration: list[Block] = [Source(STUDY_FILE, data.settings)] if data.settings else []
    files: dict[str, bytes] = {}
    for each, slug in zip(shown, slugs(each.name for each in shown), strict=True):
        files |= each.figures(slug)
    return Draft(
        data.label,
        lead,
        sections=[
            Section("Rankings", [Table(_RANKINGS, ranking)]),
            *champion.sections,
            *(Section(title, blocks) for title, blocks in by_title.items()),
            *robustness.sections,
            Section("Tables", tables),
            Section("Configuration", [*configuration, *best_run]),
        ],
        files={
            **files,
            **table_files(summary, "summary"),
            **table_files(pairs, "pairs"),
            **table_files(ranking, "ranking"),
            **champion.files,
            **robustness.files,
            "conclusions.txt": words.encode(),
        },
        words=words,
        facts=data.facts,
    )


def _best_run(data: StudyData, plugins: Plugins) -> tuple[Part, Sequence[Block]]:
    """Return what is shown of the champion of the best run that is there, and of what made it."""
    if data.best_run is None:
        return Part(), ()
    with open_run(data.best_run) as run:
        champion = load_champion(run, plugins)
    place = data.best_run.relative_to(data.directory).as_posix()
    made_by = versions_table(run.config.get("provenance", {}))
    whose = f"of the best run whose directory is here ({place})"
    return champion_part(champion, whose), [Table("What made the best run.", made_by)]


@attrs.frozen(slots=False)
class _Shown:
    """A view on one yardstick, as a report shows it."""

    compared: Compared
    unit: str

    @functools.cached_property
    def lines(self) -> list[Line]:
        """Its groups over generations, which figures and charts draw; none if no run has a curve."""
        return lines_of_view(self.compared.view, self.compared.yardstick, self.unit)

    @property
    def name(self) -> str:
        """The name that its files are made of."""
        return f"{self.compared.yardstick} {self.compared.view.title}"

    @property
    def heading(self) -> str:
        """What is compared by what."""
        view = self.compared.view
        return f"{view.title}, {NAMES[self.compared.yardstick]} by {view.key}"

    @functools.cached_property
    def said(self) -> list[str]:
        """Its ranking, and a paragraph on what that is worth; a sentence if there is one group."""
        if self.compared.comparison is None:
            return [written("alone.txt", group=self.compared.groups[0])]
        measure = f"the {NAMES[self.compared.yardstick]}"
        return [self.compared.comparison.ranking, conclusion(self.compared.comparison, measure)]

    def figures(self, slug: str) -> dict[str, bytes]:
        """Return its figures, as files whose names end with *slug*."""
        view, yardstick, comparison = self.compared.view, self.compared.yardstick, self.compared.comparison
        files: dict[str, bytes] = {}
        if self.lines:
            files |= figure_files(curves_of(self.lines, view, yardstick, self.unit), f"curves-{slug}")
        files |= figure_files(finals(view, yardstick, self.unit, comparison), f"finals-{slug}")
        if comparison is not None:
            files |= figure_files(ranks(comparison, self.heading), f"ranks-{slug}")
        return files

    def blocks(self) -> list[Block]:
        """Return what a page has of it."""
        view, name = self.compared.view, NAMES[self.compared.yardstick]
        first, *more = self.said
        blocks: list[Block] = [Words(f"The {name} by {view.key}: {first}"), *map(Words, more)]
        if self.lines:
            bands = ", with 95 % bands (bootstrap)" if all(line.band for line in self.lines) else ""
            yardstick = self.compared.yardstick
            plot = lines_chart(self.lines, axis_title(CURVE_NAMES[yardstick], self.unit))
            blocks.append(Chart(f"{CURVE_CAPTIONS[yardstick]}: mean over runs{bands}.", plot))
        plot = finals_chart(view, self.compared.yardstick, self.unit)
        return [*blocks, Chart(f"The {name} of every run in the end.", plot)]
