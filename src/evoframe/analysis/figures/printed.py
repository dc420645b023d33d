"""What printed figures have in common: widths, colours, and names broken into lines that fit.

The colours are those of Okabe and Ito (2008), which people who do not see all colours tell apart, but for
their yellow, which is hardly seen on white.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator

from matplotlib.font_manager import FontProperties
from matplotlib.textpath import text_to_path

__all__ = ["BOTH_COLUMNS", "COLOURS", "COLUMN", "DASHES", "broken", "row_height", "text_width"]

COLUMN, BOTH_COLUMNS = 3.5, 7.0
"""Inches: the width of a column of an article, and of its text, which has two of them."""

COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000")
DASHES = ("-", (0, (5, 1.5)), (0, (1, 1)), (0, (5, 1.5, 1, 1.5)))
"""Seven colours and four dashes: lines that count up both differ up to the 28th."""

_LINES = 6  # of a name
_LINE = 0.13  # inches, of a label


def broken(name: str, width: float, size: float) -> str:
    """Return a name in lines that fit, broken after blanks, slashes and underscores, not within ``n = 2``.

    Of more than six lines those in the middle are left out: what distinguishes names of one kind is rather at
    their ends.

    Args:
        name: What is broken.
        width: Of the lines, in inches.
        size: Of the letters, in points.
    """
    lines = [""]
    for piece in _pieces(name, width, size):
        if lines[-1] and text_width(lines[-1] + piece.rstrip(), size) > width:
            lines.append("")
        lines[-1] += piece
    if len(lines) > _LINES:
        half = _LINES // 2
        lines = [*lines[:half], "...", *lines[1 - half :]]
    return "\n".join(line.rstrip() for line in lines)


def _pieces(name: str, width: float, size: float) -> Iterator[str]:
    """Return what a name is broken into at most; single letters where a word is wider than a line."""
    for word in re.findall(r"(?:[^ /_]| = )*[ /_]?", name):
        if text_width(word.rstrip(), size) <= width:
            yield word
        else:
            yield from word


def text_width(text: str, size: float, weight: str = "normal") -> float:
    """Return the width of the longest line, in inches."""
    font = FontProperties(size=size, weight=weight)
    lines = text.split("\n")
    return max(text_to_path.get_text_width_height_descent(line, font, ismath=False)[0] for line in lines) / 72


def row_height(labels: Iterable[str], least: float) -> float:
    """Return how far labels of seven points are from each other, in inches: *least*, or what they need."""
    return max(least, 0.08 + _LINE * max(label.count("\n") + 1 for label in labels))
