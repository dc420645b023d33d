"""Tests of trees of tables: their leaves, and the differences of two trees."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import pytest
from hypothesis import given, strategies as st

from evoframe.documents.trees import as_read, differences, leaves

trees = st.recursive(
    st.integers() | st.text(max_size=3) | st.lists(st.integers(), max_size=2),
    lambda inner: st.dictionaries(st.text("abc", min_size=1, max_size=2), inner, max_size=3),
    max_leaves=6,
)
tables = st.dictionaries(st.text("abc", min_size=1, max_size=2), trees, max_size=3)


@given(tables, tables)
def test_only_unequal_trees_differ(first: dict[str, object], second: dict[str, object]) -> None:
    assert differences(first, first) == []
    assert bool(differences(first, second)) == (first != second)


@given(tables, tables)
def test_swapping_the_trees_gives_the_same_keys(first: dict[str, object], second: dict[str, object]) -> None:
    there, back = differences(first, second), differences(second, first)
    assert {line.partition(": ")[0] for line in there} == {line.partition(": ")[0] for line in back}


@pytest.mark.parametrize(
    ("now", "lines"),
    [
        ({"run": {"seed": 1}, "weights": [1, 2]}, []),
        ({"run": {"seed": 2}, "weights": [1, 2]}, ["run.seed: 1 then, 2 now"]),
        (
            {"run": {}, "weights": [1]},
            [
                "run.seed: 1 then, not set now",
                "weights: [1, 2] then, [1] now",
                "run: not set then, {} now",
            ],
        ),
        (
            {"run": 3, "weights": [1, 2], "more": "x"},
            [
                "run.seed: 1 then, not set now",
                "run: not set then, 3 now",
                "more: not set then, 'x' now",
            ],
        ),
    ],
)
def test_a_difference_is_named_by_its_key(now: dict[str, Any], lines: list[str]) -> None:
    assert differences({"run": {"seed": 1}, "weights": [1, 2]}, now) == lines


def test_differences_name_the_trees_with_the_given_words() -> None:
    assert differences({"a": 1}, {"a": 2}, ("there", "here")) == ["a: 1 there, 2 here"]


def grown(pairs: Iterable[tuple[str, Any]]) -> dict[str, Any]:
    """Return the tree with these leaves."""
    tree: dict[str, Any] = {}
    for path, value in pairs:
        *branches, last = path.split(".")
        table = tree
        for branch in branches:
            table = table.setdefault(branch, {})
        table[last] = value
    return tree


@given(tables)
def test_a_tree_can_be_rebuilt_from_its_leaves(tree: dict[str, Any]) -> None:
    assert grown(leaves(tree)) == tree


@given(tables)
def test_tables_that_were_read_do_not_change(tree: dict[str, Any]) -> None:
    assert as_read(tree) == tree


def test_tuples_are_read_as_lists() -> None:
    assert as_read({"a": (1, (2.5, "x")), "b": {"c": ()}}) == {"a": [1, [2.5, "x"]], "b": {"c": []}}
