"""Charts of a page: the interactive counterparts of the figures."""

from __future__ import annotations

import math
import textwrap
from collections.abc import Sequence
from html import escape
from typing import Any

import numpy as np
from matplotlib.cbook import boxplot_stats
from numpy.typing import NDArray
from plotly.graph_objects import Box, Figure, Scatter

from evoframe.analysis.data.studies import View, Yardstick
from evoframe.analysis.data.units import AXIS_NAMES, axis_title
from evoframe.analysis.figures.lines import Line
from evoframe.analysis.statistics.groups import FEWEST
from evoframe.messages import unit_factor

__all__ = ["finals_chart", "lines_chart"]

_FEW = 10  # generations
_LINE = 22  # characters per line of a name
_BOX = {"q1": "q1", "median": "med", "q3": "q3", "lowerfence": "whislo", "upperfence": "whishi"}
_DASHES = ("solid", "dash", "dot", "dashdot")


def lines_chart(drawn: Sequence[Line], label: str) -> Figure:
    """Return a chart of lines over generations, with their bands.

    Args:
        drawn: The lines.
        label: Title of the vertical axis.
    """
    traces = []
    for line in drawn:
        # The page builds its own legend from "label": one of plotly scrolls in a small box on phones.
        shared: dict[str, Any] = {
            "meta": {"color": line.colour, "label": line.name},
            "legendgroup": line.name,
        }
        generations = np.arange(len(line.values))
        if line.band is not None:
            low, high = line.band
            outline = np.concatenate([high, low[::-1]])
            there_and_back = np.concatenate([generations, generations[::-1]])
            traces.append(
                Scatter(
                    x=there_and_back.tolist(),
                    y=_shortened(outline),
                    fill="toself",
                    line_width=0,
                    mode="lines",
                    hoverinfo="skip",
                    showlegend=False,
                    **shared,
                )
            )
        traces.append(
            Scatter(
                x=generations.tolist(),
                y=_shortened(line.values),
                name=_wrapped(line.name),
                mode="lines",
                line_dash=_DASHES[line.dash % len(_DASHES)],
                **shared,
            )
        )
    plot = _with_layout(Figure(traces), "generation", label)
    if max((len(line.values) for line in drawn), default=0) <= _FEW:
        plot.update_xaxes(dtick=1)  # plotly would add ticks at half generations
    return plot


def finals_chart(view: View, yardstick: Yardstick, unit: str = "") -> Figure:
    """Return a chart of every run's final value beside a box plot of its group.

    Args:
        view: The groups.
        yardstick: The compared value: score or fitness.
        unit: Unit of scores; meters are shown as millimeters.
    """
    traces = []
    for number, (name, values) in enumerate(view.values(yardstick).items()):
        scaled, called = np.array(values) * unit_factor(unit), _wrapped(f"{name}: {len(values)}")
        if len(values) < FEWEST:
            points = {"mode": "markers", "marker_size": 6}
            trace = Scatter(x=[called] * len(values), y=_shortened(scaled), name=called, **points)
        else:
            # Quartiles as in the figures; plotly computes them differently.
            [box] = boxplot_stats(scaled)
            own = {key: _shortened(np.array([box[other]])) for key, other in _BOX.items()}
            points = {"boxpoints": "all", "jitter": 0.5, "pointpos": -1.6, "marker_size": 4}
            trace = Box(x=[called], y=[_shortened(scaled)], name=called, **points, **own)
        traces.append(trace.update(meta={"color": number}))
    plot = _with_layout(Figure(traces), f"{view.key}: runs", axis_title(AXIS_NAMES[yardstick], unit))
    plot.update_xaxes(range=[-0.7, len(traces) - 0.5])  # keeps points off the edges
    return plot.update_layout(showlegend=False, hovermode="closest")


def _with_layout(plot: Figure, x: str, y: str) -> Figure:
    return plot.update_layout(
        template=None,
        xaxis={"title": {"text": escape(x, quote=False)}},  # plotly interprets some HTML
        yaxis={"title": {"text": escape(y, quote=False)}},
        margin={"l": 60, "r": 10, "t": 10, "b": 50},
        hovermode="x unified",
    )


def _wrapped(text: str) -> str:
    """Return a name for plotly, which interprets some HTML: escaped, in lines short enough for a phone."""
    return "<br>".join(escape(line, quote=False) for line in textwrap.wrap(text, _LINE))


def _shortened(values: NDArray[np.float64]) -> list[float | None]:
    """Return values with seven significant digits, and ``None``, a gap, for NaN."""
    return [None if math.isnan(value) else float(f"{value:.7g}") for value in values.tolist()]
