"""The network that a genome expresses, evaluated for all points at once."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from graphlib import CycleError, TopologicalSorter
from typing import TypeAlias

import attrs
import numpy as np
from numpy.typing import NDArray

from evoframe_evolvers.activations import ACTIVATIONS, Activation, guard

__all__ = ["CppnNetwork", "Node", "build_network"]

Link: TypeAlias = tuple[int, int, float]
"""An enabled connection: from, to, weight."""


@attrs.frozen
class Node:
    """A node gene: activation(bias + response * sum of the weighted inputs)."""

    activation: str
    bias: float
    response: float


@attrs.frozen(eq=False)
class _Step:
    """The evaluation of one node.

    Attributes:
        node: Its id.
        activation: Its guarded function.
        sources: Id and weight of what flows in, in the order in which it is summed.
    """

    node: int
    activation: Activation
    bias: float
    response: float
    sources: tuple[tuple[int, float], ...]

    def value(self, values: Mapping[int, NDArray[np.float64]]) -> NDArray[np.float64]:
        """Return the node's value at all points, or a single value if nothing flows in."""
        total = np.zeros(1)
        for source, weight in self.sources:
            total = total + values[source] * weight
        return self.activation(self.bias + self.response * total)


@attrs.frozen(eq=False)
class CppnNetwork:
    """A feed-forward network: ``float64[n, inputs] -> float64[n, outputs]``, finite for any input.

    Inputs have the ids -1, -2, ... and outputs 0, 1, ..., as in neat-python.
    """

    inputs: int
    outputs: int
    steps: tuple[_Step, ...]

    def __call__(self, points: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return the outputs at each of *points*."""
        if points.ndim != 2 or points.shape[1] != self.inputs:
            raise ValueError(f"expected points of shape (n, {self.inputs}), got {points.shape}")
        columns = guard(np.ascontiguousarray(points.T, dtype=np.float64))
        values = {-1 - axis: column for axis, column in enumerate(columns)}
        with np.errstate(all="ignore"):  # what overflows is clamped before it enters the node
            for step in self.steps:
                values[step.node] = step.value(values)
        result = np.empty((len(points), self.outputs))
        for output in range(self.outputs):
            result[:, output] = values[output]
        return result


def build_network(inputs: int, outputs: int, nodes: Mapping[int, Node], links: Iterable[Link]) -> CppnNetwork:
    """Return the network of *nodes* and *links*, reduced to the nodes that the outputs depend on.

    Args:
        inputs: Number of inputs.
        outputs: Number of outputs.
        nodes: Id -> node, outputs included.
        links: The enabled connections, in the order in which a node sums its inputs.

    Raises:
        ValueError: An output or an end of a link is missing, an activation is unknown, or there is a cycle.
    """
    sources: dict[int, list[tuple[int, float]]] = {node: [] for node in nodes}
    for source, target, weight in links:
        if target not in sources or (source not in sources and not -inputs <= source < 0):
            raise ValueError(f"connection {source} -> {target} leads from or to a node that does not exist")
        sources[target].append((source, weight))
    missing = [output for output in range(outputs) if output not in nodes]
    if missing:
        raise ValueError(f"output node {missing[0]} does not exist")
    order = _evaluation_order(outputs, sources)
    return CppnNetwork(inputs, outputs, tuple(_step(node, nodes[node], sources[node]) for node in order))


def _evaluation_order(outputs: int, sources: Mapping[int, list[tuple[int, float]]]) -> list[int]:
    """Return the nodes that the outputs depend on, each after those that it depends on."""
    graph: dict[int, list[int]] = {}
    waiting = list(range(outputs))
    while waiting:
        node = waiting.pop()
        if node not in graph:
            graph[node] = [source for source, _ in sources[node] if source >= 0]
            waiting += graph[node]
    try:
        return list(TopologicalSorter(graph).static_order())
    except CycleError as error:
        raise ValueError(f"the network has a cycle through the nodes {error.args[1]}") from error


def _step(node: int, gene: Node, sources: list[tuple[int, float]]) -> _Step:
    if gene.activation not in ACTIVATIONS:
        raise ValueError(f"node {node} has an unknown activation {gene.activation!r}")
    return _Step(node, ACTIVATIONS[gene.activation], gene.bias, gene.response, tuple(sources))
