"""Tests of layouts of networks: directions, order, and no overlaps."""

from __future__ import annotations

from itertools import pairwise

import attrs
import pytest
from graphs import GRAPHS, NETWORKS
from hypothesis import given, strategies as st

from evoframe import NetworkGraph, NetworkLink
from evoframe.analysis.figures.layered import effective, layered


def reached(graph: NetworkGraph) -> set[int]:
    """Return the nodes from which an output is reached, by following every link repeatedly."""
    found: set[int] = set(graph.outputs)
    for _ in graph.labels:
        found |= {link.start for link in graph.links if link.end in found}
    return found


@given(GRAPHS)
def test_only_dead_ends_are_omitted(graph: NetworkGraph) -> None:
    kept = effective(graph)
    alive = reached(graph)
    assert set(kept.labels) == set(graph.labels) & alive
    assert kept.links == tuple(link for link in graph.links if link.end in alive)
    assert (kept.inputs, kept.outputs) == (graph.inputs, graph.outputs)
    assert effective(kept) == kept


@given(NETWORKS)
def test_links_go_from_left_to_right(graph: NetworkGraph) -> None:
    layout = layered(graph)
    assert not layout.returns
    for link, route in zip(graph.links, layout.routes, strict=True):
        assert layout.columns[link.start] < layout.columns[link.end]
        assert len(route) == layout.columns[link.end] - layout.columns[link.start] + 1


@given(GRAPHS)
def test_inputs_are_at_the_left_and_outputs_at_the_right_in_their_order(graph: NetworkGraph) -> None:
    layout = layered(graph)
    assert {layout.columns[node] for node in graph.inputs} == {0}
    assert all(layout.columns[node] > 0 for node in graph.labels)
    last = [node for node in graph.outputs if layout.columns[node] == max(layout.columns.values())]
    assert {node for node in graph.outputs if all(link.start != node for link in graph.links)} <= set(last)
    for nodes in (graph.inputs, last):
        assert list(nodes) == sorted(nodes, key=layout.heights.__getitem__)


@given(GRAPHS)
def test_no_two_nodes_overlap(graph: NetworkGraph) -> None:
    layout = layered(graph)
    assert set(layout.heights) == set(layout.columns) == {*graph.inputs, *graph.labels}
    for column in set(layout.columns.values()):
        heights = sorted(layout.heights[node] for node, c in layout.columns.items() if c == column)
        assert heights[0] >= 0.5 - 1e-9
        assert heights[-1] <= layout.rows - 0.5 + 1e-9
        assert all(below - above >= 1 - 1e-9 for above, below in pairwise(heights))


@given(GRAPHS)
def test_a_link_does_not_cross_nodes(graph: NetworkGraph) -> None:
    layout = layered(graph)
    for link, route in zip(graph.links, layout.routes, strict=True):
        for column, height in enumerate(route[1:-1], start=layout.columns[link.start] + 1):
            nodes = [node for node, c in layout.columns.items() if c == column]
            assert all(abs(layout.heights[node] - height) >= 0.7 - 1e-9 for node in nodes)


@given(GRAPHS)
def test_links_reach_their_nodes_at_different_heights(graph: NetworkGraph) -> None:
    layout = layered(graph)
    for end, place in (("start", 0), ("end", -1)):
        pairs = zip(graph.links, layout.routes, strict=True)
        ports = [(getattr(link, end), route[place]) for link, route in pairs]
        assert len(set(ports)) == len(ports)
        assert all(abs(height - layout.heights[node]) < 0.3 for node, height in ports)


@given(NETWORKS)
def test_links_of_a_node_do_not_cross_beside_it(graph: NetworkGraph) -> None:
    layout = layered(graph)
    for end, port, beside in (("start", 0, 1), ("end", -1, -2)):
        for node in layout.columns:
            pairs = zip(graph.links, layout.routes, strict=True)
            ends = sorted((r[port], r[beside]) for joined, r in pairs if getattr(joined, end) == node)
            assert [height for _, height in ends] == sorted(height for _, height in ends)


@given(st.permutations(range(7)))
def test_links_that_need_not_cross_do_not(order: list[int]) -> None:
    links = [NetworkLink(-1 - i, 1 + hidden, 1.0) for i, hidden in enumerate(order)]
    links += [NetworkLink(1 + hidden, 0, 1.0) for hidden in order]
    inputs, labels = tuple(range(-1, -8, -1)), dict.fromkeys(range(8), "sin")
    heights = layered(NetworkGraph(inputs, (0,), labels, tuple(links))).heights
    assert sorted(order, key=lambda hidden: heights[1 + hidden]) == order


@pytest.mark.parametrize("length", [1, 2, 5, 300])
def test_a_cycle_has_one_backward_link(length: int) -> None:
    ring = [NetworkLink(1 + n, 1 + (n + 1) % length, 1.0) for n in range(length)]
    links = (NetworkLink(-1, 1, 1.0), *ring, NetworkLink(length, 0, 1.0))
    layout = layered(NetworkGraph((-1,), (0,), dict.fromkeys(range(length + 1), "sin"), links))
    assert layout.returns
    assert [layout.columns[link.start] < layout.columns[link.end] for link in links].count(False) == 1


def test_a_node_without_inputs_precedes_its_first_dependent() -> None:
    chain = [NetworkLink(-1, 1, 1.0), NetworkLink(1, 2, 1.0), NetworkLink(2, 3, 1.0), NetworkLink(3, 0, 1.0)]
    graph = NetworkGraph((-1,), (0,), dict.fromkeys(range(5), "sin"), (*chain, NetworkLink(4, 3, 1.0)))
    assert layered(graph).columns == {-1: 0, 1: 1, 2: 2, 4: 2, 3: 3, 0: 4}


def test_an_output_precedes_its_dependents() -> None:
    links = (NetworkLink(-1, 0, 1.0), NetworkLink(0, 2, 1.0), NetworkLink(2, 1, 1.0))
    graph = NetworkGraph((-1,), (0, 1), dict.fromkeys(range(3), "sin"), links)
    assert layered(graph).columns == {-1: 0, 0: 1, 2: 2, 1: 3}


@given(NETWORKS)
def test_a_node_without_links_stays_close(graph: NetworkGraph) -> None:
    lonely = attrs.evolve(graph, inputs=(*graph.inputs, -98, -99))
    heights = layered(lonely).heights
    assert heights[-99] - heights[-98] == pytest.approx(1)
    assert heights[-98] - heights[graph.inputs[-1]] == pytest.approx(1)
