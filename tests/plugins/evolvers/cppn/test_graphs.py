import copy
import functools
import json
from typing import Any

import numpy as np
import pytest
from hypothesis import given, strategies as st

from evoframe import NetworkGraph
from evoframe_evolvers import Neat, RandomSearch

INPUTS, OUTPUTS = 4, 2


@functools.cache
def saved_genomes() -> tuple[str, ...]:
    """Return the genomes of one turn as text, so that tests cannot change each other's genomes."""
    run = RandomSearch(mutations=40, connection_delete=0.3).start(
        INPUTS, OUTPUTS, 30, np.random.default_rng(0)
    )
    return tuple(json.dumps(run.dump(genome)) for genome in run.ask())


GENOMES = st.builds(json.loads, st.sampled_from(saved_genomes()))


def graph_of(genome: Any, inputs: int = INPUTS, outputs: int = OUTPUTS) -> NetworkGraph:
    return Neat().graph(genome, inputs, outputs)


@given(GENOMES)
def test_nodes_are_labeled_by_their_activations(genome: Any) -> None:
    assert graph_of(genome).labels == {node["id"]: node["activation"] for node in genome["nodes"]}


@given(GENOMES)
def test_links_are_the_enabled_connections(genome: Any) -> None:
    enabled = [(c["from"], c["to"], c["weight"]) for c in genome["connections"] if c["enabled"]]
    assert sorted((link.start, link.end, link.weight) for link in graph_of(genome).links) == sorted(enabled)


@given(GENOMES, st.data())
def test_the_order_of_genes_does_not_matter(genome: Any, data: st.DataObject) -> None:
    shuffled = copy.deepcopy(genome)
    for genes in ("nodes", "connections"):
        shuffled[genes] = data.draw(st.permutations(genome[genes]))
    assert graph_of(shuffled) == graph_of(genome)
    assert list(graph_of(shuffled).labels) == list(graph_of(genome).labels)


@given(GENOMES)
def test_an_input_without_a_connection_is_included(genome: Any) -> None:
    genome["connections"] = [gene for gene in genome["connections"] if gene["from"] != -2]
    graph = graph_of(genome)
    assert graph.inputs == (-1, -2, -3, -4)
    assert graph.outputs == (0, 1)
    assert all(link.start != -2 for link in graph.links)


@given(GENOMES)
def test_both_evolvers_return_the_same_graph(genome: Any) -> None:
    assert RandomSearch().graph(genome, INPUTS, OUTPUTS) == graph_of(genome)


def with_gene(genes: str, **changes: Any) -> Any:
    genome = json.loads(saved_genomes()[0])
    genome[genes][0] |= changes
    return genome


@pytest.mark.parametrize(
    ("genome", "fault"),
    [
        (None, "genome: .*found null"),
        ({"id": 1, "nodes": 3}, r"genome\.nodes: .*found 3; genome\.connections: .*missing"),
        (with_gene("nodes", activation="cosine"), r"nodes\[0\]\.activation: .*'cosine'"),
        (with_gene("nodes", bias=10**400), r"nodes\[0\]\.bias: "),
        (with_gene("nodes", id=7), "-1 -> 0"),
        (with_gene("connections", weight=float("nan")), r"connections\[0\]\.weight: .*finite .*nan"),
        (with_gene("connections", **{"from": -9}), "-9 -> "),
        (with_gene("connections", **{"from": 0, "to": 0}), "cycle"),
        (with_gene("connections", enabled=1), r"connections\[0\]\.enabled: .*found 1"),
    ],
)
def test_a_fault_is_named(genome: Any, fault: str) -> None:
    with pytest.raises(ValueError, match=fault):
        graph_of(genome)


def test_a_genome_of_another_shape_is_refused() -> None:
    genome = json.loads(saved_genomes()[0])
    for inputs, outputs in ((1, OUTPUTS), (INPUTS, OUTPUTS + 1)):
        with pytest.raises(ValueError, match=r"."):
            graph_of(genome, inputs, outputs)
