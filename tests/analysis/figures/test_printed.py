"""Tests of line breaks of names, which only drop the middle of very long names."""

from __future__ import annotations

import pytest
from hypothesis import given, strategies as st

from evoframe.analysis.figures.printed import break_lines, text_width

ASCII = st.text(st.characters(min_codepoint=32, max_codepoint=126))


@given(ASCII)
def test_no_line_is_too_wide(name: str) -> None:
    assert text_width(break_lines(name, 1.0, 7), 7) <= 1.0


@given(ASCII.filter(lambda name: len(name) < 30))
def test_nothing_is_lost(name: str) -> None:
    assert break_lines(name, 1.0, 7).split() == break_lines(break_lines(name, 1.0, 7), 1.0, 7).split()
    assert "".join(break_lines(name, 1.0, 7).split()) == "".join(name.split())


@pytest.mark.parametrize(
    ("name", "lines"),
    [
        ("", [""]),
        ("AM", ["AM"]),
        ("best-and-worst (n = 10, aggregator = WM)", ["best-and-worst", "(n = 10,", "aggregator = WM)"]),
        ("/home/somebody/runs/a", ["/home/somebody/", "runs/a"]),
        ("several_underscores_here", ["several_", "underscores_here"]),
        ("x" * 1000, ["x" * 17, "x" * 17, "x" * 17, "...", "x" * 17, "x" * 14]),
    ],
)
def test_lines_break_between_words(name: str, lines: list[str]) -> None:
    assert break_lines(name, 1.0, 7).split("\n") == lines
