"""Tests of initial populations that are the best of several random ones."""

from __future__ import annotations

import statistics
from collections.abc import Callable

import pytest
from loops import continued, history

from evoframe import ConfigurationError, RunConfig, assemble

Load = Callable[..., RunConfig]

WANTING = "populations.a.evolver={name='toy-wanting', wants=[]}"


def initial(config: RunConfig, population: int) -> list[float]:
    """Return the genomes of a population in the initial turn, before any selection."""
    with assemble(config) as coevolution:
        next(iter(coevolution))
        return list(coevolution.populations[population].genomes)


def drawn(config: RunConfig) -> list[tuple[float, float]]:
    """Return the mean score and the genome of each individual of all draws."""
    found = []
    with assemble(config) as coevolution:
        for draw in coevolution.drafts.populations:
            for population in draw:
                population.reproduce()
            ones, others = (population.genomes for population in draw)
            found += [(statistics.fmean(one * other for other in others), one) for one in ones]
    return found


def test_the_fittest_individuals_of_all_draws_are_chosen(toy_config: Load) -> None:
    config = toy_config(WANTING, "populations.a.start.draws=4")
    best = sorted(drawn(config), key=lambda pair: -pair[0])[: config.populations["a"].size]
    assert initial(config, 0) == [genome for _, genome in best]


def test_the_least_fit_are_chosen_by_a_population_that_minimizes(toy_config: Load) -> None:
    config = toy_config(WANTING, "populations.a.start.draws=4", "populations.a.goal=minimize")
    best = sorted(drawn(config))[: config.populations["a"].size]
    assert initial(config, 0) == [genome for _, genome in best]


def test_a_population_with_one_draw_is_that_of_a_run_without_draws(toy_config: Load) -> None:
    assert initial(toy_config(WANTING, "populations.a.start.draws=3"), 1) == initial(toy_config(WANTING), 1)


def test_their_simulations_are_those_of_the_initial_turn(toy_config: Load) -> None:
    with assemble(toy_config(WANTING, "populations.a.start.draws=3")) as coevolution:
        turn = next(iter(coevolution))
        assert turn.workload.simulations == coevolution.evaluator.simulations > len(turn.pairs)


def test_a_run_with_draws_continues_as_without_an_interruption(toy_config: Load) -> None:
    config = toy_config(WANTING, "populations.a.start.draws=3")
    left = assemble(config)
    before = [next(iter(left))]
    assert history([*before, *continued(config, left)]) == history(assemble(config))


def test_an_evolver_must_accept_genomes(toy_config: Load) -> None:
    with assemble(toy_config("populations.b.start.draws=2")) as coevolution:
        with pytest.raises(ConfigurationError, match="cannot start with given genomes") as caught:
            next(iter(coevolution))
        assert caught.value.key == "populations.b.evolver"


@pytest.mark.parametrize("start", ["{draws=0}", "{draws=2, run='there'}", "{draw=2}", "{take='best'}"])
def test_other_settings_are_refused(toy_config: Load, start: str) -> None:
    with pytest.raises(ConfigurationError) as caught:
        toy_config(f"populations.a.start={start}")
    assert caught.value.key.startswith("populations.a.start")
