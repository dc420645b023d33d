"""The report of a run: figures, tables, and a page."""

from __future__ import annotations

from pathlib import Path

import pandas as pd

from evoframe.analysis.data.champions import ChampionData, load_champion
from evoframe.analysis.data.tables import versions_table
from evoframe.analysis.data.units import axis_title, with_unit
from evoframe.analysis.figures.lines import lines_of_run
from evoframe.analysis.figures.studies import lines
from evoframe.analysis.output.writing import (
    Written,
    prepare_directory,
    write_bytes,
    write_figure,
    write_table,
)
from evoframe.analysis.page.charts import lines_chart
from evoframe.analysis.page.page import Chart, Section, Source, Table, page
from evoframe.analysis.report.champion_report import DrawnChampion, champion_sections, drawn, write_champion
from evoframe.analysis.robustness import robustness_part
from evoframe.analysis.statistics.corrections import Correction
from evoframe.files.reading import LARGEST_DOCUMENT, read_text, shown_name
from evoframe.record.layout import CONFIG_FILE
from evoframe.record.run import Run, load_run
from evoframe.registry.registry import Plugins

__all__ = ["write_run_report"]

_CAPTION = "The score of the best pair so far, and the fitness of each population, in each generation."


def write_run_report(
    directory: Path, target: Path, plugins: Plugins, correction: Correction = "holm"
) -> Written:
    """Write the report of a run.

    Args:
        directory: The run, finished or not.
        target: Where to.
        plugins: The plugins that its configuration names.
        correction: Of the p-values of pairs of bodies, if its robustness was measured.

    Raises:
        ConfigurationError: The run cannot be read with these plugins.
        InputError: It is no run's directory, has no champion yet, or is damaged; or *target* cannot be made.
        RunError: The report cannot be written.
    """
    run, champion = load_run(directory), load_champion(directory, plugins)
    curves, label = lines_of_run(run, champion.unit), axis_title("score", champion.unit)
    title, lead, with_figures = shown_name(directory), _lead(run, champion), drawn(champion)
    robustness = robustness_part(directory, plugins, correction)
    prepare_directory(target)
    written = write_figure(lines(curves, label, title), target / "curves")
    written += write_champion(with_figures, target)
    summary = _summary(run, champion)
    written += write_table(summary, target / "summary")
    written += robustness.write(target)
    progress = Section(
        "Progress", [Chart(_CAPTION, lines_chart(curves, label)), Table("The final figures.", summary)]
    )
    champion_first, *others = _sections(run, with_figures, progress)
    data = page(title, lead, [champion_first, *robustness.sections, *others])
    written.append(write_bytes(data, target / "report.html"))
    return Written(f"{title}: {lead}\n", tuple(written))


def _sections(run: Run, champion: DrawnChampion, progress: Section) -> list[Section]:
    text = read_text(run.directory / CONFIG_FILE, LARGEST_DOCUMENT)
    made_by = versions_table(run.config.get("provenance", {}))
    return [
        *champion_sections(champion, "the best pair that was simulated"),
        progress,
        Section("Configuration", [Source(CONFIG_FILE, text), Table("What made it.", made_by)]),
    ]


def _lead(run: Run, champion: ChampionData) -> str:
    work, score = run.workload(), with_unit(champion.score, champion.unit)
    pairs = sum(row["pairs"] for row in work)
    state = "finished" if run.finished() else "not finished yet"
    return f"best pair {score}; {len(work) - 1:,} turns, {pairs:,} pairs; {state}"


def _summary(run: Run, champion: ChampionData) -> pd.DataFrame:
    """Return the final figures, which are those of the last turn as long as the run goes on."""
    last = {row["population"]: row for row in run.turns()}
    figures = {"best pair": champion.score}
    for name in run.config["populations"]:
        figures[f"{name}: best fitness"] = last[name]["best"]
        figures[f"{name}: mean fitness"] = last[name]["mean"]
    if run.finished():
        figures["pair of the fittest"] = run.summary()["fittest_pair_score"]
    return pd.DataFrame({"figure": list(figures), f"value ({champion.unit or 1})": list(figures.values())})
