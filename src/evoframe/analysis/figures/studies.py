"""Figures of studies for print."""

from __future__ import annotations

import itertools
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import pandas as pd
import scikit_posthocs as posthocs
from matplotlib.axes import Axes
from matplotlib.transforms import ScaledTranslation
from numpy.typing import NDArray

from evoframe.analysis.data.studies import View, Yardstick
from evoframe.analysis.data.units import AXIS_NAMES, CURVE_NAMES, axis_title
from evoframe.analysis.drawing import Figure
from evoframe.analysis.figures.lines import Line, lines_of_view
from evoframe.analysis.figures.plain import plain
from evoframe.analysis.figures.printed import COLOURS, COLUMN, DASHES, break_lines, row_height, text_width
from evoframe.analysis.output.texts import counted
from evoframe.analysis.statistics.groups import FEWEST, Comparison
from evoframe.messages import unit_factor

__all__ = ["curves", "curves_of", "draw_lines", "finals", "ranks"]

_TITLE, _SIZE = 9, 7  # font sizes of titles and names, in points
_INSIDE = COLUMN - 0.2  # width between the margins, in inches
_NAME = 1.35  # width of a group's name at the left of its values, in inches
_ROW, _RANKS, _BARS = 0.32, 0.22, 0.17  # smallest distances of groups, ranks and bars, in inches
_RANKED = 1.0  # width of a group's name beside the line of ranks, in inches
_GAP = 0.03  # distance between a line and its label, in inches
_HANDLE, _APART = 0.28, 0.2  # width of a handle, and distance of columns, in inches
_MOST = 4  # greatest number of columns of a legend
_LINE = 0.13  # height of a line of a legend, in inches


def curves(view: View, yardstick: Yardstick, unit: str = "") -> Figure:
    """Draw the mean over the runs of each group by generation, with its 95 % band (bootstrap over runs).

    Args:
        view: The groups.
        yardstick: The measure to draw.
        unit: Unit of the values; meters are shown as millimeters.

    Raises:
        ValueError: No run has a curve.
    """
    return curves_of(lines_of_view(view, yardstick, unit), view, yardstick, unit)


def curves_of(drawn: Sequence[Line], view: View, yardstick: Yardstick, unit: str = "") -> Figure:
    """Draw :func:`curves` from existing lines of the view, since computing their bands takes long."""
    return draw_lines(drawn, axis_title(CURVE_NAMES[yardstick], unit), view.title, f"{view.key}: runs")


@plain
def draw_lines(drawn: Sequence[Line], label: str, title: str, legend: str | None = None) -> Figure:
    """Draw lines over generations.

    Args:
        drawn: The lines.
        label: Label of the vertical axis.
        title: Title of the figure.
        legend: Title of the legend.

    Raises:
        ValueError: There are no lines.
    """
    if not drawn:
        raise ValueError("no lines to draw, expected at least one")
    names = [break_lines(line.name, _INSIDE - _HANDLE, _SIZE) for line in drawn]
    n_columns, n_lines = _legend_shape(names)
    below = break_lines(legend or "", _INSIDE, _SIZE)
    figure, axes = _figure(title, 2.6 + _LINE * (n_lines + below.count("\n") + 1))
    for line, name in zip(drawn, names, strict=True):
        style: dict[str, Any] = {
            "color": COLOURS[line.colour % len(COLOURS)],
            "linestyle": DASHES[line.dash % len(DASHES)],
        }
        generations = np.arange(len(line.values))
        axes.plot(generations, line.values, label=name, lw=1.2, **style)
        if line.band is not None:
            axes.fill_between(generations, *line.band, color=style["color"], alpha=0.18, lw=0)
    axes.set(xlabel="generation", ylabel=label)
    axes.locator_params(axis="x", integer=True)
    axes.margins(x=0)
    figure.legend(
        title=below or None,
        frameon=False,
        loc="outside lower center",
        ncols=n_columns,
        fontsize=_SIZE,
        title_fontsize=_SIZE,
    )
    return figure


def _legend_shape(names: Sequence[str]) -> tuple[int, int]:
    """Return the number of columns that fit into a legend, and the number of lines of the longest."""
    for n_columns in range(min(_MOST, len(names)), 0, -1):
        # As in matplotlib's legends, the first columns have one more name.
        columns = [part.tolist() for part in np.array_split(np.array(names, dtype=object), n_columns)]
        widths = [_HANDLE + max(text_width(name, _SIZE) for name in column) for column in columns]
        if n_columns == 1 or sum(widths) + _APART * (n_columns - 1) <= _INSIDE:
            break
    return n_columns, max(sum(name.count("\n") + 1 for name in column) for column in columns)


@plain
def finals(view: View, yardstick: Yardstick, unit: str = "", comparison: Comparison | None = None) -> Figure:
    """Draw the final value of every run, with box plots; groups that share a letter do not differ.

    The groups are arranged from top to bottom, which leaves space for long names. Groups of fewer than five
    runs have no box (Krzywinski and Altman 2014, Nature Methods 11, 119).

    Args:
        view: The groups.
        yardstick: The measure to draw.
        unit: Unit of the values; meters are shown as millimeters.
        comparison: Comparison of the groups, which provides the letters.
    """
    groups = view.values(yardstick)
    labels = [
        f"{break_lines(name, _NAME, _SIZE)}\n{counted(len(values), 'run', 'runs')}"
        for name, values in groups.items()
    ]
    height = max(0.8, len(groups) * row_height(labels, _ROW))
    figure, axes = _figure(view.title, 0.75 + height)
    rng = np.random.default_rng(0)  # only for the vertical positions of points
    for place, values in enumerate(groups.values()):
        scaled = np.array(values) * unit_factor(unit)
        boxed = len(values) >= FEWEST
        beside = place - (0.2 if boxed else 0.0) + rng.uniform(-0.1, 0.1, len(values))
        colour = COLOURS[place % len(COLOURS)]
        axes.plot(scaled, beside, "o", color=colour, ms=3, mew=0, alpha=0.6)
        if boxed:
            axes.boxplot(
                [scaled],
                positions=[place + 0.18],
                widths=0.28,
                orientation="horizontal",
                showfliers=False,
                medianprops={"color": "black", "lw": 1.5},
            )
    letters = {} if comparison is None else comparison.letters
    for place, name in enumerate(groups):
        axes.annotate(
            letters.get(name, ""),
            (1.0, place),
            xytext=(3, 0),
            xycoords=("axes fraction", "data"),
            textcoords="offset points",
            ha="left",
            va="center",
            size=8,
        )
    axes.locator_params(axis="x", nbins=6)  # with more, long labels would nearly touch
    axes.set_yticks(range(len(groups)), labels)
    axes.set_ylim(len(groups) - 0.5, -0.5)  # the first group at the top
    axes.set(xlabel=axis_title(AXIS_NAMES[yardstick], unit), ylabel=break_lines(view.key, height, 8))
    return figure


@plain
def ranks(comparison: Comparison, title: str) -> Figure:
    """Draw the mean ranks on a line, the best at the right; bars join groups that do not differ.

    Source: critical difference diagrams of Demsar 2006, here with the p-values of the comparison.
    """
    names = [group.name for group in comparison.groups]
    labels = [
        break_lines(f"{group.name}: {group.mean_rank:.3g}", _RANKED, _SIZE) for group in comparison.groups
    ]
    figure, axes = _figure(title, 0.66)
    numbers = range(len(names))  # with names, the figure would depend on their hashes
    p = pd.DataFrame(
        [[1.0 if i == j else comparison.pair(names[i], names[j]).p for j in numbers] for i in numbers]
    )
    drawn = posthocs.critical_difference_diagram(
        {number: comparison.groups[number].mean_rank for number in numbers},
        p,
        ax=axes,
        alpha=comparison.alpha,
        label_fmt_left="{label}",
        label_fmt_right="{label}",
        label_props={"size": _SIZE},
        text_h_margin=0.02 * max(1.0, np.ptp([group.mean_rank for group in comparison.groups])),
        color_palette=["black"] * len(names),
        elbow_props={"lw": 0.9},
        marker_props={"s": 14},
        crossbar_props={"marker": "o", "ms": 4},  # marks the joined groups, not those between them
    )
    for text in drawn["labels"]:
        text.set_text(labels[int(text.get_text())])
        gap = -_GAP if text.get_horizontalalignment() == "right" else _GAP  # keeps the label off its line
        text.set_transform(text.get_transform() + ScaledTranslation(gap, 0, figure.dpi_scale_trans))
    axes.locator_params(axis="x", nbins=5)
    axes.set_xlabel("mean rank (higher is better)")
    axes.xaxis.set_label_position("top")
    height = _spaced(axes, drawn, row_height(labels, _RANKS))
    figure.set_figheight(figure.get_figheight() + height)
    return figure


def _spaced(axes: Axes, drawn: Mapping[str, Any], row: float) -> float:
    """Space out bars and ranks, which start at -1, -2, ..., and return the height that they take."""
    bars = -min((bar.get_ydata()[0] for [bar] in drawn["crossbars"]), default=0)

    def below(levels: NDArray[np.float64]) -> NDArray[np.float64]:
        return -_BARS * np.minimum(levels, bars) - row * np.maximum(levels - bars, 0)

    for line in [*drawn["elbows"], *itertools.chain(*drawn["crossbars"])]:
        line.set_ydata(below(-np.asarray(line.get_ydata(), dtype=np.float64)))
    for text in drawn["labels"]:
        text.set_y(below(-text.get_position()[1]))
    lowest = min(text.get_position()[1] for text in drawn["labels"]) - row / 2
    axes.set_ylim(lowest, 0.08)
    return float(-lowest)


def _figure(title: str, height: float) -> tuple[Figure, Axes]:
    """Return a figure as wide as a column, taller if its title has several lines."""
    above = break_lines(title, _INSIDE, _TITLE)
    figure = Figure(figsize=(COLUMN, height + 0.17 * above.count("\n")), layout="constrained")
    figure.suptitle(above, size=_TITLE)
    axes = figure.add_subplot()
    axes.spines[["top", "right"]].set_visible(False)
    axes.tick_params(labelsize=_SIZE)
    for text in (axes.xaxis.label, axes.yaxis.label):
        text.set_fontsize(8)
    return figure, axes
