"""Charts of a page, to be looked at closely: the interactive counterparts of the figures."""

from __future__ import annotations

import math
import textwrap
from collections.abc import Sequence
from html import escape

import numpy as np
from matplotlib.cbook import boxplot_stats
from numpy.typing import NDArray
from plotly.graph_objects import Box, Figure, Scatter

from evoframe.analysis.data.studies import View, Yardstick
from evoframe.analysis.data.units import NAMES, axis_title, factor_of
from evoframe.analysis.figures.lines import Line
from evoframe.analysis.statistics.groups import FEWEST

__all__ = ["finals_chart", "lines_chart"]

_FEW = 10  # generations
_LINE = 22  # characters of a name
_BOX = {"q1": "q1", "median": "med", "q3": "q3", "lowerfence": "whislo", "upperfence": "whishi"}
_DASHES = ("solid", "dash", "dot", "dashdot")


def lines_chart(drawn: Sequence[Line], label: str) -> Figure:
    """Return lines over generations, with their bands.

    Args:
        drawn: What is drawn.
        label: Of the vertical axis.
    """
    traces = []
    for line in drawn:
        colour = {"colour": line.colour}
        generations = np.arange(len(line.values))
        if line.band is not None:
            low, high = line.band
            around = np.concatenate([high, low[::-1]])
            there = np.concatenate([generations, generations[::-1]])
            traces.append(
                Scatter(
                    x=there.tolist(),
                    y=_told(around),
                    fill="toself",
                    line_width=0,
                    mode="lines",
                    hoverinfo="skip",
                    showlegend=False,
                    legendgroup=line.name,
                    meta=colour,
                )
            )
        traces.append(
            Scatter(
                x=generations.tolist(),
                y=_told(line.values),
                name=_name(line.name),
                mode="lines",
                line_dash=_DASHES[line.dash % len(_DASHES)],
                legendgroup=line.name,
                meta=colour,
            )
        )
    plot = _arranged(Figure(traces), "generation", label)
    if max((len(line.values) for line in drawn), default=0) <= _FEW:
        plot.update_xaxes(dtick=1)  # else there are halves of generations
    return plot


def finals_chart(view: View, yardstick: Yardstick, unit: str = "") -> Figure:
    """Return every run's final value beside a box plot of its group.

    Args:
        view: The groups.
        yardstick: What is drawn.
        unit: Of scores; metres are shown as millimetres.
    """
    traces = []
    for number, (name, values) in enumerate(view.values(yardstick).items()):
        scaled, called = np.array(values) * factor_of(unit), _name(f"{name}: {len(values)}")
        if len(values) < FEWEST:
            points = {"mode": "markers", "marker_size": 6}
            trace = Scatter(x=[called] * len(values), y=_told(scaled), name=called, **points)
        else:
            [box] = boxplot_stats(scaled)  # that of figures: plotly reckons quartiles otherwise
            own = {key: _told(np.array([box[other]])) for key, other in _BOX.items()}
            points = {"boxpoints": "all", "jitter": 0.5, "pointpos": -1.6, "marker_size": 4}
            trace = Box(x=[called], y=[_told(scaled)], name=called, **points, **own)
        traces.append(trace.update(meta={"colour": number}))
    plot = _arranged(Figure(traces), f"{view.key}: runs", axis_title(NAMES[yardstick], unit))
    plot.update_xaxes(range=[-0.7, len(traces) - 0.5])  # points would lie at the edges
    return plot.update_layout(showlegend=False, hovermode="closest")


def _arranged(plot: Figure, x: str, y: str) -> Figure:
    return plot.update_layout(
        template=None,
        xaxis={"title": {"text": escape(x, quote=False)}},  # plotly reads some HTML
        yaxis={"title": {"text": escape(y, quote=False)}},
        margin={"l": 60, "r": 10, "t": 10, "b": 50},
        hovermode="x unified",
        legend={"orientation": "h", "yref": "container", "y": 0, "yanchor": "bottom"},
    )


def _name(text: str) -> str:
    """Return a name as plotly reads it, which knows some HTML: in lines that have room on a phone."""
    return "<br>".join(escape(line, quote=False) for line in textwrap.wrap(text, _LINE))


def _told(values: NDArray[np.float64]) -> list[float | None]:
    """Return values with the digits that a chart shows; a gap where there is none."""
    return [None if math.isnan(value) else float(f"{value:.7g}") for value in values.tolist()]
