"""Tests of names for files and links."""

from __future__ import annotations

import re

from hypothesis import given, strategies as st

from evoframe.analysis.output.names import slugs


@given(st.lists(st.text(max_size=8) | st.text("ab-.", min_size=50), unique=True, max_size=8))
def test_different_titles_get_different_names(titles: list[str]) -> None:
    found = slugs(titles)
    assert len({name.casefold() for name in found}) == len(titles)
    assert all(re.fullmatch("[A-Za-z0-9][A-Za-z0-9.-]*", name) for name in found)
    assert all(len(name) <= 62 for name in found)


def test_names_resemble_titles() -> None:
    assert slugs(["score n = 2", "score best of each"]) == ["score-n-2", "score-best-of-each"]
    assert slugs(["mean = -1.0", "mean = 1.0"]) == ["mean-minus-1.0", "mean-1.0"]
    assert slugs(["Champion", "champion", "\u5b9e\u9a8c"]) == ["Champion", "champion-2", "unnamed"]


def test_long_titles_are_truncated() -> None:
    assert slugs(["a" * 300, "a" * 299 + "b"]) == ["a" * 60, "a" * 60 + "-2"]
    assert slugs(["a" * 59 + " b"]) == ["a" * 59]
