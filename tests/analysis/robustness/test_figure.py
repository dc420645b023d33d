"""Tests of the figure: extremes, quartiles, medians and divergences of every group."""

from __future__ import annotations

from itertools import pairwise

import attrs
import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.figure import Figure
from measuring import measure

from evoframe import Robustness
from evoframe.analysis.robustness import violins


def named(measured: Robustness, names: list[str]) -> Robustness:
    """Return a measurement with these names of groups."""
    setting = measured.setting
    bodies = [attrs.evolve(b, group=name) for b, name in zip(setting.bodies, names, strict=True)]
    return attrs.evolve(measured, setting=attrs.evolve(setting, bodies=tuple(bodies)))


def labels(figure: Figure) -> list[str]:
    [axes] = figure.axes
    return [label.get_text() for label in axes.get_yticklabels()]


def lines_at(axes: Axes, place: int) -> list[list[float]]:
    """Return the ends of all horizontal lines of a group, along the axis of values."""
    found = [(np.asarray(line.get_xdata()), np.asarray(line.get_ydata())) for line in axes.lines]
    return [x.tolist() for x, y in found if len(x) == 2 and (y == place).all()]


def densities(axes: Axes) -> list[PolyCollection]:
    return [found for found in axes.collections if isinstance(found, PolyCollection)]


def extremes_at(axes: Axes, place: int) -> list[float]:
    """Return the ends of the line between the extremes of a group."""
    lines = [found for found in axes.collections if isinstance(found, LineCollection)]
    segments = [np.asarray(segment) for line in lines for segment in line.get_segments()]
    [found] = [segment[:, 0].tolist() for segment in segments if (segment[:, 1] == place).all()]
    return found  # type: ignore[no-any-return]


def title(figure: Figure) -> str:
    text = figure.get_suptitle()
    assert isinstance(text, str)
    return text


def test_each_group_has_extremes_quartiles_and_median_in_millimeters() -> None:
    measured = measure([1.0, 3.0, 2.0], 50, unit="m")
    figure = violins(measured)
    [axes] = figure.axes
    assert axes.get_xlabel() == "score (mm)"
    assert labels(figure) == ["A", "B", "C"]
    assert len(densities(axes)) == 3
    for place in range(3):
        values = 1000 * measured.scores[:, place]
        first, middle, third = np.quantile(values, [0.25, 0.5, 0.75])
        assert lines_at(axes, place) == [pytest.approx([first, third])]
        assert extremes_at(axes, place) == pytest.approx([values.min(), values.max()])
        [dot] = [line for line in axes.lines if line.get_marker() == "o" and line.get_ydata() == [place]]
        assert dot.get_xdata() == pytest.approx([middle])
    assert title(figure) == "50 random controllers\nthe same for all 3 bodies"
    assert len({line.get_color() for line in axes.lines}) > 3


def test_each_of_several_bodies_of_a_group_has_a_tick() -> None:
    measured = measure([1.0, 3.0, 2.0], 50, groups="XXY")
    figure = violins(measured)
    [axes] = figure.axes
    assert labels(figure) == ["X\n2 bodies", "Y"]
    [ticks] = [line for line in axes.lines if line.get_marker() == "|"]
    assert np.asarray(ticks.get_xdata()) == pytest.approx(np.median(measured.scores[:, :2], axis=0))
    assert axes.get_xlabel() == "score"


def test_divergences_are_counted_and_not_drawn() -> None:
    measured = measure([1.0, 3.0], 50, most=1.5)
    lost = len(measured.diverged)
    figure = violins(measured)
    assert labels(figure) == ["A", f"B\n{lost} of 50 diverged"]
    assert extremes_at(figure.axes[0], 1)[1] == pytest.approx(measured.values([1]).max())
    nothing = violins(measure([1.0], 5, most=-9.0))
    assert labels(nothing) == ["A\n5 of 5 diverged"]
    assert not nothing.axes[0].collections


def test_a_single_value_has_a_median_but_no_density() -> None:
    figure = violins(measure([1.0], 1))
    [axes] = figure.axes
    assert not axes.collections
    assert [line for line in axes.lines if line.get_marker() == "o"]
    assert title(figure) == "1 random controller"


def test_values_that_differ_by_rounding_have_no_density() -> None:
    measured = measure([1.0], 5)
    scores = np.full_like(measured.scores, 1.0)
    scores[-1] += 2.3e-16
    [axes] = violins(attrs.evolve(measured, scores=scores)).axes
    assert not axes.collections


@pytest.mark.parametrize(
    ("names", "shown"),
    [
        (["runs/a", "runs/b"], ["runs/a", "runs/b"]),
        (["/home/me/work/runs/a", "AFPO"], [".../runs/a", "AFPO"]),
        (["/one/work/runs/a", "/two/work/runs/a"], ["/one/work/runs/a", "/two/work/runs/a"]),
        (
            ["best-and-worst (n = 10, aggregator = WM)", "B"],
            ["best-and-worst (n = 10,\naggregator = WM)", "B"],
        ),
    ],
)
def test_long_names_are_shortened_or_broken(names: list[str], shown: list[str]) -> None:
    assert labels(violins(named(measure([1.0, 2.0], 5), names))) == shown


@pytest.mark.parametrize("count", [1, 4, 20])
def test_nothing_is_clipped_and_no_labels_overlap(count: int) -> None:
    names = [f"best-and-worst (n = {number}, aggregator = WM)" for number in range(count)]
    measured = measure([1.0 + number / 10 for number in range(count)], 20, unit="m")
    figure = violins(named(measured, names))
    canvas = FigureCanvasAgg(figure)
    canvas.draw()  # type: ignore[no-untyped-call]
    renderer = canvas.get_renderer()  # type: ignore[no-untyped-call]
    [axes] = figure.axes
    boxes = [label.get_window_extent(renderer) for label in axes.get_yticklabels()]
    whole = figure.bbox
    for text in [*axes.get_yticklabels(), axes.xaxis.label, *figure.texts]:
        box = text.get_window_extent(renderer)
        assert box.x0 >= 0
        assert box.y0 >= 0
        assert box.x1 <= whole.width
        assert box.y1 <= whole.height
    for upper, lower in pairwise(boxes):
        assert upper.y0 >= lower.y1
    assert figure.get_figwidth() == 3.5
