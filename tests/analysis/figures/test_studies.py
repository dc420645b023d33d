"""Tests of figures of studies."""

from __future__ import annotations

from itertools import combinations
from pathlib import Path

import attrs
import numpy as np
import pytest
from hypothesis import assume, given, settings, strategies as st
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.text import Text
from matplotlib.transforms import Bbox
from numpy.typing import NDArray

from evoframe.analysis.data.studies import YARDSTICKS, StudyData, View, Yardstick
from evoframe.analysis.data.units import CURVE_NAMES
from evoframe.analysis.figures.studies import curves, finals, ranks
from evoframe.analysis.statistics.corrections import CORRECTIONS, Correction
from evoframe.analysis.statistics.groups import compare
from evoframe.study.rows import Row, read_rows

ROWS = Path(__file__).parents[3] / "docs" / "results" / "paper" / "rows.csv"
ROW = Row({}, 0, 1, "", "", 1.0, 1.0, 1.0, 1, 1, 1.0, "")


@pytest.fixture(scope="module")
def data() -> StudyData:
    rows = tuple(row for row in read_rows(ROWS) if row.settings["collaboration.n"] == "2")
    return StudyData("paper", ("collaboration.n", "aggregator"), "m", 600, rows)


@pytest.mark.parametrize("yardstick", YARDSTICKS)
def test_curves_are_the_means_of_runs_within_their_bands(data: StudyData, yardstick: Yardstick) -> None:
    [view] = data.views(yardstick)
    figure = curves(view, yardstick, data.unit)
    [axes], [legend] = figure.axes, figure.legends
    assert axes.get_ylabel() == f"{CURVE_NAMES[yardstick]} (mm)"
    assert figure.get_suptitle() == view.title == "n = 2"
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
def test_all_final_values_are_shown_with_letters(data: StudyData, yardstick: Yardstick) -> None:
    [view] = data.views(yardstick)
    [axes] = finals(view, yardstick, data.unit, compare(view.values(yardstick))).axes
    points = [line for line in axes.lines if line.get_marker() == "o"]
    for line, rows in zip(points, view.groups.values(), strict=True):
        values = sorted(1000 * getattr(row, yardstick) for row in rows)
        assert sorted(np.asarray(line.get_xdata())) == pytest.approx(values)
    assert [text.get_text() for text in axes.texts] == ["a"] * 4
    assert [label.get_text() for label in axes.get_yticklabels()] == [
        f"{name}\n30 runs" for name in ("AM", "WM", "GM", "HM")
    ]


def test_ranks_name_all_groups(data: StudyData) -> None:
    [view] = data.views("score")
    comparison = compare(view.values("score"))
    [axes] = ranks(comparison, view.title).axes
    shown = " ".join(text.get_text() for text in axes.texts)
    assert all(name in shown for name in view.groups)


@settings(max_examples=30)
@given(
    st.lists(st.lists(st.integers(0, 12).map(float), min_size=4, max_size=9), min_size=2, max_size=7),
    st.sampled_from(CORRECTIONS),
)
def test_bars_join_groups_if_and_only_if_no_pair_of_them_differs(
    values: list[list[float]], correction: Correction
) -> None:
    # Without ties of mean ranks, the ends of a bar identify the groups that it joins.
    comparison = compare({f"group {number}": each for number, each in enumerate(values)}, correction)
    place = {group.name: group.mean_rank for group in comparison.groups}
    assume(len(set(place.values())) == len(place))
    [axes] = ranks(comparison, "").axes
    bars = [np.asarray(line.get_xdata()) for line in axes.lines if line.get_linewidth() == 2]
    joined = {frozenset((a, b)) for bar in bars for a, b in combinations(bar.tolist(), 2)}
    alike = {
        frozenset((place[pair.first], place[pair.second]))
        for pair in comparison.pairs
        if pair.p >= comparison.alpha
    }
    assert joined == alike


NAMES_OF_GROUPS = {
    "short": "AM{}",
    "usual": "WM (n = {})",
    "table": '{{"name": "toy-steered", "gain": {}.0, "most": 1000000000.0, "least": -1000000000.0}}',
    "word": "anUnbrokenNameThatIsMuchTooLongForAnyFigure{}",
    "endless": "a very long name of a group {0} " * 30,
}


def made_up(kind: str, count: int) -> View:
    """Return a view of *count* groups of six runs."""
    rng = np.random.default_rng(count)
    groups = {}
    for number in range(count):
        curves = np.cumsum(rng.gamma(0.5, 1e-4, (6, 5)), axis=1).tolist()
        groups[NAMES_OF_GROUPS[kind].format(number)] = [
            attrs.evolve(ROW, score=curve[-1], score_curve=tuple(curve)) for curve in curves
        ]
    title = NAMES_OF_GROUPS[kind].format("")
    return View(f"simulator = {title}, n = 2", "aggregator" if kind != "endless" else "endless" * 4, groups)


@pytest.mark.parametrize("kind", NAMES_OF_GROUPS)
@pytest.mark.parametrize("count", [1, 2, 4, 10, 20])
def test_nothing_is_clipped_and_no_texts_overlap(kind: str, count: int) -> None:
    view = made_up(kind, count)
    comparison = compare(view.values("score")) if count > 1 else None
    figures = [curves(view, "score", "m"), finals(view, "score", "m", comparison)]
    figures += [ranks(comparison, view.title)] if comparison else []
    for figure in figures:
        boxes = boxes_of_texts(figure)
        assert figure.get_figwidth() == 3.5
        for box in boxes:
            assert box.x0 >= 0
            assert box.y0 >= 0
            assert box.x1 <= figure.bbox.width
            assert box.y1 <= figure.bbox.height
        for one, other in combinations(boxes, 2):
            across = min(one.x1, other.x1) - max(one.x0, other.x0)
            along = min(one.y1, other.y1) - max(one.y0, other.y0)
            assert min(across, along) <= 0


def boxes_of_texts(figure: Figure) -> list[Bbox]:
    """Return the extents of all visible texts."""
    canvas = FigureCanvasAgg(figure)
    canvas.draw()  # type: ignore[no-untyped-call]
    renderer = canvas.get_renderer()  # type: ignore[no-untyped-call]
    texts = [text for text in figure.findobj(Text) if isinstance(text, Text)]
    shown = [text for text in texts if text.get_visible() and text.get_text().strip()]
    ticks = hidden_ticks(figure.axes[0])
    return [text.get_window_extent(renderer) for text in shown if text not in ticks]


def hidden_ticks(axes: Axes) -> set[Text]:
    """Return the labels of ticks outside of the axes, and of invisible axes."""
    hidden: set[Text] = set()
    for axis in (axes.xaxis, axes.yaxis):
        low, high = sorted(axis.get_view_interval())
        for tick in [*axis.get_major_ticks(), *axis.get_minor_ticks()]:
            if not (axis.get_visible() and low <= tick.get_loc() <= high):
                hidden |= {tick.label1, tick.label2}
    return hidden


def test_up_to_28_lines_differ() -> None:
    [axes] = curves(made_up("short", 28), "score").axes
    styles = {(line.get_color(), str(line.__dict__["_unscaled_dash_pattern"])) for line in axes.lines}
    assert len(styles) == 28


def test_the_best_of_each_view_are_compared_too(data: StudyData) -> None:
    moved = [
        attrs.evolve(
            row,
            settings={**row.settings, "collaboration.n": "3"},
            score=row.score + (row.settings["aggregator"] == "am"),
        )
        for row in data.rows
    ]
    both = attrs.evolve(data, rows=(*data.rows, *moved))
    *views, best = both.views("score")
    assert [view.title for view in views] == ["n = 2", "n = 3"]
    assert best.title == "best of each"
    assert list(best.groups) == ["HM (n = 2)", "AM (n = 3)"]  # the best of each view
