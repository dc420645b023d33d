"""Tests of statistics within blocks, against R's output and by invariants."""

from __future__ import annotations

import random
import re

import numpy as np
import pytest
from hypothesis import given, settings, strategies as st

from evoframe.analysis.statistics.blocks import compare_blocks

# Times of 22 players to round first base by three methods. Hollander and Wolfe 1973, 140 ff., as in the
# example of R's manual page of friedman.test.
_TIMES = """
5.40 5.50 5.55  5.85 5.70 5.75  5.20 5.60 5.50  5.55 5.50 5.40  5.90 5.85 5.70  5.45 5.55 5.60
5.40 5.40 5.35  5.45 5.50 5.35  5.25 5.15 5.00  5.85 5.80 5.70  5.25 5.20 5.10  5.65 5.55 5.45
5.60 5.35 5.45  5.05 5.00 4.95  5.50 5.50 5.40  5.45 5.55 5.50  5.55 5.55 5.35  5.45 5.50 5.55
5.50 5.45 5.25  5.65 5.60 5.40  5.70 5.65 5.55  6.30 6.30 6.25
"""
TIMES = np.array(_TIMES.split(), dtype=np.float64).reshape(22, 3)
METHODS = dict(zip(("round out", "narrow angle", "wide angle"), TIMES.T.tolist(), strict=True))


def test_friedman_is_that_of_r() -> None:
    comparison = compare_blocks(METHODS)
    # chi-squared is 11.143 with 2 degrees of freedom, the p-value 0.003805.
    assert comparison.chi_squared == pytest.approx(11.143, abs=5e-4)
    assert comparison.p == pytest.approx(0.003805, abs=5e-7)
    assert comparison.kendall_w == pytest.approx(11.143 / 44, abs=2e-5)
    assert comparison.names[-1] == "wide angle"  # the fastest
    assert comparison.blocks == 22


def test_wilcoxon_is_that_of_r() -> None:
    # wilcox.test(x, y, paired = TRUE, alternative = "greater"), the example of its manual page, after
    # Hollander and Wolfe 1973, 29 ff.: depression at a first and a second visit; p is 0.01953, V is 40 of 45.
    first = [1.83, 0.50, 1.62, 2.48, 1.68, 1.88, 1.55, 3.06, 1.30]
    second = [0.878, 0.647, 0.598, 2.05, 1.06, 1.29, 1.06, 3.14, 1.29]
    [pair] = compare_blocks({"first": first, "second": second}).pairs
    assert pair.p == pytest.approx(2 * 0.01953, abs=1e-5)
    assert (pair.first, pair.direction) == ("first", 1)
    assert pair.wins == pytest.approx(7 / 9)


def test_five_blocks_are_too_few_for_any_difference() -> None:
    [pair] = compare_blocks({"low": [1.0, 2.0, 3.0, 4.0, 5.0], "high": [2.0, 4.0, 6.0, 8.0, 10.0]}).pairs
    assert pair.p == 0.0625  # 2 of the 32 sign patterns are as extreme


def test_a_ranking_marks_a_contradiction_to_its_test() -> None:
    # A wins slightly more often than B, but loses by larger margins.
    wins, losses = [1.0 + 0.01 * n for n in range(13)], [-50.0 - n for n in range(12)]
    comparison = compare_blocks({"A": wins + losses, "B": [0.0] * 25})
    assert comparison.names == ("A", "B")
    assert comparison.pairs[0].direction == -1
    assert comparison.ranking(alpha=0.5) == "A < B"


values = st.lists(st.tuples(*[st.integers(-50, 50)] * 3), min_size=1, max_size=20)


def groups(blocks: list[tuple[int, ...]]) -> dict[str, list[float]]:
    return {name: [float(block[i]) for block in blocks] for i, name in enumerate("ABC")}


@given(values, st.randoms(use_true_random=False))
def test_the_order_of_blocks_and_groups_changes_nothing(
    blocks: list[tuple[int, ...]], chance: random.Random
) -> None:
    one = compare_blocks(groups(blocks))
    shuffled = groups(chance.sample(blocks, len(blocks)))
    other = compare_blocks({name: shuffled[name] for name in chance.sample("ABC", 3)})
    assert one.names == other.names
    assert one.p == pytest.approx(other.p)
    assert [pair.p for pair in one.pairs] == pytest.approx([pair.p for pair in other.pairs])
    assert [pair.wins for pair in one.pairs] == [pair.wins for pair in other.pairs]


@given(values, st.lists(st.integers(-1000, 1000), min_size=20, max_size=20))
def test_an_offset_of_a_whole_block_changes_nothing(
    blocks: list[tuple[int, ...]], offsets: list[int]
) -> None:
    moved = [tuple(value + extra for value in block) for block, extra in zip(blocks, offsets, strict=False)]
    one, other = compare_blocks(groups(blocks)), compare_blocks(groups(moved))
    assert one.p == pytest.approx(other.p)
    assert one.mean_ranks == pytest.approx(other.mean_ranks)
    assert [pair.p for pair in one.pairs] == pytest.approx([pair.p for pair in other.pairs])


@pytest.mark.parametrize(("blocks", "tested"), [(4, False), (5, True)])
def test_fewer_than_five_blocks_are_not_tested(blocks: int, tested: bool) -> None:
    low, high = [float(n) for n in range(blocks)], [n + 1.5 for n in range(blocks)]
    comparison = compare_blocks({"low": low, "high": high})
    assert comparison.tested == tested
    assert comparison.ranking() == ("high = low" if tested else "high, low")


@given(st.lists(st.integers(-50, 50), min_size=1, max_size=20))
def test_identical_groups_are_tied(given_values: list[int]) -> None:
    same = [float(value) for value in given_values]
    comparison = compare_blocks({"A": same, "B": same, "C": same})
    assert comparison.p == 1.0
    assert {pair.wins for pair in comparison.pairs} == {0.5}
    assert set(comparison.mean_ranks.values()) == {2.0}


@given(st.lists(st.floats(-1000, 1000), min_size=12, max_size=30))
def test_a_small_advantage_in_every_block_is_found(given_values: list[float]) -> None:
    better = [value + 1.0 for value in given_values]
    comparison = compare_blocks({"worse": given_values, "better": better})
    assert comparison.names == ("better", "worse")
    assert comparison.pairs[0].wins == 1.0
    assert comparison.p < 0.01


@settings(max_examples=15)
@given(values)
def test_a_ranking_names_every_group_from_the_best_down(blocks: list[tuple[int, ...]]) -> None:
    comparison = compare_blocks(groups(blocks))
    if not comparison.tested:
        assert comparison.ranking() == ", ".join(comparison.names)
        return
    assert comparison.ranking(0.0) == " = ".join(comparison.names)
    names = re.split(" [<>] ", comparison.ranking(1.1))
    assert names == list(comparison.names)
    ranks = [comparison.mean_ranks[name] for name in comparison.names]
    assert ranks == sorted(ranks, reverse=True)


@settings(max_examples=15)
@given(values)
def test_a_pair_is_found_in_both_orders(blocks: list[tuple[int, ...]]) -> None:
    comparison = compare_blocks(groups(blocks))
    for pair in comparison.pairs:
        there, back = (comparison.pair(pair.first, pair.second), comparison.pair(pair.second, pair.first))
        assert there == pair
        assert (back.first, back.p, back.wins) == (pair.second, pair.p, 1 - pair.wins)
        assert back.direction == -pair.direction
    with pytest.raises(KeyError):
        comparison.pair("A", "nobody")


@pytest.mark.parametrize(
    "given_groups",
    [{"A": [1.0]}, {"A": [1.0], "B": [1.0, 2.0]}, {"A": [], "B": []}, {"A": [1.0], "B": [float("nan")]}],
)
def test_values_that_are_not_blocks_are_rejected(given_groups: dict[str, list[float]]) -> None:
    with pytest.raises(ValueError, match=r"^expected "):
        compare_blocks(given_groups)
