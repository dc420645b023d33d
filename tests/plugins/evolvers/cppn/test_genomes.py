"""The pool that creates genomes: its counters, its configuration and its state."""

from __future__ import annotations

import itertools
import json
import random
from typing import Any

import attrs
import neat
import numpy as np
import pytest
from hypothesis import given, strategies as st

from evoframe import ConfigurationError, StructureError, structure
from evoframe_evolvers import RandomSearch
from evoframe_evolvers.cppn import NO_SELECTION, Counter, GenePool, SavedPool
from evoframe_evolvers.cppn.documents import dump_genome


def pool_of(inputs: int = 3, outputs: int = 2, seed: int = 0, **options: Any) -> GenePool:
    evolver = RandomSearch(**options)
    return GenePool(evolver, NO_SELECTION, inputs, outputs, np.random.default_rng(seed))


def draw(pool: GenePool, mutations: int = 0) -> Any:
    genome = neat.DefaultGenome(next(pool.genome_ids))
    with pool.stream.swapped_in():
        genome.configure_new(pool.config.genome_config)
        for _ in range(mutations):
            genome.mutate(pool.config.genome_config)
    return genome


def saved(pool: GenePool) -> Any:
    return json.loads(json.dumps(pool.state()))


def restore(pool: GenePool, state: Any, genomes: list[Any]) -> None:
    pool.restore(structure(state, SavedPool, ("pool",)), genomes)


@given(st.integers(), st.integers(0, 20))
def test_a_counter_continues_from_its_value(start: int, steps: int) -> None:
    counter = Counter(start)
    assert [*itertools.islice(counter, steps)] == [*range(start, start + steps)]
    assert counter.value == start + steps


@given(st.integers(1, 5), st.integers(1, 5), st.integers(0, 12), st.integers(0, 99))
def test_a_restored_pool_continues_as_the_saved_one(
    inputs: int, outputs: int, mutations: int, seed: int
) -> None:
    pool, other = pool_of(inputs, outputs, seed), pool_of(inputs, outputs, seed + 1)
    genomes = [draw(pool, mutations) for _ in range(3)]
    restore(other, saved(pool), genomes)
    assert saved(other) == saved(pool)
    expected = [dump_genome(draw(pool, mutations)) for _ in range(3)]
    assert [dump_genome(draw(other, mutations)) for _ in range(3)] == expected


def test_hidden_nodes_are_numbered_after_the_outputs() -> None:
    pool = pool_of(outputs=2, node_add=1.0, node_delete=0.0, connection_delete=0.0)
    hidden = [key for key in draw(pool, 5).nodes if key not in (0, 1)]
    assert hidden == [2, 3, 4, 5, 6]
    assert pool.node_ids.value == 7


def test_the_global_stream_is_not_changed() -> None:
    before = random.getstate()
    draw(pool_of(), 5)
    assert random.getstate() == before


def test_a_loaded_genome_is_the_dumped_one() -> None:
    pool = pool_of()
    document = dump_genome(draw(pool, 9))
    assert dump_genome(pool.load(document, ("genome",))) == document


def test_a_genome_of_another_pool_is_refused() -> None:
    document = dump_genome(draw(pool_of(inputs=4)))
    with pytest.raises(ValueError, match="-4 -> "):
        pool_of(inputs=3).load(document, ("genome",))


def test_a_fault_of_a_genome_names_the_key_that_it_was_read_from() -> None:
    with pytest.raises(StructureError, match=r"^here\.there: .*found 3$"):
        pool_of().load(3, ("here", "there"))


def test_the_state_of_another_shape_is_refused() -> None:
    pool = pool_of()
    with pytest.raises(ValueError, match=r"\(3, 2\) .*\(4, 2\)"):
        restore(pool, saved(pool_of(inputs=4)), [draw(pool)])


@pytest.mark.parametrize(
    ("change", "fault"),
    [
        ({"next_genome": 1}, "next_genome: .*> 1, found 1"),
        ({"next_node": 1}, "next_node: .*> 1, found 1"),
        ({"next_node": 2.0}, r"next_node: .*found 2\.0"),
        ({"innovation": -1}, "innovation: .*>= 0, found -1"),
        ({"innovations": [[1, 2, 3, 4]]}, r"innovations\[0\]\[2\]: .*found 3"),
        ({"innovations": [[1, 2, "add"]]}, r"innovations\[0\]: .* 4"),
        ({"random": [3, [], None]}, r"state\.pool\.random: "),
        ({"random": None}, r"state\.pool\.random: "),
    ],
)
def test_a_damaged_state_is_refused_and_changes_nothing(change: dict[str, Any], fault: str) -> None:
    pool, other = pool_of(), pool_of(seed=1)
    genome = draw(pool, 3)
    genome.nodes = {key: gene for key, gene in genome.nodes.items() if key < 2}
    before = saved(other)
    with pytest.raises(ValueError, match=fault):
        restore(other, saved(pool) | change, [genome])
    assert saved(other) == before


def test_the_document_has_the_keys_of_a_state() -> None:
    assert {*saved(pool_of())} == {field.name for field in attrs.fields(SavedPool)}


def innovations(genomes: list[Any]) -> dict[int, set[tuple[int, int]]]:
    """Return innovation number -> the connections that have it."""
    found: dict[int, set[tuple[int, int]]] = {}
    for genome in genomes:
        for gene in genome.connections.values():
            found.setdefault(gene.innovation, set()).add(gene.key)
    return found


def without_id(genome: Any) -> Any:
    return {**dump_genome(genome), "id": None}


def grown(seed: int, mutations: int, count: int = 1) -> list[Any]:
    pool = pool_of(seed=seed, node_add=0.9, connection_add=0.9)
    return [draw(pool, mutations) for _ in range(count)]


@given(seed=st.integers(0, 99), mutations=st.integers(0, 8), count=st.integers(1, 4))
def test_genomes_of_one_run_are_adopted_unchanged_under_new_ids(
    seed: int, mutations: int, count: int
) -> None:
    given = grown(seed, mutations, count)
    before = [dump_genome(genome) for genome in given]
    pool = pool_of()
    adopted = pool.adopt(given)
    assert [without_id(genome) for genome in adopted] == [without_id(genome) for genome in given]
    assert [genome.key for genome in adopted] == [*range(1, count + 1)]
    assert [dump_genome(genome) for genome in given] == before
    assert not {id(genome) for genome in adopted} & {id(genome) for genome in given}


@given(seeds=st.lists(st.integers(0, 99), min_size=2, max_size=4), mutations=st.integers(1, 8))
def test_different_connections_of_different_runs_get_different_numbers(
    seeds: list[int], mutations: int
) -> None:
    given = [genome for seed in seeds for genome in grown(seed, mutations)]
    pool = pool_of()
    adopted = pool.adopt(given)
    assert all(len(keys) == 1 for keys in innovations(adopted).values())
    for one, other in zip(adopted, given, strict=True):
        numbers = [gene.innovation for gene in one.connections.values()]
        assert len(set(numbers)) == len(numbers)
        assert np.array_equal(pool.express(one)(np.ones((1, 3))), pool.express(other)(np.ones((1, 3))))
    assert without_id(adopted[0]) == without_id(given[0])


def test_runs_have_the_same_number_for_different_connections() -> None:
    runs = [genome for seed in range(5) for genome in grown(seed, 4)]
    assert any(len(keys) > 1 for keys in innovations(runs).values())  # so that the test above tests something


@given(seed=st.integers(0, 99), mutations=st.integers(0, 8))
def test_later_nodes_connections_and_genomes_have_new_numbers(seed: int, mutations: int) -> None:
    pool = pool_of(node_add=1.0, node_delete=0.0, connection_delete=0.0)
    [adopted] = pool.adopt(grown(seed, mutations))
    with pool.stream.swapped_in():
        mutant = pool.mutant(adopted, 3)
    assert mutant.key == adopted.key + 1
    assert mutant.nodes.keys() > adopted.nodes.keys()
    added = {gene.innovation for key, gene in mutant.connections.items() if key not in adopted.connections}
    assert added
    assert min(added) > max(innovations([adopted]), default=0)


def test_a_genome_without_connections_is_adopted() -> None:
    [genome] = grown(0, 0)
    genome.connections.clear()
    pool = pool_of()
    pool.adopt([genome])
    assert pool.tracker.global_counter == 0
    assert pool.node_ids.value == 2


def test_networks_require_an_input() -> None:
    with pytest.raises(ConfigurationError, match="found 0; use the evolver genetic"):
        pool_of(inputs=0)
