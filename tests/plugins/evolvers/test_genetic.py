"""The evolver ``genetic``."""

from __future__ import annotations

import json
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from hypothesis import given, strategies as st
from numpy.typing import NDArray

from evoframe import ConfigurationError
from evoframe.testing import EvolverContract
from evoframe_evolvers import Genetic

Fitness = Callable[[NDArray[np.float64]], NDArray[np.float64]]

units = st.floats(0.0, 1.0)
seeds = st.integers(0, 2**32 - 1)
pairs = st.integers(1, 6).flatmap(lambda n: st.tuples(*[st.lists(units, min_size=n, max_size=n)] * 2))


class TestContract(EvolverContract):
    component = Genetic()


class TestContractOfBlendWithoutElites(EvolverContract):
    component = Genetic(elites=0, crossover="blend", crossover_rate=1.0, mutation_rate=0.1)


class TestContractOfOnePointCrossover(EvolverContract):
    component = Genetic(elites=3, crossover="one-point", tournament=5)
    inputs = 0
    outputs = 5


def start(seed: int = 0, size: int = 20, outputs: int = 3, **options: Any) -> Any:
    return Genetic(**options).start(0, outputs, size, np.random.default_rng(seed))


def vectors(genomes: Any) -> NDArray[np.float64]:
    return np.array([genome.genes for genome in genomes])


def turn(run: Any, fitness: Fitness = lambda genes: genes.sum(axis=1)) -> NDArray[np.float64]:
    """Play a turn, and return its genes, ``[members, genes]``."""
    genes = vectors(run.ask())
    run.tell(fitness(genes), {})
    return genes


def test_a_network_returns_the_genes_at_every_point() -> None:
    run = start()
    for genome in run.ask():
        for inputs, n in ((0, 1), (2, 4)):
            assert run.express(genome)(np.zeros((n, inputs))).tolist() == [genome.genes.tolist()] * n


def test_initial_genes_are_uniformly_distributed() -> None:
    genes = vectors(start(size=4000, outputs=2).ask())
    for column in genes.T:
        counts, _ = np.histogram(column, bins=10, range=(0.0, 1.0))
        assert np.abs(counts - 400).max() < 5 * np.sqrt(400 * 0.9)  # standard deviations of a binomial count


def test_it_climbs() -> None:
    run = start(outputs=5)
    first, *_, last = (turn(run).sum(axis=1) for _ in range(60))
    assert last.max() > 4.8 > first.max()


def test_without_selection_pressure_it_does_not_climb() -> None:
    run = start(size=2000, outputs=1, tournament=1, elites=0, mutation_sd=0.01)
    means = [turn(run).mean() for _ in range(10)]
    assert abs(means[-1] - means[0]) < 0.1


def test_genes_stay_within_their_range() -> None:
    run = start(mutation_sd=2.0, crossover="blend", blend=3.0)
    for _ in range(10):
        genes = turn(run)
        assert ((genes >= 0.0) & (genes <= 1.0)).all()


def test_elites_survive_first_with_their_ids_and_others_are_new() -> None:
    run = start(elites=3)
    for _ in range(5):
        genes = turn(run)
        before = [member.id for member in run.members()]
        best = np.argsort(-genes.sum(axis=1), kind="stable")[:3]
        assert vectors(run.ask())[:3].tolist() == genes[best].tolist()
        members = run.members()
        assert [member.id for member in members[:3]] == [before[i] for i in best]
        assert not {member.id for member in members[3:]} & set(before)
        assert {member.age for member in members[3:]} == {0}
        run.tell(np.zeros(20), {})


def test_equally_fit_elites_are_chosen_by_their_place() -> None:
    run = start(elites=2)
    genes = turn(run, lambda genes: np.zeros(len(genes)))
    assert vectors(run.ask())[:2].tolist() == genes[:2].tolist()


def test_without_crossover_and_mutation_children_are_copies_of_the_fitter_members() -> None:
    run = start(crossover_rate=0.0, mutation_rate=0.0, tournament=8, size=30)
    genes = turn(run)
    children = vectors(run.ask())
    assert {tuple(child) for child in children.tolist()} <= {tuple(parent) for parent in genes.tolist()}
    assert children.sum(axis=1).mean() > genes.sum(axis=1).mean()


@pytest.mark.parametrize("tournament", [1, 2, 5])
def test_a_tournament_prefers_the_fittest_as_often_as_it_should(tournament: int) -> None:
    run = start(size=2000, outputs=1, elites=0, crossover_rate=0.0, mutation_rate=0.0, tournament=tournament)
    genes = turn(run)[:, 0]
    better_half = np.median(genes)
    share = (vectors(run.ask())[:, 0] > better_half).mean()
    assert share == pytest.approx(1 - 0.5**tournament, abs=0.04)


@given(parents=pairs, seed=seeds)
def test_uniform_crossover_takes_each_gene_from_a_parent(parents: Any, seed: int) -> None:
    one, other = map(np.array, parents)
    child = Genetic(crossover="uniform").cross(one, other, np.random.default_rng(seed))
    assert ((child == one) | (child == other)).all()


@given(parents=pairs, seed=seeds)
def test_one_point_crossover_has_one_place(parents: Any, seed: int) -> None:
    one, other = map(np.array, parents)
    child = Genetic(crossover="one-point").cross(one, other, np.random.default_rng(seed))
    assert any(
        child.tolist() == [*one[:place], *other[place:]] for place in range(1, len(one) + 1)
    )  # at least one gene of the first parent


@given(parents=pairs, seed=seeds, blend=st.sampled_from([0.0, 0.5, 2.0]))
def test_blended_genes_are_near_those_of_the_parents(parents: Any, seed: int, blend: float) -> None:
    one, other = map(np.array, parents)
    child = Genetic(crossover="blend", blend=blend).cross(one, other, np.random.default_rng(seed))
    beyond = blend * np.abs(one - other) + 1e-12
    assert (child >= np.minimum(one, other) - beyond).all()
    assert (child <= np.maximum(one, other) + beyond).all()


@pytest.mark.parametrize("rate", [0.0, 0.25, 1.0])
def test_as_many_genes_mutate_as_the_rate_says(rate: float) -> None:
    genes = np.full(4000, 0.5)
    mutated = Genetic(mutation_rate=rate, mutation_sd=0.01).mutate(genes, np.random.default_rng(1))
    assert (mutated != genes).mean() == pytest.approx(rate, abs=0.03)


def test_mutations_have_the_standard_deviation() -> None:
    genes = np.full(4000, 0.5)
    mutated = Genetic(mutation_sd=0.02).mutate(genes, np.random.default_rng(1))
    assert (mutated - genes).std() == pytest.approx(0.02, rel=0.05)
    assert (mutated - genes).mean() == pytest.approx(0.0, abs=0.002)


def test_seeds_keep_their_genes_and_mutants_are_near_them() -> None:
    run = start(size=9, mutation_sd=0.01)
    given = [run.load({"id": 7, "genes": [value] * 3}) for value in (0.2, 0.8)]
    run.seed(given)
    genes = vectors(run.ask())
    assert genes[:2].tolist() == [[0.2] * 3, [0.8] * 3]
    assert np.abs(genes[2::2] - 0.2).max() < 0.06
    assert np.abs(genes[3::2] - 0.8).max() < 0.06
    assert [member.id for member in run.members()] == list(range(1, 10))


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"genes": [0.5, 0.5]}, "genome.genes: expected 3 numbers"),
        ({"genes": [0.5, 0.5, 1.5]}, "from 0 to 1"),
        ({"genes": [0.5, 0.5, float("nan")]}, "genes"),
        ({"id": 0}, "genome.id"),
        ({"nodes": []}, "nodes"),
    ],
)
def test_another_genome_is_not_loaded(change: dict[str, Any], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        start().load({"id": 1, "genes": [0.5] * 3, **change})


@pytest.mark.parametrize(
    ("keys", "value", "message"),
    [
        (("evolver",), "neat", "state.evolver"),
        (("next_genome",), 20, "state.next_genome: must be > 20"),
        (("cohort", "members", 0, "genome", "genes"), [0.5], r"members\[0\].genome.genes"),
        (("random",), {"bit_generator": "PCG64"}, "state.random"),
        (("random",), 5, "state.random"),
    ],
)
def test_a_damaged_state_is_refused_and_changes_nothing(keys: Any, value: Any, message: str) -> None:
    run = start()
    before = run.state()
    damaged = json.loads(json.dumps(before))
    *path, last = keys
    place = damaged
    for key in path:
        place = place[key]
    place[last] = value
    with pytest.raises(ValueError, match=message):
        run.restore(damaged)
    assert run.state() == before


@pytest.mark.parametrize(("size", "elites"), [(0, 0), (2, 2), (3, 5)])
def test_a_population_without_offspring_is_refused(size: int, elites: int) -> None:
    with pytest.raises(ConfigurationError, match=str(size)):
        Genetic(elites=elites).check(size)


@pytest.mark.parametrize(
    "options",
    [
        {"tournament": 0},
        {"elites": -1},
        {"crossover_rate": 1.5},
        {"mutation_rate": -0.1},
        {"mutation_sd": float("nan")},
        {"blend": -1.0},
    ],
)
def test_impossible_options_are_refused(options: dict[str, Any]) -> None:
    with pytest.raises(ValueError, match=next(iter(options))):
        Genetic(**options)
