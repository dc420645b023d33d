"""The paper's robustness figure: distributions of the scores of bodies with random controllers."""

from __future__ import annotations

from collections.abc import Sequence
from typing import cast

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from numpy.typing import NDArray

from evoframe.analysis.data.units import axis_title
from evoframe.analysis.drawing import Figure
from evoframe.analysis.figures.plain import plain
from evoframe.analysis.figures.printed import COLOURS, COLUMN, break_lines, row_height
from evoframe.messages import unit_factor
from evoframe.robustness import Robustness

__all__ = ["violins"]

_NAME, _SIZE = 1.35, 7  # width of a group's name in inches; font size in points
_ROW = 0.32  # smallest distance between two groups in inches
_GRID = 200  # points at which a density is computed
_BREADTH = 0.8  # width of a violin, relative to the distance between two groups
_NOISE = 1e-9  # relative; values that differ by less count as equal, and have no density


@plain
def violins(measured: Robustness) -> Figure:
    """Draw a violin for each group: density, extremes, quartiles and median of all its scores.

    In a group of several bodies, ticks show the median of each body. Meters are shown as millimeters. The
    figure excludes diverged simulations; the label of the group counts them.

    Args:
        measured: The measurement.
    """
    groups = measured.setting.groups
    labels = _labels(measured)
    height = 0.75 + len(groups) * row_height(labels, _ROW)
    figure = Figure(figsize=(COLUMN, height), layout="constrained")
    axes = figure.add_subplot()
    factor = unit_factor(measured.setting.unit)
    for place, columns in enumerate(groups.values()):
        colour = COLOURS[place] if len(groups) <= len(COLOURS) else COLOURS[0]
        _violin(axes, place, measured.values(columns) * factor, colour)
        if len(columns) > 1:
            medians = [np.median(own) * factor for c in columns if len(own := measured.values([c]))]
            axes.plot(medians, np.full(len(medians), place), "|", color="black", ms=9, mew=0.6, zorder=3)
    axes.set_yticks(range(len(groups)), labels, size=_SIZE)
    axes.set_ylim(len(groups) - 0.4, -0.6)  # the first group at the top
    axes.axvline(0.0, color="0.6", lw=0.6, zorder=0)
    axes.spines[["top", "right", "left"]].set_visible(False)
    axes.tick_params(axis="y", length=0)
    axes.tick_params(axis="x", labelsize=7)
    axes.locator_params(axis="x", nbins=6)  # more labels would nearly touch
    axes.set_xlabel(axis_title("score", measured.setting.unit), size=8)
    bodies, controllers = len(measured.setting.bodies), measured.setting.controllers
    shared = f"\nthe same for all {bodies} bodies" if bodies > 1 else ""
    drawn = "1 random controller" if controllers == 1 else f"{controllers:,} random controllers"
    figure.suptitle(f"{drawn}{shared}", size=8)
    return figure


def _violin(axes: Axes, place: int, values: NDArray[np.float64], colour: str) -> None:
    """Draw the density, extremes, quartiles and median of one group."""
    if not len(values):
        return
    low, first, middle, third, high = np.quantile(values, [0.0, 0.25, 0.5, 0.75, 1.0])
    if high - low > _NOISE * max(high, -low):
        drawn = axes.violinplot(
            [values], [place], orientation="horizontal", widths=_BREADTH, points=_GRID, showextrema=True
        )
        [body] = cast("list[PolyCollection]", drawn["bodies"])
        body.set(facecolor=colour, alpha=0.45, lw=0)
        for name in ("cbars", "cmins", "cmaxes"):
            drawn[name].set(color=colour, lw=0.8)
    axes.plot([first, third], [place, place], lw=3.5, color=colour, solid_capstyle="butt")
    axes.plot(middle, place, "o", color="white", mec="black", mew=0.8, ms=4.5, zorder=4)


def _labels(measured: Robustness) -> list[str]:
    groups = measured.setting.groups
    labels = []
    for name, columns in zip(_short([*groups]), groups.values(), strict=True):
        more = [f"{len(columns)} bodies"] if len(columns) > 1 else []
        lost = measured.lost(columns)
        more += [f"{lost} of {len(columns) * measured.setting.controllers} diverged"] if lost else []
        labels.append("\n".join([break_lines(name, _NAME, _SIZE), *more]))
    return labels


def _short(names: Sequence[str]) -> list[str]:
    """Return the names with long paths shortened, unless two names would become equal."""
    parts = [name.split("/") for name in names]
    short = ["/".join(part if len(part) < 4 else ["...", *part[-2:]]) for part in parts]
    return short if len(set(short)) == len(names) else list(names)
