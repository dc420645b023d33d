"""Tests of pairs: look-up in both orders, and rankings with the signs of neighbors."""

from __future__ import annotations

from itertools import combinations, pairwise

import pytest
from hypothesis import given, strategies as st

from evoframe.analysis.statistics.blocks import BlockPair
from evoframe.analysis.statistics.pairs import find_pair, format_ranking, orient

pairs = st.builds(
    BlockPair,
    first=st.just("A"),
    second=st.just("B"),
    p=st.floats(0, 1),
    wins=st.sampled_from([0.0, 0.25, 0.5, 1.0]),
    direction=st.sampled_from([-1, 0, 1]),
)


@given(pairs)
def test_swapping_twice_returns_the_same_pair(pair: BlockPair) -> None:
    assert pair.turned().turned() == pair
    assert find_pair([pair], "A", "B") == pair
    assert find_pair([pair], "B", "A") == pair.turned()


@given(pairs)
def test_the_greater_group_comes_first(pair: BlockPair) -> None:
    found = orient(pair)
    assert found.direction == abs(pair.direction)
    assert found in {pair, pair.turned()}


def test_an_unknown_pair_is_an_error() -> None:
    with pytest.raises(KeyError, match="A, C"):
        find_pair([BlockPair("A", "B", 1.0, 0.5, 0)], "A", "C")


@given(st.lists(st.tuples(st.floats(0, 1), st.sampled_from([-1, 1])), min_size=1, max_size=6))
def test_a_sign_compares_its_two_neighbors(tests: list[tuple[float, int]]) -> None:
    names = [f"G{number}" for number in range(len(tests) + 1)]
    neighbors = dict(zip(pairwise(names), tests, strict=True))
    found = []
    for one, other in combinations(names, 2):
        p, direction = neighbors.get((one, other), (0.0, 1))
        found.append(BlockPair(one, other, p, 0.5, direction))
    ranking = format_ranking(names, lambda one, other: find_pair(found, one, other), 0.05)
    signs = ["=" if p >= 0.05 else ">" if direction > 0 else "<" for p, direction in tests]
    assert ranking.split()[::2] == names
    assert ranking.split()[1::2] == signs
