"""Section of a report about the robustness measurement in the directory of the run or study."""

from __future__ import annotations

from pathlib import Path

from evoframe.analysis.output.writing import figure_files
from evoframe.analysis.page.html import Block, Part, Picture, Section, Words
from evoframe.analysis.robustness.figure import violins
from evoframe.analysis.robustness.findings import find
from evoframe.analysis.robustness.words import conclusions
from evoframe.analysis.statistics.corrections import Correction
from evoframe.files import is_file, shown_name
from evoframe.registry import Plugins
from evoframe.robustness import SETTING_FILE, measurable, read_robustness

__all__ = ["robustness_part"]

_STALE = "The measurement in the folder robustness is of other champions; to measure again, run"
_CAPTION = "Scores of all bodies with the same random controllers (evoframe robustness)."
_DIFFERENT = (
    "The simulation differs from that of the runs in which the bodies evolved; its settings are in "
    "robustness/robustness.json."
)


def robustness_part(directory: Path, plugins: Plugins, correction: Correction = "holm") -> Part:
    """Return the section and files that show the measurement in the directory of a run or study.

    Args:
        directory: Directory of the run or study.
        plugins: Plugins that configurations name.
        correction: Correction of pairwise p-values for multiple comparisons.

    Raises:
        ConfigurationError: A champion in the directory cannot be read with these plugins.
        InputError: The measurement, or a champion, is damaged.
    """
    place = directory / "robustness"
    if not is_file(place / SETTING_FILE):
        return Part()
    measured = read_robustness(place)
    champions = list(measurable(directory, plugins))
    if not {body.digest for body in measured.setting.bodies} >= {each.digest for each in champions}:
        again = f"evoframe robustness {shown_name(directory)} --force"
        return Part([Section("Robustness", [Words(f"{_STALE} {again}")])])
    files = figure_files(violins(measured), "violins")
    blocks: list[Block] = [Picture(_CAPTION, files["violins.svg"])]
    if any(each.simulation != measured.setting.simulation for each in champions):
        blocks.append(Words(_DIFFERENT))
    blocks += map(Words, filter(None, conclusions(find(measured, correction)).splitlines()))
    return Part([Section("Robustness", blocks)], files)
