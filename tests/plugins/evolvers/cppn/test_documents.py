"""Genomes as JSON values: dumped genomes can be loaded, damaged ones are refused with the faulty key."""

from __future__ import annotations

import copy
import functools
import json
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest
from hypothesis import given, strategies as st

from evoframe import StructureError
from evoframe_evolvers import RandomSearch
from evoframe_evolvers.cppn.documents import (
    dump_genome,
    enabled_links,
    express,
    known_activation,
    load_genome,
)
from evoframe_libcppn import ACTIVATIONS

INPUTS, OUTPUTS = 4, 2


@functools.cache
def texts() -> tuple[str, ...]:
    """Return the genomes of one turn as text, so that tests cannot change each other's genomes."""
    run = RandomSearch(mutations=40, connection_delete=0.3).start(
        INPUTS, OUTPUTS, 30, np.random.default_rng(0)
    )
    return tuple(json.dumps(run.dump(genome)) for genome in run.ask())


GENOMES = st.builds(json.loads, st.sampled_from(texts()))


def places(value: Any, path: tuple[Any, ...] = ()) -> Iterator[tuple[Any, ...]]:
    """Yield the paths to all keys of tables within JSON values."""
    items = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, inner in items:
        if isinstance(key, str):
            yield (*path, key)
        yield from places(inner, (*path, key))


def owner_of(saved: Any, place: tuple[Any, ...]) -> Any:
    return functools.reduce(lambda inner, key: inner[key], place[:-1], saved)


def refusal_of(saved: Any) -> ValueError | None:
    try:
        load_genome(saved)
    except ValueError as error:
        return error
    return None


@given(GENOMES)
def test_a_dumped_genome_is_loaded_in_the_same_order(saved: Any) -> None:
    assert json.dumps(dump_genome(load_genome(saved))) == json.dumps(saved)


@given(GENOMES, st.data())
def test_a_missing_key_is_refused_by_name(saved: Any, data: st.DataObject) -> None:
    place = data.draw(st.sampled_from([*places(saved)]))
    del owner_of(saved, place)[place[-1]]
    with pytest.raises(StructureError) as caught:
        load_genome(saved)
    [fault] = caught.value.faults
    assert fault.path[-1] == place[-1]


@given(GENOMES, st.data(), st.sampled_from([None, [], {}, "x", 1.5, float("nan"), -(2**60)]))
def test_a_wrong_value_is_refused_or_means_the_same(saved: Any, data: st.DataObject, wrong: Any) -> None:
    place = data.draw(st.sampled_from([*places(saved)]))
    changed = copy.deepcopy(saved)
    owner_of(changed, place)[place[-1]] = wrong
    refusal = refusal_of(changed)
    if isinstance(refusal, StructureError):
        assert all(fault.path[-1].startswith(place[-1]) for fault in refusal.faults)
    elif refusal is not None:
        assert "gene twice" in str(refusal)
    else:
        assert dump_genome(load_genome(changed)) == changed


@pytest.mark.parametrize("kind", ["nodes", "connections"])
def test_an_unknown_key_is_refused(kind: str) -> None:
    saved = json.loads(texts()[0])
    saved[kind][0]["from_"] = 1
    with pytest.raises(StructureError, match=rf"^genome\.{kind}\[0\]\.from_: unknown"):
        load_genome(saved)


@pytest.mark.parametrize("kind", ["nodes", "connections"])
def test_a_gene_must_be_a_table(kind: str) -> None:
    saved = json.loads(texts()[0])
    saved[kind][0] = "gene"
    with pytest.raises(StructureError, match=rf'^genome\.{kind}\[0\]: .*table, found "gene"$'):
        load_genome(saved)


@pytest.mark.parametrize("kind", ["nodes", "connections"])
def test_a_duplicate_gene_is_refused(kind: str) -> None:
    saved = json.loads(texts()[0])
    saved[kind].append(saved[kind][0])
    with pytest.raises(ValueError, match=f"genome {saved['id']} .*gene twice"):
        load_genome(saved)


def test_all_faults_of_nodes_are_named() -> None:
    saved = json.loads(texts()[0])
    saved["nodes"][0] |= {"id": -1, "aggregation": "max"}
    saved["nodes"][1]["bias"] = "0.5"
    with pytest.raises(StructureError) as caught:
        load_genome(saved)
    faults = {".".join(fault.path): fault.message for fault in caught.value.faults}
    assert [*faults] == ["genome.nodes[0].id", "genome.nodes[0].aggregation", "genome.nodes[1].bias"]
    assert ">= 0, found -1" in faults["genome.nodes[0].id"]
    assert '"sum", found "max"' in faults["genome.nodes[0].aggregation"]
    assert 'number, found "0.5"' in faults["genome.nodes[1].bias"]


@given(GENOMES)
def test_links_are_enabled_connections_in_the_order_of_genes(saved: Any) -> None:
    expected = [
        (gene["from"], gene["to"], gene["weight"]) for gene in saved["connections"] if gene["enabled"]
    ]
    assert enabled_links(load_genome(saved)) == expected


@given(GENOMES)
def test_a_loaded_genome_expresses_the_network_of_the_dumped_one(saved: Any) -> None:
    points = np.random.default_rng(0).normal(size=(5, INPUTS))
    outputs = express(load_genome(saved), INPUTS, OUTPUTS)(points)
    again = express(load_genome(dump_genome(load_genome(saved))), INPUTS, OUTPUTS)(points)
    assert outputs.shape == (5, OUTPUTS)
    assert outputs.tobytes() == again.tobytes()


@pytest.mark.parametrize("name", ACTIVATIONS)
def test_a_known_activation_is_accepted(name: str) -> None:
    known_activation(None, None, name)


def test_an_unknown_activation_is_refused_with_the_known_ones() -> None:
    with pytest.raises(ValueError, match=r"'sinus'.* 'sin'.*sigmoid, tanh"):
        known_activation(None, None, "sinus")
