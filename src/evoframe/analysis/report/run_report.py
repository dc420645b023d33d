"""Report of a run: figures, tables, and sections of the page."""

from __future__ import annotations

import pandas as pd

from evoframe.analysis.data.champions import ChampionData, load_champion
from evoframe.analysis.data.facts import facts_of
from evoframe.analysis.data.tables import versions_table
from evoframe.analysis.data.units import axis_title, in_unit
from evoframe.analysis.figures.lines import lines_of_run
from evoframe.analysis.figures.studies import draw_lines
from evoframe.analysis.output.writing import figure_files, table_files
from evoframe.analysis.page.charts import lines_chart
from evoframe.analysis.page.html import Block, Chart, Section, Source, Table
from evoframe.analysis.report.champion_report import champion_part
from evoframe.analysis.report.draft import Draft
from evoframe.analysis.robustness.section import robustness_part
from evoframe.analysis.statistics.corrections import Correction
from evoframe.files import LARGEST_DOCUMENT, read_text, shown_name
from evoframe.messages import quantity
from evoframe.record import CONFIG_FILE, Run
from evoframe.registry import Plugins

__all__ = ["draft_of_run"]

_CAPTION = "Score of the best pair so far; best and mean fitness of each population in each generation."


def draft_of_run(run: Run, plugins: Plugins, correction: Correction = "holm") -> Draft:
    """Return the report of a run.

    Args:
        run: The run, finished or not.
        plugins: Plugins that its configuration names.
        correction: Correction of pairwise p-values for multiple comparisons, if robustness was measured.

    Raises:
        ConfigurationError: The run cannot be read with these plugins.
        InputError: The run has no champion yet, or is damaged.
        ComponentError: The simulator or an evolver fails, or returns something that cannot be drawn.
    """
    champion = load_champion(run, plugins)
    title, lead = shown_name(run.directory), _lead(run, champion)
    curves, label = lines_of_run(run, champion.unit), axis_title("score, fitness", champion.unit)
    summary = _summary(run, champion)
    shown = champion_part(champion, "the best pair of the run")
    robustness = robustness_part(run.directory, plugins, correction)
    first, *others = shown.sections
    progress: list[Block] = [
        Chart(_CAPTION, lines_chart(curves, label)),
        Table("Final results.", summary),
    ]
    configuration: list[Block] = [
        Source(CONFIG_FILE, read_text(run.directory / CONFIG_FILE, LARGEST_DOCUMENT)),
        Table("Versions and hardware.", versions_table(run.config.get("provenance", {}))),
    ]
    return Draft(
        title,
        lead,
        sections=[
            first,
            *robustness.sections,
            *others,
            Section("Progress", progress),
            Section("Configuration", configuration),
        ],
        files={
            **figure_files(draw_lines(curves, label, title), "curves"),
            **shown.files,
            **table_files(summary, "summary"),
            **robustness.files,
        },
        words=f"{title}: {lead}\n",
        facts=facts_of([run.config], champion.unit),
    )


def _lead(run: Run, champion: ChampionData) -> str:
    work, score = run.workload(), quantity(champion.score, champion.unit)
    pairs = sum(row["pairs"] for row in work)
    state = "finished" if run.finished() else "not finished"
    return f"best pair {score}; {len(work) - 1:,} turns, {pairs:,} pairs; {state}"


def _summary(run: Run, champion: ChampionData) -> pd.DataFrame:
    """Return the results of the last turn, which are final if the run is finished."""
    last = {row["population"]: row for row in run.turns()}
    figures = {"best pair": champion.score}
    for name in run.config["populations"]:
        figures[f"{name}: best fitness"] = last[name]["best"]
        figures[f"{name}: mean fitness"] = last[name]["mean"]
    if run.finished():
        figures["pair of the fittest"] = run.summary()["fittest_pair_score"]
    table = pd.DataFrame({"figure": list(figures), "value": list(figures.values())})
    return in_unit(table, ["value"], champion.unit)
