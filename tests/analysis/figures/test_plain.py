"""Tests of literal texts: names with dollar signs are not parsed as formulas."""

from __future__ import annotations

import matplotlib as mpl
import pytest

from evoframe.analysis.drawing import Figure
from evoframe.analysis.figures.plain import plain


@plain
def titled(title: str) -> Figure:
    """Return a figure with a title."""
    figure = Figure()
    figure.suptitle(title)
    return figure


@pytest.mark.parametrize("name", ["$x$", "cost$^$", "$"])
def test_texts_are_literal(name: str) -> None:
    figure = titled(name)
    figure.draw_without_rendering()
    assert [text.get_parse_math() for text in figure.texts] == [False]
    assert figure.get_suptitle() == name


def test_other_figures_still_parse_formulas() -> None:
    titled("x")
    assert mpl.rcParams["text.parse_math"]


def test_name_and_docstring_are_kept() -> None:
    assert titled.__name__ == "titled"
    assert titled.__doc__ == "Return a figure with a title."
