"""Tests of LaTeX tables: escaping, parts, digits, and widths."""

from __future__ import annotations

import re

import pandas as pd
import pytest
from hypothesis import given, strategies as st

from evoframe.analysis.output.latex import decimals, fixed, latex_table, p_cell, quartiles_cell

TABLE = pd.DataFrame(
    {"heading": ["one", "one", "two"], "name": ["a_b", "50% > x", "|c|"], "p": ["< 0.001", "0.500", "-"]}
)


def body(latex: str) -> list[str]:
    """Return the lines between the rules."""
    return latex.partition("\\midrule\n")[2].partition("\\bottomrule")[0].splitlines()


def test_lines_are_escaped_below_their_headings() -> None:
    latex = latex_table(TABLE, by=["heading"])
    assert body(latex) == [
        r"\multicolumn{2}{@{}l}{\textit{one}} \\",
        r"a\_b & \textless{} 0.001 \\",
        r"50\% \textgreater{} x & 0.500 \\",
        r"\addlinespace",
        r"\multicolumn{2}{@{}l}{\textit{two}} \\",
        r"\textbar{}c\textbar{} & - \\",
    ]
    assert r"\begin{tabular}{@{}lr@{}}" in latex
    assert latex.startswith("% ")
    assert "\\columnwidth" in latex


def test_a_long_text_is_wrapped() -> None:
    latex = latex_table(TABLE, wrapped="name")
    assert r"\begin{tabular}{@{}l>{\raggedright}p{0.5\columnwidth}r@{}}" in latex
    assert len(body(latex)) == 3


@given(st.lists(st.integers(1, 120), min_size=1, max_size=6))
def test_a_long_table_has_parts_that_fit_into_a_column(sizes: list[int]) -> None:
    rows = [(f"block {block}", f"{block}x{line}") for block, size in enumerate(sizes) for line in range(size)]
    latex = latex_table(pd.DataFrame(rows, columns=["heading", "name"]), by=["heading"])
    parts = latex.split("\\begin{tabular}")[1:]
    assert re.findall(r"^\d+x\d+", latex, re.MULTILINE) == [name for _, name in rows]
    for part in parts:
        lines = [line for line in body(part) if line != r"\addlinespace"]
        assert len(lines) <= 46
        assert lines[0].startswith(r"\multicolumn")
        assert not lines[-1].startswith(r"\multicolumn")
    if sum(sizes) + len(sizes) <= 40:
        assert len(parts) == 1


def test_an_empty_table_has_a_header() -> None:
    latex = latex_table(TABLE[:0], by=["heading"])
    assert r"name & p \\" in latex
    assert body(latex) == []


@pytest.mark.parametrize(
    ("error", "value", "shown"),
    [(0.011, 5.0996, "5.10"), (0.008, 5.0996, "5.100"), (30.0, 512.7, "513"), (1e-9, 5.0996224, "5.1")],
)
def test_the_standard_error_determines_the_digits(error: float, value: float, shown: str) -> None:
    assert fixed(value, decimals([error, 1.0, 0.0])) == shown


def test_without_a_spread_there_are_four_digits() -> None:
    places = decimals([0.0])
    assert places is None
    assert quartiles_cell(1.23456, 2.0, places) == "1.235 to 2"
    assert fixed(1.5e9, 3) == "1.5e+09"


@pytest.mark.parametrize(("p", "cell"), [(None, "-"), (0.0009, "< 0.001"), (0.0123, "0.012"), (1.0, "1.000")])
def test_a_p_value_has_three_decimals(p: float | None, cell: str) -> None:
    assert p_cell(p) == cell
