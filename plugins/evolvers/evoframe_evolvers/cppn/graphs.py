"""Graphs of saved genomes, for figures."""

from __future__ import annotations

from typing import Any

from evoframe import NetworkGraph, NetworkLink
from evoframe_evolvers.cppn.documents import enabled_links, express, load_genome

__all__ = ["genome_graph"]


def genome_graph(saved: Any, inputs: int, outputs: int) -> NetworkGraph:
    """Return the graph of a saved genome: nodes labeled by their activations, enabled links only.

    The order of genes does not matter: labels and links are sorted by node ids. Ids are those of neat-python:
    inputs are -1, -2, ... and outputs 0, 1, ...

    Args:
        saved: The dumped genome, possibly from an untrusted file.
        inputs: Number of inputs of the network.
        outputs: Number of outputs of the network.

    Raises:
        ValueError: *saved* is not a genome, or does not encode a network with *inputs* and *outputs*.
    """
    genome = load_genome(saved)
    express(genome, inputs, outputs)  # raises for cycles, and for links and outputs without a node
    return NetworkGraph(
        inputs=tuple(range(-1, -inputs - 1, -1)),
        outputs=tuple(range(outputs)),
        labels={key: genome.nodes[key].activation for key in sorted(genome.nodes)},
        links=tuple(NetworkLink(*link) for link in sorted(enabled_links(genome))),
    )
