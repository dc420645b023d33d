"""Charts of a page agree with the figures."""

from __future__ import annotations

import html
import math
import textwrap
from pathlib import Path

import numpy as np
import pytest

from evoframe import run
from evoframe.analysis.data.studies import View
from evoframe.analysis.figures.lines import Line, lines_of_run
from evoframe.analysis.page.charts import finals_chart, lines_chart
from evoframe.analysis.page.html import Chart
from evoframe.study.rows import Row


def row(number: int, score: float) -> Row:
    return Row({"aggregator": "am"}, number, 1, "", "", score, score, score, 1, 1, 1.0, "")


def test_a_line_is_drawn_over_its_band_in_its_color() -> None:
    values, low, high = (np.array([start, start + 1.0]) for start in (1.0, 0.5, 2.0))
    band, line = lines_chart([Line("AM: 3", values, 4, 1, (low, high))], "score (mm)").data
    assert list(band.x) == [0, 1, 1, 0]
    assert list(band.y) == [2.0, 3.0, 1.5, 0.5]
    assert (list(line.x), list(line.y)) == ([0, 1], [1.0, 2.0])
    assert line.meta == band.meta == {"color": 4, "label": "AM: 3"}
    assert line.legendgroup == band.legendgroup == line.name == "AM: 3"
    assert (line.showlegend, band.showlegend) == (None, False)
    assert line.line.dash == "dash"


def test_missing_values_are_gaps() -> None:
    plot = lines_chart([Line("a", np.array([math.nan, 1.0]), 0, 0)], "")
    assert list(plot.data[0].y) == [None, 1.0]
    assert "NaN" not in Chart("", plot).json


def test_every_run_has_a_point_in_millimeters() -> None:
    many = [0.005, 0.0051, 0.0053, 0.0052, 0.009, 0.0054]
    groups = {"AM": [row(*numbered) for numbered in enumerate(many)], "WM": [row(0, 0.006)]}
    box, points = finals_chart(View("n = 2", "aggregator", groups), "score", "m").data
    assert (box.name, box.type, box.boxpoints) == ("AM: 6", "box", "all")
    assert list(box.y[0]) == pytest.approx([5.0, 5.1, 5.3, 5.2, 9.0, 5.4])
    quartiles = np.quantile(1000 * np.array(many), [0.25, 0.5, 0.75])  # as in tables and figures
    assert [box.q1[0], box.median[0], box.q3[0]] == pytest.approx(quartiles)
    assert (box.lowerfence[0], box.upperfence[0]) == pytest.approx((5.0, 5.4))
    assert (points.name, points.type, list(points.y)) == ("WM: 1", "scatter", [6.0])


def test_generations_are_whole_numbers() -> None:
    short, long = (lines_chart([Line("a", np.ones(n), 0, 0)], "").layout.xaxis.dtick for n in (4, 40))
    assert (short, long) == (1, None)


def test_the_lines_of_a_run_match_its_record(tmp_path: Path) -> None:
    made = run("quick", out=tmp_path / "r", run={"generations": 2})
    lines = {line.name: line.values for line in lines_of_run(made, "m")}
    for name in ("morphology", "controller"):
        rows = [row for row in made.turns() if row["population"] == name]
        for statistic in ("best", "mean"):
            assert lines[f"{name}: {statistic} fitness"] == pytest.approx(
                [1000 * row[statistic] for row in rows]
            )
    best = lines["best pair so far"]
    assert len(best) == 3
    assert (np.diff(best) >= 0).all()
    assert best[-1] == pytest.approx(1000 * made.champion().score)


def test_long_names_are_wrapped_and_not_interpreted_as_html() -> None:
    name = '{"floor": 0.001, "name": "<b>hm</b>"} (n = 1): 5'
    [line] = lines_chart([Line(name, np.ones(3), 0, 0)], "").data
    lines = line.name.split("<br>")
    assert [html.unescape(part) for part in lines] == textwrap.wrap(name, 22)
    assert "<b>" not in line.name
    assert line.meta["label"] == name  # the legend of the page, which inserts it as text
