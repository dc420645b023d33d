"""Names with dollar signs are no formulas."""

from __future__ import annotations

import matplotlib as mpl
import pytest
from matplotlib.figure import Figure

from evoframe.analysis.figures.plain import plain


@plain
def titled(title: str) -> Figure:
    """Return a figure with a title."""
    figure = Figure()
    figure.suptitle(title)
    return figure


@pytest.mark.parametrize("name", ["$x$", "cost$^$", "$"])
def test_texts_are_drawn_as_they_are(name: str) -> None:
    figure = titled(name)
    figure.draw_without_rendering()
    assert [text.get_parse_math() for text in figure.texts] == [False]
    assert figure.get_suptitle() == name


def test_figures_of_others_still_have_formulas() -> None:
    titled("x")
    assert mpl.rcParams["text.parse_math"]


def test_it_is_the_function_that_it_was() -> None:
    assert titled.__name__ == "titled"
    assert titled.__doc__ == "Return a figure with a title."
