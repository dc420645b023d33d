"""Charts of a page, to be looked at closely: the interactive counterparts of the figures."""

from __future__ import annotations

import math
from collections.abc import Sequence
from html import escape

import numpy as np
from numpy.typing import NDArray
from plotly.graph_objects import Box, Figure, Scatter

from evoframe.analysis.lines import Line
from evoframe.analysis.study_data import View, Yardstick
from evoframe.analysis.units import NAMES, axis_title, factor_of

__all__ = ["finals_chart", "lines_chart"]

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
                name=escape(line.name, quote=False),
                mode="lines",
                line_dash=_DASHES[line.dash % len(_DASHES)],
                legendgroup=line.name,
                meta=colour,
            )
        )
    return _arranged(Figure(traces), "generation", label)


def finals_chart(view: View, yardstick: Yardstick, unit: str = "") -> Figure:
    """Return every run's final value beside a box plot of its group.

    Args:
        view: The groups.
        yardstick: What is drawn.
        unit: Of scores; metres are shown as millimetres.
    """
    traces = [
        Box(
            y=_told(np.array(values) * factor_of(unit)),
            name=escape(f"{name}: {len(values)}", quote=False),
            boxpoints="all",
            jitter=0.5,
            pointpos=-1.6,
            marker_size=4,
            meta={"colour": number},
        )
        for number, (name, values) in enumerate(view.values(yardstick).items())
    ]
    plot = _arranged(Figure(traces), f"{view.key}: runs", axis_title(NAMES[yardstick], unit))
    return plot.update_layout(showlegend=False, hovermode="closest")


def _arranged(plot: Figure, x: str, y: str) -> Figure:
    return plot.update_layout(
        template=None,
        xaxis={"title": {"text": escape(x, quote=False)}},  # plotly reads some HTML
        yaxis={"title": {"text": escape(y, quote=False)}},
        margin={"l": 60, "r": 10, "t": 10, "b": 50},
        hovermode="x unified",
        legend={"orientation": "h", "y": -0.25, "yanchor": "top"},
    )


def _told(values: NDArray[np.float64]) -> list[float | None]:
    """Return values with the digits that a chart shows; a gap where there is none."""
    return [None if math.isnan(value) else float(f"{value:.7g}") for value in values.tolist()]
