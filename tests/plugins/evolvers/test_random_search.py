import json
from typing import Any

import numpy as np
import pytest

from evoframe.testing import EvolverContract
from evoframe_evolvers import Neat, RandomSearch


class TestContract(EvolverContract):
    component = RandomSearch()


class TestContractOfMutants(EvolverContract):
    component = RandomSearch(mutations=8)


def start(seed: int = 0, size: int = 25, **options: Any) -> Any:
    return RandomSearch(**options).start(3, 2, size, np.random.default_rng(seed))


def turn(run: Any, fitness: float = 0.0) -> list[Any]:
    genomes = run.ask()
    run.tell(np.full(len(genomes), fitness), {})
    return [run.dump(genome) for genome in genomes]


def test_the_first_turn_is_that_of_neat() -> None:
    neat = Neat().start(3, 2, 25, np.random.default_rng(4))
    assert turn(start(4)) == [neat.dump(genome) for genome in neat.ask()]


def test_every_turn_is_fresh() -> None:
    run = start()
    seen: set[int] = set()
    for _ in range(10):
        turn(run)
        ids = {member.id for member in run.members()}
        assert not ids & seen
        assert {member.age for member in run.members()} == {0}
        assert {member.species for member in run.members()} == {None}
        seen |= ids


def test_fitness_does_not_matter() -> None:
    one, other = start(), start()
    for number in range(5):
        assert turn(one, 0.0) == turn(other, float(number))


def test_without_mutations_genomes_are_the_initial_ones_of_the_paper() -> None:
    run = start()
    for _ in range(4):
        for genome in turn(run):
            assert len(genome["nodes"]) == 2
            assert len(genome["connections"]) == 6


def test_mutations_are_spread_from_none_to_all() -> None:
    grown = [
        len(genome["nodes"]) for genome in turn(start(size=300, mutations=6, node_add=1.0, node_delete=0.0))
    ]
    counts = [grown.count(2 + times) for times in range(7)]
    assert sum(counts) == 300
    assert min(counts) >= 20


@pytest.mark.parametrize("mutations", [0, 5])
def test_a_run_saved_after_every_turn_is_the_uninterrupted_one(mutations: int) -> None:
    uninterrupted, saved = start(mutations=mutations), start(mutations=mutations)
    for number in range(20):
        state = saved.state()
        text = json.dumps(state, allow_nan=False)
        assert json.loads(text) == state
        saved = start(seed=number + 1, mutations=mutations)
        saved.restore(json.loads(text))
        assert turn(saved) == turn(uninterrupted)


def test_the_state_of_another_evolver_is_refused() -> None:
    state = Neat().start(3, 2, 25, np.random.default_rng(0)).state()
    with pytest.raises(ValueError, match=r'state\.evolver: .*"random", found "neat"'):
        start().restore(state)


def test_only_the_first_turn_has_the_seeds() -> None:
    run, other = start(size=6), start(size=6)
    [seed, *_] = turn(start(5, node_add=1.0, node_delete=0.0, mutations=20))
    run.seed([run.load(seed)])
    first = turn(run)
    assert first[0] == {**seed, "id": 1}
    assert [genome["id"] for genome in first] == [1, 2, 3, 4, 5, 6]
    turn(other)
    assert [len(genome["nodes"]) for genome in turn(run)] == [len(genome["nodes"]) for genome in turn(other)]


@pytest.mark.parametrize("mutations", [0, 6])
def test_mutants_of_seeds_are_mutated_at_least_once(mutations: int) -> None:
    run = start(size=300, mutations=mutations, node_add=1.0, node_delete=0.0)
    [seed, *_] = turn(start(1))
    run.seed([run.load(seed)])
    grown = [len(genome["nodes"]) - len(seed["nodes"]) for genome in turn(run)[1:]]
    assert set(grown) <= set(range(1, max(1, mutations) + 1))
    assert len(set(grown)) == max(1, mutations)
