"""Genomes as JSON values, possibly from an untrusted file, and the networks that they encode."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Literal, TypeAlias

import attrs
import neat
from attrs.validators import ge
from neat.genes import DefaultConnectionGene, DefaultNodeGene

from evoframe import structure, suggestion
from evoframe_libcppn import ACTIVATIONS, CppnNetwork, Link

__all__ = ["dump_genome", "enabled_links", "express", "known_activation", "load_genome"]

Path: TypeAlias = tuple[str, ...]


def known_activation(_instance: Any, _attribute: Any, name: str) -> None:
    """Validate that *name* is a known activation function; an attrs validator.

    Raises:
        ValueError: *name* is unknown; the message lists the known names.
    """
    if name not in ACTIVATIONS:
        raise ValueError(f"unknown activation '{name}'{suggestion(name, ACTIVATIONS, 'known')}")


@attrs.frozen
class _SavedNode:
    id: int = attrs.field(validator=ge(0))
    bias: float
    response: float
    activation: str = attrs.field(validator=known_activation)
    aggregation: Literal["sum"]
    time_constant: float


@attrs.frozen
class _SavedConnection:
    """A saved connection without its key ``from``, a Python keyword that cannot be a field."""

    to: int = attrs.field(validator=ge(0))
    innovation: int = attrs.field(validator=ge(1))
    weight: float
    enabled: bool


@attrs.frozen
class _SavedGenome:
    id: int = attrs.field(validator=ge(1))
    nodes: tuple[_SavedNode, ...]
    connections: tuple[Any, ...]


def dump_genome(genome: Any) -> dict[str, Any]:
    """Return *genome* as JSON values; the order of genes matters, since neat-python iterates over them."""
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


def load_genome(saved: Any, path: Path = ("genome",)) -> Any:
    """Return the genome from which :func:`dump_genome` created *saved*; it need not encode a network.

    Args:
        saved: The genome as JSON values.
        path: The keys that lead to it, for messages.

    Raises:
        StructureError: *saved* is not a genome; names the invalid entries.
        ValueError: *saved* contains the same gene twice.
    """
    document = structure(saved, _SavedGenome, path)
    nodes = [_node(node) for node in document.nodes]
    connections = [
        _connection(connection, (*path, f"connections[{n}]"))
        for n, connection in enumerate(document.connections)
    ]
    genome = neat.DefaultGenome(document.id)
    genome.nodes = {gene.key: gene for gene in nodes}
    genome.connections = {gene.key: gene for gene in connections}
    if len(genome.nodes) + len(genome.connections) < len(nodes) + len(connections):
        raise ValueError(f"genome {genome.key} contains the same gene twice")
    return genome


def enabled_links(genome: Any) -> list[Link]:
    """Return the connections of *genome* that are enabled, in the order of its genes."""
    return [(*gene.key, gene.weight) for gene in genome.connections.values() if gene.enabled]


def express(genome: Any, inputs: int, outputs: int) -> CppnNetwork:
    """Return the network that *genome* encodes.

    Raises:
        ValueError: *genome* does not encode a network with *inputs* and *outputs*.
    """
    return CppnNetwork(inputs, outputs, genome.nodes, enabled_links(genome))


def _node(saved: _SavedNode) -> Any:
    gene = DefaultNodeGene(saved.id)
    gene.bias, gene.response, gene.time_constant = saved.bias, saved.response, saved.time_constant
    gene.activation, gene.aggregation = saved.activation, saved.aggregation
    return gene


def _connection(saved: Any, path: Path) -> Any:
    without_start = saved
    if isinstance(saved, Mapping):
        without_start = {key: value for key, value in saved.items() if key != "from"}
    link = structure(without_start, _SavedConnection, path)  # raises if *saved* is not a table
    start = structure(saved.get("from"), int, (*path, "from"))
    gene = DefaultConnectionGene((start, link.to), innovation=link.innovation)
    gene.weight, gene.enabled = link.weight, link.enabled
    return gene
