"""Tests of figures of networks: every node and link is shown, without overlaps."""

from __future__ import annotations

import io
from itertools import combinations
from typing import Any

import attrs
import matplotlib as mpl
import pytest
from graphs import GRAPHS, NETWORKS
from hypothesis import given, settings
from matplotlib.axes import Axes
from matplotlib.colors import to_hex
from matplotlib.figure import Figure
from matplotlib.patches import FancyArrowPatch, FancyBboxPatch
from matplotlib.transforms import Bbox

from evoframe import NetworkGraph, NetworkLink
from evoframe.analysis.figures.layered import effective
from evoframe.analysis.figures.networks import NEGATIVE, PALE, POSITIVE, network

SOME = settings(max_examples=25)  # drawing is slow


def link(start: int, end: int, weight: float = 1.0) -> NetworkLink:
    return NetworkLink(start, end, weight)


def graph_of(*links: NetworkLink, hidden: int = 0) -> NetworkGraph:
    """Return a network of two inputs and an output."""
    return NetworkGraph((-1, -2), (0,), dict.fromkeys(range(1 + hidden), "tanh"), links)


def drawn(graph: NetworkGraph, title: str = "champion") -> Figure:
    inputs = [f"in {number}" for number, _ in enumerate(graph.inputs)]
    outputs = [f"out {number}" for number, _ in enumerate(graph.outputs)]
    return network(graph, inputs, outputs, title)


def boxes(axes: Axes) -> list[Bbox]:
    """Return the boxes of nodes: first those with an activation, then inputs."""
    return [patch.get_bbox() for patch in axes.patches if isinstance(patch, FancyBboxPatch)]


def curves(axes: Axes) -> list[FancyArrowPatch]:
    """Return the links, the heaviest first."""
    return [patch for patch in axes.patches if isinstance(patch, FancyArrowPatch)]


def words(figure: Figure) -> list[str]:
    [axes] = figure.axes
    return [text.get_text() for text in (*axes.texts, *figure.texts, axes.title) if text.get_text()]


@SOME
@given(GRAPHS)
def test_every_node_has_a_box_with_its_label(graph: NetworkGraph) -> None:
    [axes] = drawn(graph).axes
    shown = effective(graph)
    labels = [*shown.labels.values(), *(f"in {number}" for number, _ in enumerate(graph.inputs))]
    places = boxes(axes)
    assert len(places) == len(labels)
    for box, label in zip(places, labels, strict=True):
        inside = [text for text in axes.texts if box.contains(*text.get_position())]
        assert [text.get_text().replace("_\n", "_").replace("\n", " ") for text in inside] == [label]


@SOME
@given(GRAPHS)
def test_boxes_do_not_overlap(graph: NetworkGraph) -> None:
    [axes] = drawn(graph).axes
    for one, other in combinations(boxes(axes), 2):
        assert Bbox.intersection(one, other) is None


@SOME
@given(NETWORKS)
def test_no_link_runs_through_a_box(graph: NetworkGraph) -> None:
    [axes] = drawn(graph).axes
    inner = [box.padded(-0.005) for box in boxes(axes)]
    for curve in curves(axes):
        path = curve.get_path()
        assert not any(path.intersects_bbox(box, filled=False) for box in inner)


@SOME
@given(GRAPHS)
def test_all_words_are_within_the_figure_and_their_boxes(graph: NetworkGraph) -> None:
    figure = drawn(graph, "a title that is rather long, so that it takes more than one line of a column")
    figure.draw_without_rendering()
    [axes] = figure.axes
    legend = [text for legend in figure.legends for text in legend.get_texts()]
    for text in (*axes.texts, *figure.texts, axes.title, *legend):
        if text.get_text():
            x0, y0, x1, y1 = text.get_window_extent().extents
            assert x0 >= figure.bbox.x0
            assert y0 >= figure.bbox.y0
            assert x1 <= figure.bbox.x1
            assert y1 <= figure.bbox.y1
    places = [box.transformed(axes.transData) for box in boxes(axes)]
    for text in axes.texts:
        extent = text.get_window_extent()
        inside = [
            box for box in places if box.contains((extent.x0 + extent.x1) / 2, (extent.y0 + extent.y1) / 2)
        ]
        assert all(box.x0 <= extent.x0 and extent.x1 <= box.x1 for box in inside)


@SOME
@given(GRAPHS)
def test_links_show_sign_and_size(graph: NetworkGraph) -> None:
    [axes] = drawn(graph).axes
    links = sorted(effective(graph).links, key=lambda link: -abs(link.weight))
    lines = curves(axes)
    assert len(lines) == len(links)
    for line, shown in zip(lines, links, strict=True):
        negative = shown.weight < 0
        assert to_hex(line.get_edgecolor()).upper() == (NEGATIVE if negative else POSITIVE)
        assert (line.get_linestyle() == "-") is not negative
    widths = [line.get_linewidth() for line in lines]
    assert widths == sorted(widths, reverse=True)
    for one, other in combinations(range(len(links)), 2):
        if abs(links[one].weight) > 1.01 * abs(links[other].weight) + 0.01:
            assert widths[one] > widths[other]


def test_nodes_without_effect_are_omitted_and_counted() -> None:
    graph = graph_of(link(-1, 1), link(1, 0), link(-2, 2), link(2, 3), hidden=4)
    assert [text for text in words(drawn(graph)) if text.startswith("3 of 4 ")]
    one = graph_of(link(-1, 1), link(1, 0), hidden=2)
    assert [text for text in words(drawn(one)) if text.startswith("1 of 2 ")]
    assert words(drawn(graph_of(link(-1, 1), link(1, 0), hidden=1))) == [
        *("tanh", "tanh", "in 0", "in 1", "out 0", "champion")
    ]


def test_inputs_without_effect_are_pale() -> None:
    [axes] = drawn(graph_of(link(-1, 0))).axes
    colours = {text.get_text(): text.get_color() for text in axes.texts}
    assert colours["in 1"] == PALE
    assert colours["in 0"] != PALE


def test_a_network_without_links_is_drawn_without_a_legend() -> None:
    figure = drawn(graph_of())
    assert figure.legends == []
    assert "out 0" in words(figure)


@pytest.mark.parametrize(
    ("weights", "entries"),
    [
        ([2.0], ["positive weight", "|weight| = 2"]),
        ([-2.0, -0.125], ["negative weight", "|weight| = 0.12", "|weight| = 2"]),
        ([2.0, -1.0], ["positive weight", "negative weight", "|weight| = 1", "|weight| = 2"]),
    ],
)
def test_the_legend_has_the_signs_and_extreme_weights(weights: list[float], entries: list[str]) -> None:
    graph = graph_of(*(link(-1 - number, 0, weight) for number, weight in enumerate(weights)))
    [legend] = drawn(graph).legends
    assert [text.get_text() for text in legend.get_texts()] == entries


def chain(length: int) -> NetworkGraph:
    inner = [link(node, node + 1) for node in range(1, length)]
    return graph_of(link(-1, 1), *inner, link(length, 0), hidden=length)


@pytest.mark.parametrize(("length", "width"), [(1, 3.5), (2, 3.5), (7, 7.0), (10, 7.0)])
def test_figures_are_as_wide_as_a_column_or_the_text(length: int, width: float) -> None:
    assert drawn(chain(length)).get_size_inches()[0] == width


def test_a_deep_network_has_a_wider_figure() -> None:
    assert 7 < drawn(chain(20)).get_size_inches()[0] < drawn(chain(30)).get_size_inches()[0]


def test_a_backward_link_is_an_arrow() -> None:
    [axes] = drawn(graph_of(link(-1, 1), link(1, 2), link(2, 1, 3.0), link(2, 0), hidden=2)).axes
    styles: list[Any] = [curve.get_arrowstyle() for curve in curves(axes)]
    assert [style.arrow for style in styles] == ["-|>", "-", "-", "-"]  # the heaviest link is the first


def test_names_with_dollar_signs_are_not_formulas() -> None:
    graph = attrs.evolve(graph_of(link(-1, 0)), labels={0: r"$\nothing$"})
    figure = network(graph, ["$x", "y$"], ["$\\"], r"$\frac$")
    figure.draw_without_rendering()
    assert {"$x", "y$", "$\\", r"$\frac$", r"$\nothing$"} <= set(words(figure))


@SOME
@given(GRAPHS)
def test_the_same_network_gives_the_same_file(graph: NetworkGraph) -> None:
    backwards = dict(reversed(list(graph.labels.items())))
    assert svg(graph) == svg(attrs.evolve(graph, labels=backwards))


def svg(graph: NetworkGraph) -> bytes:
    data = io.BytesIO()
    with mpl.rc_context({"svg.hashsalt": "x", "svg.fonttype": "none"}):
        drawn(graph).savefig(data, format="svg", metadata={"Date": None})
    return data.getvalue()


def test_a_wrong_number_of_names_is_rejected() -> None:
    with pytest.raises(ValueError, match=r"1 names for 2 inputs.*x"):
        network(graph_of(), ["x"], ["out"])
    with pytest.raises(ValueError, match=r"2 names for 1 outputs.*a, b"):
        network(graph_of(), ["x", "y"], ["a", "b"])


def test_a_network_too_large_for_a_figure_is_rejected() -> None:
    with pytest.raises(ValueError, match=r"301 nodes and 301 links .*500"):
        drawn(chain(300))


def test_without_names_inputs_and_outputs_are_numbered() -> None:
    shown = [text.get_text() for text in network(graph_of(link(-1, 0)), (), ()).axes[0].texts]
    assert {text.replace("\n", " ") for text in shown} >= {"input 1", "input 2", "tanh", "output 1"}
