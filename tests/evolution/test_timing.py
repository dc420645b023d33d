"""Tests of the order in which populations reproduce."""

from __future__ import annotations

import collections
from collections.abc import Callable

import pytest
from hypothesis import given, strategies as st

from evoframe import RunConfig
from evoframe.evolution import timing_of
from evoframe.evolution.timing import Timing

weights = st.lists(st.integers(1, 4), min_size=1, max_size=4).map(tuple)
generations = st.integers(0, 5)


def order(timing: Timing, pairs: int = 10) -> list[tuple[int, ...]]:
    """Return the populations of each turn, if each scores the same number of pairs."""
    clocks: tuple[float, ...] = (0.0,) * len(timing.weights)
    clocks = timing.advanced(clocks, 0, range(len(timing.weights)), pairs)
    turns = []
    for turn in range(1, timing.length + 1):
        turns.append(timing.reproducing(turn, clocks))
        clocks = timing.advanced(clocks, turn, turns[-1], pairs)
    return turns


@given(weights=weights, generations=generations)
def test_in_sequence_each_round_has_the_turns_of_each_population_in_order(
    weights: tuple[int, ...], generations: int
) -> None:
    one_round = [(index,) for index, weight in enumerate(weights) for _ in range(weight)]
    assert order(Timing("sequential", weights, generations)) == one_round * generations


@given(populations=st.integers(1, 4), generations=generations)
def test_in_parallel_all_reproduce_in_each_turn(populations: int, generations: int) -> None:
    timing = Timing("parallel", (1,) * populations, generations)
    assert order(timing) == [tuple(range(populations))] * generations


@given(weights=weights, generations=generations, seed=st.integers(0, 2**32))
def test_asynchronous_turns_are_as_many_as_sequential_ones_with_one_population_each(
    weights: tuple[int, ...], generations: int, seed: int
) -> None:
    turns = order(Timing("asynchronous", weights, generations, seed))
    assert len(turns) == generations * sum(weights)
    assert all(len(turn) == 1 for turn in turns)
    assert turns == order(Timing("asynchronous", weights, generations, seed))


@given(weights=weights, seed=st.integers(0, 2**32))
def test_asynchronous_populations_take_turns_in_proportion_to_their_weights(
    weights: tuple[int, ...], seed: int
) -> None:
    """A turn of 400 pairs takes nearly the same time each time."""
    counts = collections.Counter(index for (index,) in order(Timing("asynchronous", weights, 20, seed), 400))
    for index, weight in enumerate(weights):
        assert counts[index] == pytest.approx(20 * weight, rel=0.2, abs=2)


@given(seed=st.integers(0, 2**32), turn=st.integers(1, 100), pairs=st.integers(0, 500))
def test_only_the_clocks_of_populations_that_reproduced_advance(seed: int, turn: int, pairs: int) -> None:
    timing = Timing("asynchronous", (1, 2, 1), 5, seed)
    before = (3.0, 1.0, 2.0)
    one, other = timing.advanced(before, turn, [1], pairs), timing.advanced(before, turn, [0], pairs)
    assert (one[0], one[2]) == (before[0], before[2])
    assert one[1] > before[1]
    assert other[0] - before[0] == pytest.approx(2 * (one[1] - before[1]), rel=1e-9)
    assert timing.advanced(before, turn, [], pairs) == before


@pytest.mark.parametrize("kind", ["sequential", "parallel"])
def test_only_asynchronous_timing_has_clocks(kind: str) -> None:
    assert Timing(kind, (1, 1), 5).advanced((0.0, 0.0), 1, [0], 10) == (0.0, 0.0)


def test_the_population_whose_clock_is_behind_is_the_next_and_ties_are_broken_by_index() -> None:
    timing = Timing("asynchronous", (1, 1, 1), 5)
    assert timing.reproducing(1, (3.0, 1.0, 2.0)) == (1,)
    assert timing.reproducing(1, (2.0, 1.0, 1.0)) == (1,)


def test_the_irregular_order_depends_on_the_seed() -> None:
    orders = {tuple(order(Timing("asynchronous", (1, 1), 20, seed))) for seed in range(10)}
    assert len(orders) == 10


def test_a_configuration_gives_kind_weights_length_and_seed(
    toy_config: Callable[..., RunConfig],
) -> None:
    assert timing_of(toy_config()) == Timing("sequential", (1, 1), 4, 3)
    changed = toy_config("run.timing=asynchronous", "populations.b.turns=3", "run.seed=9")
    assert timing_of(changed) == Timing("asynchronous", (1, 3), 4, 9)
    assert timing_of(changed).length == 16
    assert timing_of(toy_config("run.timing=parallel")).length == 4
