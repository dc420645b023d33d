"""The paper's robustness figure: how the scores of bodies with random controllers lie."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray
from scipy import stats

from evoframe.analysis.figures import COLOURS
from evoframe.analysis.plain import plain
from evoframe.analysis.units import factor_of
from evoframe.measurement import Robustness

__all__ = ["violins"]

_WIDTH = 3.5  # inches: a column of an article
_LINE = 0.13  # inches, of a label
_LONGEST = 24  # characters of a label's line
_GRID = 200  # points of a density
_HALF = 0.4  # of the distance between two groups


@plain
def violins(measured: Robustness) -> Figure:
    """Return a violin for each group: density, extremes, quartiles and median of all its scores.

    Where a group has several bodies, ticks show the median of each. Metres are shown as millimetres;
    simulations that diverged are left out, and counted at the label.

    Args:
        measured: The measurement.
    """
    groups = measured.setting.groups
    labels = _labels(measured)
    lines = max(label.count("\n") + 1 for label in labels)
    height = 0.75 + len(groups) * max(0.32, 0.08 + lines * _LINE)
    figure = Figure(figsize=(_WIDTH, height), layout="constrained")
    axes = figure.add_subplot()
    factor = factor_of(measured.setting.unit)
    for place, columns in enumerate(groups.values()):
        colour = COLOURS[place] if len(groups) <= len(COLOURS) else COLOURS[0]
        _violin(axes, place, measured.values(columns) * factor, colour)
        if len(columns) > 1:
            medians = [np.median(own) * factor for c in columns if len(own := measured.values([c]))]
            axes.plot(medians, np.full(len(medians), place), "|", color="black", ms=9, mew=0.6, zorder=3)
    axes.set_yticks(range(len(groups)), labels, size=7)
    axes.set_ylim(len(groups) - 0.4, -0.6)  # the first on top
    axes.axvline(0.0, color="0.6", lw=0.6, zorder=0)
    _dress(axes, measured.setting.unit)
    bodies, controllers = len(measured.setting.bodies), measured.setting.controllers
    shared = f"\nthe same for all {bodies} bodies" if bodies > 1 else ""
    drawn = "1 random controller" if controllers == 1 else f"{controllers:,} random controllers"
    figure.suptitle(f"{drawn}{shared}", size=8)
    return figure


def _violin(axes: Axes, place: int, values: NDArray[np.float64], colour: str) -> None:
    if not len(values):
        return
    low, high = float(values.min()), float(values.max())
    if high > low:
        grid = np.linspace(0.0, 1.0, _GRID)
        density = stats.gaussian_kde((values - low) / (high - low))(grid)
        half = _HALF * density / density.max()
        along = low + grid * (high - low)
        axes.fill_between(along, place - half, place + half, color=colour, alpha=0.45, lw=0)
    line: dict[str, Any] = {"color": colour, "solid_capstyle": "butt"}
    axes.plot([low, high], [place, place], lw=0.8, **line)
    for end in (low, high):
        axes.plot([end, end], [place - 0.15, place + 0.15], lw=0.8, **line)
    first, middle, third = np.quantile(values, [0.25, 0.5, 0.75])
    axes.plot([first, third], [place, place], lw=3.5, **line)
    axes.plot(middle, place, "o", color="white", mec="black", mew=0.8, ms=4.5, zorder=4)


def _dress(axes: Axes, unit: str) -> None:
    axes.spines[["top", "right", "left"]].set_visible(False)
    axes.tick_params(axis="y", length=0)
    axes.tick_params(axis="x", labelsize=7)
    shown = {"m": "displacement (mm)", "": "score"}.get(unit, f"score ({unit})")
    axes.set_xlabel(shown, size=8)


def _labels(measured: Robustness) -> list[str]:
    groups = measured.setting.groups
    labels = []
    for name, columns in zip(_short([*groups]), groups.values(), strict=True):
        more = [f"{len(columns)} bodies"] if len(columns) > 1 else []
        lost = measured.lost(columns)
        more += [f"{lost} of {len(columns) * measured.setting.controllers} diverged"] if lost else []
        labels.append("\n".join([*_lines(name), *more]))
    return labels


def _short(names: Sequence[str]) -> list[str]:
    """Return the names, without the first folders of long paths if that leaves them different."""
    parts = [name.split("/") for name in names]
    short = ["/".join(part if len(part) < 4 else ["...", *part[-2:]]) for part in parts]
    return short if len(set(short)) == len(names) else list(names)


def _lines(name: str) -> list[str]:
    """Return a name as lines that fit, as far as it can be broken after spaces and folders."""
    lines = [""]
    for part in re.findall(r"[^ /]*[ /]?", name):
        if len(lines[-1]) + len(part.rstrip()) > _LONGEST:
            lines.append("")
        lines[-1] += part
    return [line.rstrip() for line in lines]
