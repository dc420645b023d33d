"""Genomes as JSON values, perhaps from a file of anyone, and the networks that they encode."""

from __future__ import annotations

from typing import Any

import neat
from neat.genes import DefaultConnectionGene, DefaultNodeGene

from evoframe_evolvers.cppn.checked import entry, number, rows, whole
from evoframe_libcppn import ACTIVATIONS, CppnNetwork, Link

__all__ = ["dump_genome", "enabled_links", "express", "load_genome"]


def dump_genome(genome: Any) -> dict[str, Any]:
    """Return *genome* as JSON values; the order of genes matters, for neat-python walks through it."""
    return {
        "id": genome.key,
        "nodes": [
            {
                "id": gene.key,
                "bias": gene.bias,
                "response": gene.response,
                "activation": gene.activation,
                "aggregation": gene.aggregation,
                "time_constant": gene.time_constant,
            }
            for gene in genome.nodes.values()
        ],
        "connections": [
            {
                "from": gene.key[0],
                "to": gene.key[1],
                "innovation": gene.innovation,
                "weight": gene.weight,
                "enabled": gene.enabled,
            }
            for gene in genome.connections.values()
        ],
    }


def load_genome(saved: Any) -> Any:
    """Return the genome that :func:`dump_genome` made *saved* of; whether it encodes a network is not said.

    Raises:
        ValueError: It is no genome; names the entry that is wrong.
    """
    genome = neat.DefaultGenome(whole(saved, "id", 1))
    for gene in map(_load_node, rows(saved, "nodes")):
        genome.nodes[gene.key] = gene
    for gene in map(_load_connection, rows(saved, "connections")):
        genome.connections[gene.key] = gene
    if len(genome.nodes) + len(genome.connections) < len(saved["nodes"]) + len(saved["connections"]):
        raise ValueError(f"genome {genome.key} has the same gene twice")
    return genome


def enabled_links(genome: Any) -> list[Link]:
    """Return the connections of *genome* that are enabled, in the order of its genes."""
    return [(*gene.key, gene.weight) for gene in genome.connections.values() if gene.enabled]


def express(genome: Any, inputs: int, outputs: int) -> CppnNetwork:
    """Return the network that *genome* encodes.

    Raises:
        ValueError: It encodes none with so many *inputs* and *outputs*.
    """
    return CppnNetwork(inputs, outputs, genome.nodes, enabled_links(genome))


def _load_node(saved: Any) -> Any:
    gene = DefaultNodeGene(whole(saved, "id", 0))
    gene.bias, gene.response = number(saved, "bias"), number(saved, "response")
    gene.activation, gene.aggregation = entry(saved, "activation", str), entry(saved, "aggregation", str)
    gene.time_constant = number(saved, "time_constant")
    if gene.activation not in ACTIVATIONS or gene.aggregation != "sum":
        raise ValueError(
            f"node {gene.key} has activation '{gene.activation}', aggregation '{gene.aggregation}'"
        )
    return gene


def _load_connection(saved: Any) -> Any:
    key = (whole(saved, "from"), whole(saved, "to", 0))
    gene = DefaultConnectionGene(key, innovation=whole(saved, "innovation", 1))
    gene.weight, gene.enabled = number(saved, "weight"), entry(saved, "enabled", bool)
    return gene
