"""What a report shows of a measurement of robustness: that of its own directory, if it was made."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path

import attrs

from evoframe.analysis.output.writing import Rendered, rendered
from evoframe.analysis.page.page import Block, Picture, Section, Words
from evoframe.analysis.robustness.findings import find
from evoframe.analysis.robustness.violins import violins
from evoframe.analysis.robustness.words import conclusions
from evoframe.analysis.statistics.corrections import Correction
from evoframe.files.reading import is_file, shown_name
from evoframe.registry.registry import Plugins
from evoframe.robustness.api import Measurable, measurable
from evoframe.robustness.files import SETTING_FILE, read_robustness
from evoframe.robustness.measurement import Robustness

__all__ = ["RobustnessPart", "robustness_part"]

_STALE = "The measurement that is there is of other champions"
_CAPTION = "All bodies with the same random controllers (evoframe robustness)."
_OTHERWISE = (
    "They were simulated otherwise than in the runs they come from; robustness.json in the folder robustness "
    "says how."
)


@attrs.frozen(eq=False)
class RobustnessPart:
    """What a report has of a measurement; nothing if there is none.

    Attributes:
        blocks: What the page shows.
        figure: The violins, as files.
    """

    blocks: Sequence[Block] = ()
    figure: Rendered | None = None

    @property
    def sections(self) -> list[Section]:
        """Its section of the page, if it has one."""
        return [Section("Robustness", self.blocks)] if self.blocks else []

    def write(self, target: Path) -> list[Path]:
        """Write the figure, if there is one, and return what was written.

        Raises:
            RunError: It cannot be written.
        """
        return [] if self.figure is None else self.figure.write(target)


def robustness_part(directory: Path, plugins: Plugins, correction: Correction = "holm") -> RobustnessPart:
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
        return RobustnessPart()
    measured = read_robustness(place)
    champions = list(measurable(directory, plugins))
    if not {body.digest for body in measured.setting.bodies} >= {each.digest for each in champions}:
        again = f"evoframe robustness {shown_name(directory)} --force"
        return RobustnessPart([Words(f"{_STALE}; to measure again: {again}")])
    figure = rendered(violins(measured), "violins")
    return RobustnessPart([*_blocks(measured, champions, figure, correction)], figure)


def _blocks(
    measured: Robustness, champions: Sequence[Measurable], figure: Rendered, correction: Correction
) -> Iterator[Block]:
    yield Picture(_CAPTION, figure.svg)
    if any(each.simulation != measured.setting.simulation for each in champions):
        yield Words(_OTHERWISE)
    for line in filter(None, conclusions(find(measured, correction)).splitlines()):
        yield Words(line)
