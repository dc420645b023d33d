"""Report of a study: figures, tables, conclusions, and sections of the page."""

from __future__ import annotations

import functools
from collections.abc import Sequence

import attrs

from evoframe.analysis.data.champions import load_champion
from evoframe.analysis.data.effects import effects_article, effects_table, factorials
from evoframe.analysis.data.studies import StudyData
from evoframe.analysis.data.tables import (
    Compared,
    comparisons,
    pairs_article,
    pairs_table,
    ranking_article,
    ranking_table,
    summary_article,
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
from evoframe.analysis.statistics.groups import FEWEST
from evoframe.analysis.statistics.words import conclusion
from evoframe.errors import InputError
from evoframe.record import open_run
from evoframe.registry import Plugins
from evoframe.study import STUDY_FILE

__all__ = ["draft_of_study"]

_HEADING = ("heading",)
_RANKINGS = (
    "Rankings by decreasing mean rank, in the paper's notation. Each sign compares only its two neighbors: > "
    "is a significant difference, = is none. Letters and pairs, below, compare all groups."
)
_SUMMARY = "Statistics of each group; groups that share a letter do not differ significantly."
_EFFECTS = (
    "Main effects and interaction of the two settings of the grid, by the aligned rank transform (Wobbrock "
    "et al., CHI 2011): analyses of variance of ranks, which do not assume normally distributed values."
)
_PAIRS = (
    "All pairs of groups: p-value of Dunn's test, and A12, the probability that a run of the first group "
    "exceeds one of the second."
)


def draft_of_study(data: StudyData, plugins: Plugins, correction: Correction = "holm") -> Draft:
    """Return the report of a study.

    Args:
        data: The study, finished or not.
        plugins: Plugins that the configuration of its best run names.
        correction: Correction of pairwise p-values for multiple comparisons; the paper uses ``none``.

    Raises:
        ConfigurationError: The best run cannot be read with these plugins.
        InputError: None of its runs is finished, or one is damaged.
        ComponentError: A simulator or an evolver fails, or returns something that cannot be drawn.
    """
    if not data.rows:
        raise InputError(
            "found no finished run, so there is nothing to report; finish one with evoframe study",
            source=data.label,
        )
    robustness = robustness_part(data.directory, plugins, correction)
    found = comparisons(data, correction)
    shown = [_Shown(each, data.unit) for each in found]
    lead = written("lead.txt", data=data)
    factorial = factorials(data)
    effects = [(each.measure, written("effects.txt", factorial=each)) for each in factorial]
    words = f"{written('study.txt', data=data, found=shown, effects=effects)}\n"
    summary, pairs, ranking = summary_table(found, data.unit), pairs_table(found), ranking_table(found)
    champion, best_run = _best_run(data, plugins)
    by_title: dict[str, list[Block]] = {}
    for each in shown:
        by_title.setdefault(each.compared.view.title, []).extend(each.blocks())
    tables: list[Block] = [Table(_SUMMARY, summary), Table(_PAIRS, pairs)]
    both: list[Block] = [Words(f"{measure.capitalize()}: {text}") for measure, text in effects]
    files: dict[str, bytes] = {}
    if factorial:
        both.append(Table(_EFFECTS, effects_table(factorial)))
        files |= table_files(effects_table(factorial), "effects", effects_article(factorial), _HEADING)
    configuration: list[Block] = [Source(STUDY_FILE, data.settings)] if data.settings else []
    for each, slug in zip(shown, slugs(each.name for each in shown), strict=True):
        files |= each.figures(slug)
    return Draft(
        data.label,
        lead,
        sections=[
            Section("Rankings", [Table(_RANKINGS, ranking)]),
            *([Section("Effects of both settings", both)] if both else []),
            *champion.sections,
            *(Section(title, blocks) for title, blocks in by_title.items()),
            *robustness.sections,
            Section("Tables", tables),
            Section("Configuration", [*configuration, *best_run]),
        ],
        files={
            **files,
            **table_files(summary, "summary", summary_article(found, data.unit), _HEADING),
            **table_files(pairs, "pairs", pairs_article(found), _HEADING),
            **table_files(ranking, "ranking", ranking_article(found), _HEADING, wrapped="ranking"),
            **champion.files,
            **robustness.files,
            "conclusions.txt": words.encode(),
        },
        words=words,
        facts=data.facts,
    )


def _best_run(data: StudyData, plugins: Plugins) -> tuple[Part, Sequence[Block]]:
    """Return the champion of the best run whose directory exists, and the versions that produced it."""
    if data.best_run is None:
        return Part(), ()
    with open_run(data.best_run) as run:
        champion = load_champion(run, plugins)
    place = data.best_run.relative_to(data.directory).as_posix()
    made_by = versions_table(run.config.get("provenance", {}))
    whose = f"the best pair of {place}"
    return champion_part(champion, whose), [Table("Versions and hardware of the best run.", made_by)]


@attrs.frozen(slots=False)
class _Shown:
    """Figures, text and charts of a view on one yardstick."""

    compared: Compared
    unit: str

    @functools.cached_property
    def lines(self) -> list[Line]:
        """The groups over generations; empty if no run has a curve."""
        return lines_of_view(self.compared.view, self.compared.yardstick, self.unit)

    @property
    def name(self) -> str:
        """The name from which file names are derived."""
        return f"{self.compared.yardstick} {self.compared.view.title}"

    @property
    def heading(self) -> str:
        """The view, the measure, and the compared setting."""
        view = self.compared.view
        return f"{view.title}, {NAMES[self.compared.yardstick]} by {view.key}"

    @functools.cached_property
    def paragraphs(self) -> list[str]:
        """The ranking and a paragraph of conclusions; one sentence if nothing can be compared."""
        if self.compared.comparison is None:
            return [written("alone.txt", groups=self.compared.groups, fewest=FEWEST)]
        measure = f"the {NAMES[self.compared.yardstick]}"
        return [self.compared.comparison.ranking, conclusion(self.compared.comparison, measure)]

    def figures(self, slug: str) -> dict[str, bytes]:
        """Return the figures as files whose names end with *slug*."""
        view, yardstick, comparison = self.compared.view, self.compared.yardstick, self.compared.comparison
        files: dict[str, bytes] = {}
        if self.lines:
            files |= figure_files(curves_of(self.lines, view, yardstick, self.unit), f"curves-{slug}")
        files |= figure_files(finals(view, yardstick, self.unit, comparison), f"finals-{slug}")
        if comparison is not None and comparison.tested:
            files |= figure_files(ranks(comparison, self.heading), f"ranks-{slug}")
        return files

    def blocks(self) -> list[Block]:
        """Return the blocks of the page."""
        view, name = self.compared.view, NAMES[self.compared.yardstick]
        first, *more = self.paragraphs
        blocks: list[Block] = [Words(f"{name.capitalize()} by {view.key}: {first}"), *map(Words, more)]
        if self.lines:
            bands = ", with 95 % bootstrap bands" if all(line.band for line in self.lines) else ""
            yardstick = self.compared.yardstick
            plot = lines_chart(self.lines, axis_title(CURVE_NAMES[yardstick], self.unit))
            blocks.append(Chart(f"{CURVE_CAPTIONS[yardstick]}: mean over runs{bands}.", plot))
        plot = finals_chart(view, self.compared.yardstick, self.unit)
        return [*blocks, Chart(f"{name.capitalize()} of every run, final values.", plot)]
