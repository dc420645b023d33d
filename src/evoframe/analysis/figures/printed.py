"""Style of printed figures: widths, colors, and line breaks of names.

The colors are those of Okabe and Ito (2008), which color-blind people can distinguish. Yellow is omitted,
since it is barely visible on white.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator

from matplotlib.font_manager import FontProperties
from matplotlib.textpath import text_to_path

__all__ = ["BOTH_COLUMNS", "COLOURS", "COLUMN", "DASHES", "break_lines", "row_height", "text_width"]

COLUMN, BOTH_COLUMNS = 3.5, 7.0
"""Width of one column of an article, and of its two columns, in inches."""

COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000")
DASHES = ("-", (0, (5, 1.5)), (0, (1, 1)), (0, (5, 1.5, 1, 1.5)))
"""Seven colors and four dash patterns, which distinguish up to 28 lines."""

_LINES = 6  # greatest number of lines of a name
_LINE = 0.13  # height of a line of a label, in inches


def break_lines(name: str, width: float, size: float) -> str:
    """Return a name with line breaks after blanks, slashes and underscores, but not within ``n = 2``.

    If there are more than six lines, those in the middle are omitted, because names usually differ at their
    ends.

    Args:
        name: The name.
        width: Width of the lines, in inches.
        size: Font size, in points.
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
    """Return the smallest pieces of a name: words, or the letters of a word that is wider than a line."""
    for word in re.findall(r"(?:[^ /_]| = )*[ /_]?", name):
        if text_width(word.rstrip(), size) <= width:
            yield word
        else:
            yield from word


def text_width(text: str, size: float, weight: str = "normal") -> float:
    """Return the width of the widest line, in inches."""
    font = FontProperties(size=size, weight=weight)
    lines = text.split("\n")
    return max(text_to_path.get_text_width_height_descent(line, font, ismath=False)[0] for line in lines) / 72


def row_height(labels: Iterable[str], least: float) -> float:
    """Return the distance between labels in a font of seven points, in inches; at least *least*."""
    return max(least, 0.08 + _LINE * max(label.count("\n") + 1 for label in labels))
