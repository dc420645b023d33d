"""Trees of tables: their leaves, and how two of them differ."""

from __future__ import annotations

from hypothesis import given, strategies as st

from evoframe.documents.trees import differences

trees = st.recursive(
    st.integers() | st.text(max_size=3) | st.lists(st.integers(), max_size=2),
    lambda inner: st.dictionaries(st.text("abc", min_size=1, max_size=2), inner, max_size=3),
    max_leaves=6,
)


tables = st.dictionaries(st.text("abc", min_size=1, max_size=2), trees, max_size=3)


@given(tables, tables)
def test_trees_differ_where_and_only_where_they_are_not_equal(
    first: dict[str, object], second: dict[str, object]
) -> None:
    assert differences(first, first) == []
    assert bool(differences(first, second)) == (first != second)
