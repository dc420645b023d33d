"""Reproduction of many species in a small population, and extinction."""

import logging
from typing import Any

import neat
import numpy as np
import pytest
from hypothesis import given, strategies as st
from neat.reporting import ReporterSet
from neat.species import Species

from evoframe_evolvers import Neat
from evoframe_evolvers.crowding import RoomyStagnation, fit_exactly


@st.composite
def spawns(draw: st.DrawFn) -> tuple[list[int], int, int]:
    least = draw(st.integers(1, 3))
    amounts = draw(st.lists(st.integers(least, 30), min_size=1, max_size=12))
    return amounts, draw(st.integers(least * len(amounts), 60)), least


@given(spawns())
def test_spawns_fit_exactly(spawn: tuple[list[int], int, int]) -> None:
    amounts, size, least = spawn
    fitted = fit_exactly(amounts, size, least)
    assert sum(fitted) == size
    assert min(fitted) >= least


@given(spawns())
def test_spawns_equal_those_of_neat_python_where_it_succeeds(spawn: tuple[list[int], int, int]) -> None:
    amounts, size, least = spawn
    reproduction = neat.DefaultReproduction(None, None, None)
    try:
        theirs = reproduction._adjust_spawn_exact(list(amounts), size, least)
    except RuntimeError:
        return  # it stops after one round: see the next test
    assert fit_exactly(amounts, size, least) == theirs


def test_a_surplus_that_neat_python_cannot_trim_is_trimmed() -> None:
    amounts = [14, *[2] * 8]
    with pytest.raises(RuntimeError, match="pop_size"):
        neat.DefaultReproduction(None, None, None)._adjust_spawn_exact(list(amounts), 25, 2)
    assert fit_exactly(amounts, 25, 2) == [9, *[2] * 8]


def play(run: Any, turns: int, seed: int = 0) -> None:
    """Evolve with heavy-tailed random fitness, and check the population in every turn."""
    rng, size = np.random.default_rng(seed), len(run.members())
    for _ in range(turns):
        genomes = run.ask()
        assert len({genome.key for genome in genomes}) == len(genomes) == size
        assert [member.id for member in run.members()] == [genome.key for genome in genomes]
        assert len({member.species for member in run.members()}) <= size
        run.tell(rng.standard_cauchy(size=size), {})


@pytest.mark.parametrize("size", [2, 3, 4, 25])
@pytest.mark.parametrize("threshold", [0.0, 1.0, 3.0, 1e9])
@pytest.mark.parametrize("least", [1, 2])
@pytest.mark.parametrize("lasting", [{}, {"species_elitism": 0, "max_stagnation": 1}])
def test_the_size_is_kept_whatever_happens(
    size: int, threshold: float, least: int, lasting: dict[str, Any]
) -> None:
    evolver = Neat(
        compatibility_threshold=threshold, elitism=min(2, size - 1), min_species_size=least, **lasting
    )
    play(evolver.start(3, 2, size, np.random.default_rng(size)), turns=100)


def test_a_lone_member_without_elitism_evolves() -> None:
    run = Neat(elitism=0).start(3, 2, 1, np.random.default_rng(0))
    play(run, 50)
    assert run.members()[0].id == 50


def test_if_every_genome_is_a_species_each_keeps_one_elite(caplog: pytest.LogCaptureFixture) -> None:
    run = Neat(compatibility_threshold=0.0).start(3, 2, 25, np.random.default_rng(0))
    genomes = run.ask()
    assert len({member.species for member in run.members()}) == 25
    run.tell(np.arange(25.0), {})
    with caplog.at_level(logging.INFO, logger="evoframe_evolvers"):
        survivors = run.ask()
    assert "25 species of at least 2 members" in caplog.text
    assert "elitism = 1" in caplog.text
    assert "min_species_size = 1" in caplog.text
    assert {genome.key for genome in survivors} == {
        genome.key for genome in genomes
    }  # one elite of each species


def test_the_configured_rules_are_restored_after_the_turn() -> None:
    run = Neat(compatibility_threshold=0.0, min_species_size=2).start(3, 2, 9, np.random.default_rng(0))
    rules = run._pool.config.reproduction_config
    play(run, 3)
    assert (rules.elitism, rules.min_species_size) == (2, 2)


def test_crowding_adds_no_elitism_if_it_is_disabled() -> None:
    run = Neat(compatibility_threshold=0.0, elitism=0, min_species_size=2).start(
        3, 2, 9, np.random.default_rng(0)
    )
    before = {genome.key for genome in run.ask()}
    run.tell(np.arange(9.0), {})
    assert not before & {genome.key for genome in run.ask()}


def stagnation_of(*fitness: float, places: int, **rules: Any) -> Any:
    """Return a stagnation, and species with the keys 1, 2, ... and one member each."""
    config = Neat(**rules).start(3, 2, 8, np.random.default_rng(0))._pool.config
    stagnation = RoomyStagnation(config.stagnation_config, ReporterSet(), config.reproduction_config)
    stagnation.places = places
    species_set = neat.DefaultSpeciesSet(config.species_set_config, ReporterSet())
    for key, value in enumerate(fitness, start=1):
        genome = neat.DefaultGenome(key)
        genome.fitness = value
        species_set.species[key] = Species(key, 0)
        species_set.species[key].update(genome, {key: genome})
    return stagnation, species_set


def remaining(stagnation: Any, species_set: Any) -> list[int]:
    return sorted(key for key, _, dies in stagnation.update(species_set, 0) if not dies)


def test_the_weakest_species_are_removed(caplog: pytest.LogCaptureFixture) -> None:
    stagnation, species_set = stagnation_of(5.0, 1.0, 4.0, 2.0, 3.0, places=3)
    with caplog.at_level(logging.WARNING, logger="evoframe_evolvers"):
        assert remaining(stagnation, species_set) == [1, 3, 5]
    assert len(caplog.records) == 2
    assert "species 2:" in caplog.text
    assert "species 4:" in caplog.text
    rules = stagnation.reproduction_config
    assert (rules.elitism, rules.min_species_size) == (1, 1)


def test_among_equally_weak_species_the_oldest_are_removed() -> None:
    assert remaining(*stagnation_of(1.0, 1.0, 1.0, 1.0, places=2)) == [3, 4]


def test_species_that_fit_are_not_changed() -> None:
    stagnation, species_set = stagnation_of(1.0, 2.0, 3.0, places=6)
    assert remaining(stagnation, species_set) == [1, 2, 3]
    assert stagnation.reproduction_config.elitism == 2


def test_an_extinct_species_leaves_its_place_to_the_others() -> None:
    stagnation, species_set = stagnation_of(1.0, 2.0, 3.0, places=2, max_stagnation=1, species_elitism=0)
    stagnation.update(species_set, 0)
    for species in species_set.species.values():
        species.last_improved = 9
    species_set.species[3].last_improved = 0  # the fittest has not improved
    assert sorted(key for key, _, dies in stagnation.update(species_set, 9) if not dies) == [1, 2]


def test_after_extinction_the_population_is_initialized_again(caplog: pytest.LogCaptureFixture) -> None:
    run = Neat(species_elitism=0, max_stagnation=1).start(3, 2, 6, np.random.default_rng(0))
    for _ in range(2):
        run.ask()
        run.tell(np.zeros(6), {})
    with caplog.at_level(logging.WARNING, logger="evoframe_evolvers"):
        fresh = run.ask()
    assert "generation 1;" in caplog.text
    assert all(len(genome.nodes) == 2 and len(genome.connections) == 6 for genome in fresh)
    assert [member.age for member in run.members()] == [0] * 6
    assert [member.fitness for member in run.members()] == [None] * 6
    assert min(member.id for member in run.members()) > 6
    play_on = run.state()
    run.tell(np.arange(6.0), {})
    assert play_on["cohort"]["generation"] == 2
