"""Tests of lines over generations: means, bands, and missing values."""

from __future__ import annotations

import math
from collections.abc import Sequence

import attrs
import numpy as np
import pytest
from scipy import stats

from evoframe.analysis.data.studies import View
from evoframe.analysis.figures.lines import lines_of_view
from evoframe.analysis.figures.studies import curves
from evoframe.analysis.page.charts import lines_chart
from evoframe.study.rows import Row

ROW = Row({"aggregator": "am"}, 0, 1, "", "", 1.0, 1.0, 1.0, 1, 1, 1.0, "")


def view(**groups: Sequence[Sequence[float]]) -> View:
    """Return groups of runs with these curves of the score."""
    rows = {
        name: [attrs.evolve(ROW, score_curve=tuple(c)) for c in curves] for name, curves in groups.items()
    }
    return View("n = 2", "aggregator", rows)


def test_runs_without_curves_are_ignored() -> None:
    [line] = lines_of_view(view(AM=[(1.0, 2.0), (), (3.0, 4.0)]), "score")
    assert line.name == "AM: 2"
    assert line.values.tolist() == [2.0, 3.0]
    [alone] = lines_of_view(view(AM=[(1.0, 2.0), ()]), "score")
    assert (alone.name, alone.band) == ("AM: 1", None)


def test_a_group_without_curves_has_no_line_and_keeps_its_color() -> None:
    [line] = lines_of_view(view(AM=[()], WM=[(1.0, 2.0)]), "score")
    assert (line.name, line.colour) == ("WM: 1", 1)
    assert lines_of_view(view(AM=[()], WM=[()]), "score") == []
    with pytest.raises(ValueError, match="no lines"):
        curves(view(AM=[()]), "score")


def test_a_line_ends_with_the_shortest_run_of_its_group() -> None:
    there = view(short=[(1.0, 2.0), (3.0, 4.0)], long=[(1.0, 2.0, 3.0), (1.0, 2.0, 4.0, 9.0)])
    short, long = lines_of_view(there, "score")
    assert (short.values.tolist(), long.values.tolist()) == ([2.0, 3.0], [1.0, 2.0, 3.5])
    [axes] = curves(there, "score").axes
    assert [len(np.asarray(line.get_xdata())) for line in axes.lines] == [2, 3]


def test_a_missing_score_leaves_a_gap() -> None:
    there = view(AM=[(math.nan, 1.0, 2.0), (1.0, 1.5, 3.0)] * 3, WM=[(math.nan,) * 3] * 5)
    line, nothing = lines_of_view(there, "score")
    assert line.band is not None
    for values in (line.values, *line.band):
        assert np.isnan(values).tolist() == [True, False, False]
    assert np.isnan(nothing.values).all()
    curves(there, "score").draw_without_rendering()
    assert lines_chart([line], "").data[0].y[0] is None


def test_fewer_than_five_runs_have_no_band() -> None:
    four, five = lines_of_view(
        view(AM=[(1.0, 2.0), (2.0, 3.0)] * 2, WM=[(1.0, float(n)) for n in range(5)]), "score"
    )
    assert four.band is None
    assert five.band is not None


def test_batches_of_resamples_give_the_band_of_all_at_once() -> None:
    values = np.random.default_rng(1).normal(size=(7, 11))
    [line] = lines_of_view(view(AM=values.tolist()), "score")
    whole = stats.bootstrap(
        (values,), np.mean, axis=0, n_resamples=2000, method="percentile", rng=np.random.default_rng(0)
    ).confidence_interval
    assert line.band is not None
    assert line.band[0].tobytes() == whole.low.tobytes()
    assert line.band[1].tobytes() == whole.high.tobytes()
