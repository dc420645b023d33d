"""Figures show what they are made of."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from evoframe.analysis.figures import curves, finals, title_of
from evoframe.analysis.study_data import YARDSTICKS, StudyData, Yardstick
from evoframe.study.rows import read_rows

ROWS = Path(__file__).parents[2] / "docs" / "results" / "paper" / "rows.csv"
PANEL = {"collaboration.n": "2"}


@pytest.fixture(scope="module")
def data() -> StudyData:
    return StudyData("paper", ("collaboration.n", "aggregator"), "m", 600, tuple(read_rows(ROWS)))


@pytest.mark.parametrize("yardstick", YARDSTICKS)
def test_curves_are_the_means_of_runs_within_their_bands(data: StudyData, yardstick: Yardstick) -> None:
    [axes] = curves(data, PANEL, yardstick).axes
    assert (
        axes.get_ylabel() == {"score": "best pair simulated (mm)", "fitness": "best fitness (mm)"}[yardstick]
    )
    assert axes.get_title() == title_of(PANEL) == "n = 2"
    groups = data.of(PANEL)
    legend = axes.get_legend()
    assert legend is not None
    assert [text.get_text() for text in legend.get_texts()] == ["AM (30)", "WM (30)", "GM (30)", "HM (30)"]
    for line, band, rows in zip(axes.lines, axes.collections, groups.values(), strict=True):
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
    [axes] = finals(data, PANEL, yardstick).axes
    points = [line for line in axes.lines if line.get_marker() == "o"]
    for line, rows in zip(points, data.of(PANEL).values(), strict=True):
        values = sorted(1000 * getattr(row, yardstick) for row in rows)
        assert sorted(np.asarray(line.get_ydata())) == pytest.approx(values)
    assert [text.get_text() for text in axes.texts] == ["a"] * 4
    assert [label.get_text() for label in axes.get_xticklabels()] == [
        f"{name}\n30 runs" for name in ("AM", "WM", "GM", "HM")
    ]
