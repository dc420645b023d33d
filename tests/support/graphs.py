"""Graphs of networks for tests of figures."""

from __future__ import annotations

from typing import Any

from hypothesis import strategies as st

from evoframe import NetworkGraph, NetworkLink

__all__ = ["GRAPHS", "NETWORKS"]

_LABELS = st.sampled_from(["sin", "identity", "neg_sqrt_abs", "softplus", "two words", "$x_1$"])
_WEIGHTS = st.floats(-30, 30)


@st.composite
def _graphs(draw: Any, cycles: bool) -> NetworkGraph:
    inputs = range(-1, -1 - draw(st.integers(1, 4)), -1)
    outputs = range(draw(st.integers(1, 3)))
    nodes = range(len(outputs) + draw(st.integers(0, 12)))
    # Without cycles, links lead to later nodes of an order in which outputs are last.
    order = [*inputs, *nodes[len(outputs) :], *outputs]
    pairs = st.tuples(st.sampled_from(order), st.sampled_from(nodes)).filter(
        lambda pair: cycles or order.index(pair[0]) < order.index(pair[1])
    )
    ends = draw(st.lists(pairs, max_size=30, unique=True))
    links = tuple(NetworkLink(start, end, draw(_WEIGHTS)) for start, end in ends)
    return NetworkGraph(tuple(inputs), tuple(outputs), {node: draw(_LABELS) for node in nodes}, links)


NETWORKS: st.SearchStrategy[NetworkGraph] = _graphs(cycles=False)
"""Graphs without cycles; outputs may depend on each other."""

GRAPHS: st.SearchStrategy[NetworkGraph] = _graphs(cycles=True)
"""Graphs with and without cycles."""
