import math
from collections.abc import Callable
from typing import Any

import attrs
import numpy as np
import pytest
from collaborators import SEEDS, chosen, members_of, population
from hypothesis import given, strategies as st

from evoframe import Member
from evoframe_strategies import BestAndRandom, Fittest, Random, Rank, Roulette, Tournament

DRAWS = 2000


def assert_shares(counts: Any, expected: Any) -> None:
    """Assert that members were drawn with the *expected* probabilities, within five standard deviations."""
    p = np.asarray(expected)
    assert (abs(np.asarray(counts) - DRAWS * p) <= 5 * np.sqrt(DRAWS * p * (1 - p))).all(), counts


def drawn(strategy: Any, members: list[Member]) -> Any:
    """Return how often each member is chosen."""
    rng = np.random.default_rng(1)
    counts = np.zeros(len(members))
    for _ in range(DRAWS):
        counts[strategy.select(members, rng)] += 1
    return counts


@pytest.mark.parametrize(
    "strategy", [Random(n=3), Tournament(n=3, tournament_size=1), Rank(n=3, pressure=1.0)]
)
def test_everyone_is_drawn_equally_often(strategy: Any) -> None:
    assert_shares(drawn(strategy, population(*range(10))), [0.3] * 10)


def test_random_draws_as_in_the_first_release() -> None:
    draws = [chosen(Random(n=3), population(*range(10)), seed) for seed in range(3)]
    assert draws == [[5, 9, 6], [4, 3, 7], [2, 1, 6]]


@pytest.mark.parametrize("strategy", [Random(n=5), Tournament(n=5), Roulette(n=5), Rank(n=5)])
def test_the_order_is_that_in_which_members_are_drawn(strategy: Any) -> None:
    orders = [chosen(strategy, population(*range(10)), seed) for seed in range(20)]
    assert any(order != sorted(order) for order in orders)
    assert any(order != sorted(order, reverse=True) for order in orders)


@pytest.mark.parametrize("class_", [Random, Tournament, Roulette, Rank, BestAndRandom])
def test_diverged_members_are_drawn_after_the_clean_ones(class_: Callable[..., Any]) -> None:
    members = population(*range(6), diverged=(0, 2, 3, 5))
    seen = set()
    for seed in range(40):
        choice = chosen(class_(n=4), members, seed)
        assert set(choice[:2]) == {1, 4}
        assert set(choice[2:]) < {0, 2, 3, 5}
        seen.add(tuple(choice[2:]))
    assert len(seen) > 1


def test_random_needs_no_fitness() -> None:
    assert len(chosen(Random(), population(None, None, None))) == 2


@given(members_of(), SEEDS, st.data())
def test_best_and_random_begins_with_the_fittest(
    members: list[Member], seed: int, data: st.DataObject
) -> None:
    n = data.draw(st.integers(1, len(members)))
    choice = chosen(BestAndRandom(n=n), members, seed)
    assert choice[:1] == chosen(Fittest(n=1), members)
    assert len(set(choice)) == n


def test_best_and_random_draws_the_others_equally_often() -> None:
    assert_shares(drawn(BestAndRandom(n=3), population(*range(10))), [2 / 9] * 9 + [1.0])


@given(members_of(), SEEDS, st.data())
def test_a_tournament_of_everybody_is_won_by_the_fittest(
    members: list[Member], seed: int, data: st.DataObject
) -> None:
    n = data.draw(st.integers(1, len(members)))
    contestants = data.draw(st.integers(len(members), 50))
    strategy = Tournament(n=n, tournament_size=contestants)
    assert chosen(strategy, members, seed) == chosen(Fittest(n=n), members)


@given(members_of(clean=True, least=4), SEEDS, st.integers(1, 4))
def test_the_worst_win_no_tournament_against_others(members: list[Member], seed: int, size: int) -> None:
    [winner] = chosen(Tournament(n=1, tournament_size=size), members, seed)
    ranked = chosen(Fittest(n=len(members)), members)
    assert ranked.index(winner) <= len(members) - size


def test_a_tournament_of_two_is_won_in_proportion_to_the_rank() -> None:
    members = population(1.0, 4.0, 3.0, 2.0)
    wins = [0 / 6, 3 / 6, 2 / 6, 1 / 6]  # of the six pairs of four members
    assert_shares(drawn(Tournament(n=1), members), wins)


def test_roulette_draws_in_proportion_to_what_exceeds_the_worst() -> None:
    assert_shares(drawn(Roulette(n=1), population(-1.0, 0.0, 3.0)), [0.0, 1 / 5, 4 / 5])


def test_roulette_draws_equals_alike() -> None:
    assert_shares(drawn(Roulette(n=2), population(0.5, 0.5, 0.5, 0.5)), [0.5] * 4)


def test_roulette_draws_the_worst_if_no_other_is_left() -> None:
    members = population(-5.0, 1.0, 2.0)
    assert all(chosen(Roulette(n=3), members, seed)[2] == 0 for seed in range(20))


@given(members_of(), SEEDS, st.integers(-1000, 1000), st.sampled_from([0.25, 1.0, 8.0]))
def test_roulette_depends_on_differences_only(
    members: list[Member], seed: int, shift: int, scale: float
) -> None:
    others = [attrs.evolve(m, fitness=scale * ((m.fitness or 0.0) + shift)) for m in members]
    strategy = Roulette(n=len(members))
    assert chosen(strategy, members, seed) == chosen(strategy, others, seed)


@pytest.mark.parametrize("fitness", [1.7e308, 5e-324])
def test_roulette_takes_the_largest_and_the_smallest_numbers(fitness: float) -> None:
    assert sorted(chosen(Roulette(n=3), population(fitness, -fitness, 0.0))) == [0, 1, 2]


@given(members_of(clean=True, most=8), SEEDS, st.floats(1.0, 2.0), st.data())
def test_rank_depends_on_the_order_only(
    members: list[Member], seed: int, pressure: float, data: st.DataObject
) -> None:
    strategy = Rank(n=data.draw(st.integers(1, len(members))), pressure=pressure)
    others = [attrs.evolve(m, fitness=math.atan(m.fitness or 0.0)) for m in members]
    assert chosen(strategy, members, seed) == chosen(strategy, others, seed)


@pytest.mark.parametrize("pressure", [1.0, 1.5, 2.0])
def test_rank_draws_with_probabilities_that_fall_linearly(pressure: float) -> None:
    n = 5  # Baker's formula, the worst has rank 0:
    expected = [(2 - pressure) / n + 2 * rank * (pressure - 1) / (n * (n - 1)) for rank in range(n)]
    assert_shares(drawn(Rank(n=1, pressure=pressure), population(-3.0, 0.0, 0.1, 7.0, 8.0)), expected)


@pytest.mark.parametrize("pressure", [0.9, 2.1])
def test_the_pressure_is_between_1_and_2(pressure: float) -> None:
    with pytest.raises(ValueError, match="'pressure' must be"):
        Rank(pressure=pressure)


def test_a_tournament_has_contestants() -> None:
    with pytest.raises(ValueError, match="'tournament_size' must be >= 1"):
        Tournament(tournament_size=0)
