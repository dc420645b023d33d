"""What develops over the generations of a run, or of many, as lines to be drawn."""

from __future__ import annotations

import attrs
import numpy as np
from numpy.typing import NDArray
from scipy import stats

from evoframe.analysis.data.studies import View, Yardstick
from evoframe.analysis.data.units import CURVE_NAMES, factor_of
from evoframe.analysis.statistics.groups import FEWEST
from evoframe.record import Run
from evoframe.study import score_curve

__all__ = ["Line", "lines_of_run", "lines_of_view"]

_RESAMPLES = 2000
_BATCH = 100  # of them at a time: all would need gigabytes for many runs, and give the same
_BLACK, _DOTTED = 6, 2

Floats = NDArray[np.float64]


@attrs.frozen(eq=False)
class Line:
    """A value for each generation, from 0 up.

    Attributes:
        name: What a legend calls it.
        values: ``float64[generations]``, as they are shown.
        colour: Which of the colours it has.
        dash: Which of the dashes it has.
        band: The least and the greatest values that are probable, ``float64[generations]`` each.
    """

    name: str
    values: Floats
    colour: int
    dash: int
    band: tuple[Floats, Floats] | None = None


def lines_of_view(view: View, yardstick: Yardstick, unit: str = "") -> list[Line]:
    """Return the mean over the runs of each group, with its 95 % band (bootstrap over runs).

    Groups of fewer than five runs have no band: it would be much too narrow. Imported rows may have no
    curves: they do not count, and a group of nothing else has no line. Where the runs of a group are of
    different lengths, its line ends with the shortest: means of fewer would jump.

    Args:
        view: The groups.
        yardstick: What is drawn.
        unit: Of scores; metres become millimetres.
    """
    drawn = []
    for number, (name, rows) in enumerate(view.groups.items()):
        found = [curve for row in rows if (curve := getattr(row, f"{yardstick}_curve"))]
        length = min(map(len, found), default=0)
        curves = np.array([curve[:length] for curve in found], dtype=np.float64) * factor_of(unit)
        if curves.size:
            band = _band(curves) if len(curves) >= FEWEST else None
            drawn.append(Line(f"{name}: {len(curves)}", curves.mean(axis=0), number, number, band))
    return drawn


def lines_of_run(run: Run, unit: str = "") -> list[Line]:
    """Return the score of the best pair so far, and of each population the best and the mean fitness.

    Args:
        run: The run, finished or not.
        unit: Of scores; metres become millimetres.
    """
    turns, factor = run.turns(), factor_of(unit)
    populations = list(run.config["populations"])
    drawn = []
    for number, population in enumerate(populations):
        rows = [row for row in turns if row["population"] == population]
        for dash, what in enumerate(("best", "mean")):
            values = np.array([row[what] for row in rows]) * factor
            drawn.append(Line(f"{population}: {what} fitness", values, number, dash))
    score = np.array(score_curve(run, len(populations))) * factor
    return [
        *drawn,
        Line(CURVE_NAMES["score"], score, _BLACK, _DOTTED),
    ]  # on top: the best fitness is hardly less


def _band(curves: Floats) -> tuple[Floats, Floats]:
    """Return the 95 % interval of the mean of each column; a gap where a run has no value."""
    known = np.isfinite(curves).all(axis=0)
    low = np.where(known, curves[0], np.nan)
    high = low.copy()
    given = curves[:, known]
    if given.size and np.ptp(given, axis=0).max() > 0:
        found = stats.bootstrap(
            (given,),
            np.mean,
            axis=0,
            n_resamples=_RESAMPLES,
            batch=_BATCH,
            method="percentile",
            rng=np.random.default_rng(0),
        ).confidence_interval
        low[known], high[known] = found.low, found.high
    return low, high
