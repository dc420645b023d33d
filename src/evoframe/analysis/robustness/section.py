"""What a report shows of a measurement of robustness: that of its own directory, if it was made."""

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

_STALE = "The measurement that is there is of other champions"
_CAPTION = "All bodies with the same random controllers (evoframe robustness)."
_OTHERWISE = (
    "They were simulated otherwise than in the runs they come from; robustness.json in the folder robustness "
    "says how."
)


def robustness_part(directory: Path, plugins: Plugins, correction: Correction = "holm") -> Part:
    """Return what a report has of the measurement in a run's or a study's directory.

    Args:
        directory: Of the run or study.
        plugins: The plugins that configurations name.
        correction: Of the p-values of pairs.

    Raises:
        ConfigurationError: A champion that is there cannot be read with these plugins.
        InputError: The measurement, or a champion, is damaged.
    """
    place = directory / "robustness"
    if not is_file(place / SETTING_FILE):
        return Part()
    measured = read_robustness(place)
    champions = list(measurable(directory, plugins))
    if not {body.digest for body in measured.setting.bodies} >= {each.digest for each in champions}:
        again = f"evoframe robustness {shown_name(directory)} --force"
        return Part([Section("Robustness", [Words(f"{_STALE}; to measure again: {again}")])])
    files = figure_files(violins(measured), "violins")
    blocks: list[Block] = [Picture(_CAPTION, files["violins.svg"])]
    if any(each.simulation != measured.setting.simulation for each in champions):
        blocks.append(Words(_OTHERWISE))
    blocks += map(Words, filter(None, conclusions(find(measured, correction)).splitlines()))
    return Part([Section("Robustness", blocks)], files)
