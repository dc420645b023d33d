"""What a report shows of a measurement of robustness: that of its own directory, if it was made."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path

from evoframe.analysis.page import Block, Picture, Section, Words
from evoframe.analysis.robustness.files import SETTING_FILE, read_robustness
from evoframe.analysis.robustness.findings import find
from evoframe.analysis.robustness.violins import violins
from evoframe.analysis.robustness.words import conclusions
from evoframe.analysis.statistics import Correction
from evoframe.analysis.writing import Rendered, rendered
from evoframe.candidates import read_candidates
from evoframe.files import is_file, shown_name
from evoframe.measurement import Robustness
from evoframe.plugins import Plugins
from evoframe.robustness import setting_of

__all__ = ["robustness_report"]

_TITLE = "Robustness"
_STALE = "The measurement that is there is of other champions, or simulates them otherwise than this"


def robustness_report(
    directory: Path, target: Path, plugins: Plugins, correction: Correction = "holm"
) -> tuple[Sequence[Path], Sequence[Section]]:
    """Write the violins of the measurement in a run's or a study's directory.

    Args:
        directory: Of the run or study.
        target: Where the report is written to.
        plugins: The plugins that configurations name.
        correction: Of the p-values of pairs.

    Returns:
        What was written, and what the page shows; nothing if there is no measurement.

    Raises:
        InputError: The measurement is damaged.
        RunError: The figure cannot be written.
    """
    place = directory / "robustness"
    if not is_file(place / SETTING_FILE):
        return (), ()
    measured = read_robustness(place)
    if not _is_of(measured, directory, plugins):
        again = f"evoframe robustness {shown_name(directory)} --force"
        return (), (Section(_TITLE, [Words(f"{_STALE}; to measure again: {again}")]),)
    figure, words = rendered(violins(measured), "violins"), conclusions(find(measured, correction))
    return figure.write(target), (Section(_TITLE, _blocks(figure, words)),)


def _is_of(measured: Robustness, directory: Path, plugins: Plugins) -> bool:
    """Return whether all champions of a directory were measured, simulated as they are there."""
    candidates = read_candidates([directory], None, (), plugins)
    now, then = setting_of(candidates, measured.setting.seed, measured.setting.controllers), measured.setting
    there = {body.digest for body in then.bodies}
    simulation = json.loads(json.dumps(now.simulation))  # tuples are read back as lists
    return simulation == then.simulation and there >= {body.digest for body in now.bodies}


def _blocks(figure: Rendered, words: str) -> list[Block]:
    caption = "All bodies with the same random controllers (evoframe robustness)."
    paragraphs = [Words(paragraph) for paragraph in words.strip().split("\n\n")]
    return [Picture(caption, figure.svg), *paragraphs]
