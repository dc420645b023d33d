"""Figures of a study, fit for an article: matplotlib figures, to be changed or saved by whoever asks.

The colours are those of Okabe and Ito (2008), which people who do not see all colours tell apart; lines
differ in their dashes too.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import pandas as pd
import scikit_posthocs as posthocs
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.transforms import ScaledTranslation
from numpy.typing import NDArray

from evoframe.analysis.lines import Line, lines_of_view
from evoframe.analysis.plain import plain
from evoframe.analysis.statistics import Comparison
from evoframe.analysis.study_data import View, Yardstick
from evoframe.analysis.units import NAMES, axis_title, factor_of

__all__ = ["COLOURS", "DASHES", "curves", "curves_of", "finals", "lines", "ranks"]

COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000", "#F0E442")
DASHES = ("-", (0, (5, 1.5)), (0, (1, 1)), (0, (5, 1.5, 1, 1.5)))
_WIDTH = 3.5  # inches: a column of an article
_GAP = 0.03  # inches, between a line and its label
_FEWEST = 5  # values of which a box tells something


def curves(view: View, yardstick: Yardstick, unit: str = "") -> Figure:
    """Return the mean over runs for each generation, with its 95 % band (bootstrap over runs).

    Args:
        view: The groups.
        yardstick: What is drawn.
        unit: Of scores; metres are shown as millimetres.

    Raises:
        ValueError: No run has a curve.
    """
    return curves_of(lines_of_view(view, yardstick, unit), view, yardstick, unit)


def curves_of(drawn: Sequence[Line], view: View, yardstick: Yardstick, unit: str = "") -> Figure:
    """Return :func:`curves` from the lines of the view, whose bands take a while."""
    return lines(drawn, axis_title(NAMES[yardstick], unit), view.title, f"{view.key}: runs")


@plain
def lines(drawn: Sequence[Line], label: str, title: str, legend: str | None = None) -> Figure:
    """Return lines over generations.

    Args:
        drawn: What is drawn.
        label: Of the vertical axis.
        title: What stands above it.
        legend: What stands above the names of lines.

    Raises:
        ValueError: There are none.
    """
    if not drawn:
        raise ValueError("there are no lines to be drawn")
    figure, axes = _figure(height=3.0)
    for line in drawn:
        style: dict[str, Any] = {
            "color": COLOURS[line.colour % len(COLOURS)],
            "linestyle": DASHES[line.dash % len(DASHES)],
        }
        generations = np.arange(len(line.values))
        axes.plot(generations, line.values, label=line.name, lw=1.2, **style)
        if line.band is not None:
            axes.fill_between(generations, *line.band, color=style["color"], alpha=0.18, lw=0)
    axes.set(xlabel="generation", ylabel=label)
    axes.set_title(title, size=9)
    wide = (
        max(len(line.name) for line in drawn) > 8
    )  # a column has room for four short names, or two long ones
    figure.legend(
        title=legend,
        frameon=False,
        loc="outside lower center",
        ncols=2 if wide else 4,
        fontsize=7,
        title_fontsize=7,
    )
    axes.margins(x=0)
    return figure


@plain
def finals(view: View, yardstick: Yardstick, unit: str = "", comparison: Comparison | None = None) -> Figure:
    """Return every run's final value, with box plots, and letters: what shares one is not different.

    Groups of fewer than five runs have no box (Krzywinski and Altman 2014, Nature Methods 11, 119).

    Args:
        view: The groups.
        yardstick: What is drawn.
        unit: Of scores; metres are shown as millimetres.
        comparison: Of the groups, for the letters.
    """
    figure, axes = _figure()
    groups = view.values(yardstick)
    scaled = [np.array(values) * factor_of(unit) for values in groups.values()]
    places = np.arange(1, len(groups) + 1)
    rng = np.random.default_rng(0)  # of the places of points, nothing else
    for number, (place, values) in enumerate(zip(places, scaled, strict=True)):
        boxed = len(values) >= _FEWEST
        beside = place - (0.18 if boxed else 0.0) + rng.uniform(-0.1, 0.1, len(values))
        axes.plot(beside, values, "o", color=COLOURS[number % 8], ms=3, mew=0, alpha=0.6)
        if boxed:
            _box(axes, place + 0.18, values)
    if comparison is not None:
        _letter(axes, comparison, list(groups))
    labels = [f"{name}\n{len(values)} runs".replace(" (", "\n(") for name, values in groups.items()]
    axes.set_xticks(places, labels)
    axes.set(xlabel=view.key, ylabel=axis_title(NAMES[yardstick], unit), xlim=(0.5, len(groups) + 0.5))
    axes.set_title(view.title, size=9, pad=12)  # the letters are below it
    return figure


@plain
def ranks(comparison: Comparison, title: str) -> Figure:
    """Return the mean rank of each group on a line, the best at the right; bars join what is not different.

    Source: the critical difference diagrams of Demsar 2006, here with the p-values of the comparison.
    """
    figure, axes = _figure(height=0.7 + 0.22 * len(comparison.groups))
    names = [group.name for group in comparison.groups]
    numbers = range(len(names))  # the picture would depend on the hashes of names
    p = pd.DataFrame(
        [[1.0 if i == j else comparison.pair(names[i], names[j]).p for j in numbers] for i in numbers]
    )
    posthocs.critical_difference_diagram(
        {number: comparison.groups[number].mean_rank for number in numbers},
        p,
        ax=axes,
        alpha=comparison.alpha,
        label_fmt_left="{label}",
        label_fmt_right="{label}",
        label_props={"size": 7},
        text_h_margin=0.02 * max(1.0, np.ptp([group.mean_rank for group in comparison.groups])),
        color_palette=["black"] * len(names),
        elbow_props={"lw": 0.9},
        marker_props={"s": 14},
    )
    for text in axes.texts:
        group = comparison.groups[int(text.get_text())]
        text.set_text(f"{group.name}: {group.mean_rank:.3g}")
        gap = -_GAP if text.get_horizontalalignment() == "right" else _GAP  # else it touches its line
        text.set_transform(text.get_transform() + ScaledTranslation(gap, 0, figure.dpi_scale_trans))
    axes.set_title(f"{title}: mean rank", size=9)
    return figure


def _figure(height: float = 2.6) -> tuple[Figure, Axes]:
    figure = Figure(figsize=(_WIDTH, height), layout="constrained")
    axes = figure.add_subplot()
    axes.spines[["top", "right"]].set_visible(False)
    axes.tick_params(labelsize=7)
    for text in (axes.xaxis.label, axes.yaxis.label):
        text.set_fontsize(8)
    return figure, axes


def _box(axes: Axes, place: float, values: NDArray[np.float64]) -> None:
    median = {"color": "black", "lw": 1.5}
    axes.boxplot([values], positions=[place], widths=0.28, showfliers=False, medianprops=median)


def _letter(axes: Axes, comparison: Comparison, names: Sequence[str]) -> None:
    for place, name in enumerate(names, start=1):
        axes.annotate(
            comparison.letters[name],
            (place, 1.0),
            xycoords=("data", "axes fraction"),
            ha="center",
            va="bottom",
            size=8,
        )
