"""What a report shows of a measurement of robustness: that of its own directory, if it was made."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from matplotlib.figure import Figure

from evoframe.analysis.page import Block, Picture, Section, Words
from evoframe.analysis.robustness.files import SETTING_FILE, read_robustness
from evoframe.analysis.robustness.findings import find
from evoframe.analysis.robustness.violins import violins
from evoframe.analysis.robustness.words import conclusions
from evoframe.analysis.statistics import Correction
from evoframe.analysis.writing import svg_of, write_figure

__all__ = ["robustness_report"]

_NAME = "violins"


def robustness_report(
    directory: Path, target: Path, correction: Correction = "holm"
) -> tuple[Sequence[Path], Sequence[Section]]:
    """Write the violins of the measurement in a run's or a study's directory.

    Args:
        directory: Of the run or study.
        target: Where the report is written to.
        correction: Of the p-values of pairs.

    Returns:
        What was written, and what the page shows; nothing if there is no measurement.

    Raises:
        InputError: The measurement is damaged.
        RunError: The figure cannot be written.
    """
    place = directory / "robustness"
    if not (place / SETTING_FILE).is_file():
        return (), ()
    measured = read_robustness(place)
    figure, words = violins(measured), conclusions(find(measured, correction))
    return write_figure(figure, target / _NAME), (Section("Robustness", _blocks(figure, words)),)


def _blocks(figure: Figure, words: str) -> list[Block]:
    caption = "All bodies with the same random controllers (evoframe robustness)."
    paragraphs = [Words(paragraph) for paragraph in words.strip().split("\n\n")]
    return [Picture(caption, svg_of(figure, _NAME)), *paragraphs]
