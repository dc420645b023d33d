"""Lines over the generations of a run, or of the runs of a study."""

from __future__ import annotations

import attrs
import numpy as np
from numpy.typing import NDArray
from scipy import stats

from evoframe.analysis.data.studies import View, Yardstick
from evoframe.analysis.data.units import CURVE_NAMES
from evoframe.analysis.statistics.groups import FEWEST
from evoframe.messages import unit_factor
from evoframe.record import Run
from evoframe.study import score_curve

__all__ = ["Line", "lines_of_run", "lines_of_view"]

_RESAMPLES = 2000
_BATCH = 100  # resamples at a time; all at once would take gigabytes, with the same result
_BLACK, _DOTTED = 6, 2

Floats = NDArray[np.float64]


@attrs.frozen(eq=False)
class Line:
    """A value for each generation, from 0 up.

    Attributes:
        name: Name in the legend.
        values: ``float64[generations]``, in the shown unit.
        colour: Index of the color.
        dash: Index of the dash pattern.
        band: Lower and upper bound of the confidence band, ``float64[generations]`` each.
    """

    name: str
    values: Floats
    colour: int
    dash: int
    band: tuple[Floats, Floats] | None = None


def lines_of_view(view: View, yardstick: Yardstick, unit: str = "") -> list[Line]:
    """Return the mean over the runs of each group, with its 95 % band (bootstrap over runs).

    Groups of fewer than five runs have no band, because it would be much too narrow. Runs without curves,
    such as imported rows, are ignored; a group that has only such runs has no line. The line of a group ends
    with its shortest run, because means of fewer runs would jump.

    Args:
        view: The groups.
        yardstick: The measure to draw.
        unit: Unit of the values; meters become millimeters.
    """
    drawn = []
    for number, (name, rows) in enumerate(view.groups.items()):
        found = [curve for row in rows if (curve := getattr(row, f"{yardstick}_curve"))]
        length = min(map(len, found), default=0)
        curves = np.array([curve[:length] for curve in found], dtype=np.float64) * unit_factor(unit)
        if curves.size:
            band = _band(curves) if len(curves) >= FEWEST else None
            drawn.append(Line(f"{name}: {len(curves)}", curves.mean(axis=0), number, number, band))
    return drawn


def lines_of_run(run: Run, unit: str = "") -> list[Line]:
    """Return the score of the best pair so far, and the best and mean fitness of each population.

    Args:
        run: The run, finished or not.
        unit: Unit of the values; meters become millimeters.
    """
    turns, factor = run.turns(), unit_factor(unit)
    populations = list(run.config["populations"])
    drawn = []
    for number, population in enumerate(populations):
        rows = [row for row in turns if row["population"] == population]
        for dash, what in enumerate(("best", "mean")):
            values = np.array([row[what] for row in rows]) * factor
            drawn.append(Line(f"{population}: {what} fitness", values, number, dash))
    score = np.array(score_curve(run)) * factor
    return [
        *drawn,
        Line(CURVE_NAMES["score"], score, _BLACK, _DOTTED),
    ]  # drawn last, because the best fitness is almost as high


def _band(curves: Floats) -> tuple[Floats, Floats]:
    """Return the 95 % interval of the mean of each column; NaN if a run has no value there."""
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
