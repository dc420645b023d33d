"""Figures show what they are made of."""

from __future__ import annotations

from pathlib import Path

import attrs
import numpy as np
import pytest
from numpy.typing import NDArray

from evoframe.analysis.figures import curves, finals, ranks
from evoframe.analysis.statistics import compare
from evoframe.analysis.study_data import YARDSTICKS, StudyData, Yardstick
from evoframe.analysis.units import NAMES
from evoframe.study.rows import read_rows

ROWS = Path(__file__).parents[2] / "docs" / "results" / "paper" / "rows.csv"


@pytest.fixture(scope="module")
def data() -> StudyData:
    rows = tuple(row for row in read_rows(ROWS) if row.settings["collaboration.n"] == "2")
    return StudyData("paper", ("collaboration.n", "aggregator"), "m", 600, rows)


@pytest.mark.parametrize("yardstick", YARDSTICKS)
def test_curves_are_the_means_of_runs_within_their_bands(data: StudyData, yardstick: Yardstick) -> None:
    [view] = data.views(yardstick)
    figure = curves(view, yardstick, data.unit)
    [axes], [legend] = figure.axes, figure.legends
    assert axes.get_ylabel() == f"{NAMES[yardstick]} (mm)"
    assert axes.get_title() == view.title == "n = 2"
    assert [text.get_text() for text in legend.get_texts()] == ["AM: 30", "WM: 30", "GM: 30", "HM: 30"]
    for line, band, rows in zip(axes.lines, axes.collections, view.groups.values(), strict=True):
        drawn = np.array([getattr(row, f"{yardstick}_curve") for row in rows])
        assert np.asarray(line.get_ydata()) == pytest.approx(1000 * drawn.mean(axis=0))
        low, high = _edges(np.asarray(band.get_paths()[0].vertices), at=200)
        assert low < 1000 * drawn[:, -1].mean() < high
        assert high - low < 1000 * np.ptp(drawn[:, -1])
    assert len({(line.get_color(), str(line.get_linestyle())) for line in axes.lines}) == 4


def _edges(vertices: NDArray[np.float64], at: int) -> tuple[float, float]:
    there = vertices[vertices[:, 0] == at, 1]
    return float(there.min()), float(there.max())


@pytest.mark.parametrize("yardstick", YARDSTICKS)
def test_final_values_are_all_there_with_their_letters(data: StudyData, yardstick: Yardstick) -> None:
    [view] = data.views(yardstick)
    [axes] = finals(view, yardstick, data.unit, compare(view.values(yardstick))).axes
    points = [line for line in axes.lines if line.get_marker() == "o"]
    for line, rows in zip(points, view.groups.values(), strict=True):
        values = sorted(1000 * getattr(row, yardstick) for row in rows)
        assert sorted(np.asarray(line.get_ydata())) == pytest.approx(values)
    assert [text.get_text() for text in axes.texts] == ["a"] * 4
    assert [label.get_text() for label in axes.get_xticklabels()] == [
        f"{name}\n30 runs" for name in ("AM", "WM", "GM", "HM")
    ]


def test_ranks_name_all_groups(data: StudyData) -> None:
    [view] = data.views("score")
    comparison = compare(view.values("score"))
    [axes] = ranks(comparison, view.title).axes
    shown = " ".join(text.get_text() for text in axes.texts)
    assert all(name in shown for name in view.groups)
    assert sum(group.mean_rank for group in comparison.groups) == pytest.approx(4 * 121 / 2 / 1)


def test_the_best_of_each_view_are_compared_too(data: StudyData) -> None:
    moved = [
        attrs.evolve(
            row,
            settings={**row.settings, "collaboration.n": "3"},
            score=row.score + (row.settings["aggregator"] == "hm"),
        )
        for row in data.rows
    ]
    both = attrs.evolve(data, rows=(*data.rows, *moved))
    *views, best = both.views("score")
    assert [view.title for view in views] == ["n = 2", "n = 3"]
    assert best.title == "best of each"
    assert list(best.groups) == ["GM (n = 2)", "HM (n = 3)"]
