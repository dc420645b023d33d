"""Figures of a study, fit for an article: matplotlib figures, to be changed or saved by whoever asks.

The colours are those of Okabe and Ito (2008), which people who do not see all colours tell apart; lines
differ in their dashes too.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray
from scipy import stats

from evoframe.analysis.statistics import Comparison, compare
from evoframe.analysis.study_data import StudyData, Yardstick
from evoframe.study.rows import Row

__all__ = ["NAMES", "called", "curves", "final_values", "finals", "title_of"]

COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000", "#F0E442")
DASHES = ("-", (0, (5, 1.5)), (0, (1, 1)), (0, (5, 1.5, 1, 1.5)))
NAMES: Mapping[Yardstick, str] = {"score": "best pair simulated", "fitness": "best fitness"}

_WIDTH = 3.5  # inches: a column of an article
_RESAMPLES = 2000


def curves(data: StudyData, panel: dict[str, str], yardstick: Yardstick) -> Figure:
    """Return the mean over runs for each generation, with its 95 % band (bootstrap over runs).

    Args:
        data: The study.
        panel: Which of :attr:`~evoframe.analysis.study_data.StudyData.panels`.
        yardstick: What is drawn.
    """
    figure, axes = _figure()
    for number, (value, rows) in enumerate(data.of(panel).items()):
        drawn = np.array([getattr(row, f"{yardstick}_curve") for row in rows]) * _factor(data.unit)
        generations = np.arange(drawn.shape[1])
        style: dict[str, Any] = {"color": COLOURS[number % 8], "linestyle": DASHES[number % 4], "lw": 1.2}
        axes.plot(generations, drawn.mean(axis=0), label=f"{called(value)} ({len(rows)})", **style)
        if len(rows) > 1:
            axes.fill_between(generations, *_band(drawn), color=style["color"], alpha=0.18, lw=0)
    axes.set(xlabel="generation", ylabel=_label(yardstick, data.unit))
    axes.set_title(title_of(panel), size=9)
    axes.legend(title=f"{_key(data)} (runs)", frameon=False, loc="lower right", fontsize=7, title_fontsize=7)
    axes.margins(x=0)
    return figure


def finals(data: StudyData, panel: dict[str, str], yardstick: Yardstick) -> Figure:
    """Return every run's final value, with box plots, and letters: what shares one is not different.

    Args:
        data: The study.
        panel: Which of :attr:`~evoframe.analysis.study_data.StudyData.panels`.
        yardstick: What is drawn.
    """
    figure, axes = _figure()
    groups = final_values(data.of(panel), yardstick)
    scaled = [np.array(values) * _factor(data.unit) for values in groups.values()]
    places = np.arange(1, len(groups) + 1)
    boxes = axes.boxplot(
        scaled,
        positions=places + 0.18,
        widths=0.28,
        showfliers=False,
        medianprops={"color": "black", "lw": 1.5},
    )
    del boxes
    rng = np.random.default_rng(0)  # of the places of points, nothing else
    for number, (place, values) in enumerate(zip(places, scaled, strict=True)):
        beside = place - 0.18 + rng.uniform(-0.1, 0.1, len(values))
        axes.plot(beside, values, "o", color=COLOURS[number % 8], ms=3, mew=0, alpha=0.6)
    if len(groups) > 1:
        _letter(axes, compare(groups), list(groups))
    labels = [f"{name}\n{len(values)} runs" for name, values in groups.items()]
    axes.set_xticks(places, labels)
    axes.set(xlabel=_key(data), ylabel=_label(yardstick, data.unit), xlim=(0.5, len(groups) + 0.5))
    axes.set_title(title_of(panel), size=9, pad=12)  # the letters are below it
    return figure


def final_values(rows: Mapping[str, Sequence[Row]], yardstick: Yardstick) -> dict[str, list[float]]:
    """Return the final values of each group of runs, by what it is called."""
    return {called(value): [getattr(row, yardstick) for row in group] for value, group in rows.items()}


def title_of(panel: Mapping[str, str]) -> str:
    """Return what a panel is called: ``n = 2``."""
    return ", ".join(f"{key.rsplit('.', 1)[-1]} = {value}" for key, value in panel.items())


def _figure() -> tuple[Figure, Axes]:
    figure = Figure(figsize=(_WIDTH, 2.6), layout="constrained")
    axes = figure.add_subplot()
    axes.spines[["top", "right"]].set_visible(False)
    axes.tick_params(labelsize=7)
    for text in (axes.xaxis.label, axes.yaxis.label):
        text.set_fontsize(8)
    return figure, axes


def _band(drawn: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return the 95 % interval of the mean of each column."""
    if np.ptp(drawn, axis=0).max() == 0:
        return drawn[0], drawn[0]
    found = stats.bootstrap(
        (drawn,), np.mean, axis=0, n_resamples=_RESAMPLES, method="percentile", rng=np.random.default_rng(0)
    )
    return found.confidence_interval.low, found.confidence_interval.high


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


def _factor(unit: str) -> float:
    return 1000.0 if unit == "m" else 1.0  # displacements are millimetres


def _label(yardstick: Yardstick, unit: str) -> str:
    shown = {"m": " (mm)", "": ""}.get(unit, f" ({unit})")
    return f"{NAMES[yardstick]}{shown}"


def _key(data: StudyData) -> str:
    return data.keys[-1].rsplit(".", 1)[-1]


def called(value: str) -> str:
    """Return what a value of the grid is called in an article."""
    return value.upper() if len(value) == 2 else value  # AM, as the paper writes it
