"""LaTeX tables that fit one column of an article."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Iterator, Sequence

import pandas as pd

__all__ = ["decimals", "fixed", "latex_table", "p_cell", "quartiles_cell"]

_LINES = 45  # of a part; a longer table is split, because it does not fit into one column of a page
_MOST = 6  # decimals; smaller numbers are printed with four significant digits
_WRAPPED = r">{\raggedright}p{0.5\columnwidth}"
_SIGNS = str.maketrans(  # characters that LaTeX's default fonts replace by others
    {"<": r"\textless{}", ">": r"\textgreater{}", "|": r"\textbar{}"}
)
_NUMBER = re.compile(r"(< |-)?\d[\d.e+-]*( to -?\d[\d.e+-]*)?|-?")


def latex_table(table: pd.DataFrame, by: Sequence[str] = (), wrapped: str = "") -> str:
    r"""Return a table in LaTeX, for the packages array, booktabs and graphicx.

    The font is ``\footnotesize``; a table that is still wider than ``\columnwidth`` is scaled down. A table
    of more than 45 lines is split into parts.

    Args:
        table: The table.
        by: Columns whose values are printed as a heading above the lines that share them.
        wrapped: Column of long texts that is printed in several lines.
    """
    columns = table.drop(columns=[*by])
    kinds = [_WRAPPED if name == wrapped else "r" if _is_numeric(columns[name]) else "l" for name in columns]
    header, lines = _rows(columns)
    headings = [", ".join(map(str, row)) for row in table[[*by]].itertuples(index=False)]
    _, escaped = _rows(pd.DataFrame({"heading": headings}))
    blocks: dict[str, list[str]] = {}
    for line, heading in zip(lines, escaped if by else [""] * len(lines), strict=True):
        blocks.setdefault(heading.removesuffix(r" \\"), []).append(line)
    parts = [_part("".join(kinds), header, part) for part in _parts(blocks, len(kinds))]
    return "\n".join(["% requires \\usepackage{array,booktabs,graphicx}", *parts])


def _is_numeric(column: pd.Series) -> bool:
    return all(pd.isna(cell) or _NUMBER.fullmatch(str(cell)) for cell in column)


def _rows(table: pd.DataFrame) -> tuple[str, list[str]]:
    """Return the header and the lines of a table, escaped."""
    text = table.to_latex(index=False, na_rep="-", float_format="%.4g", escape=True)
    _, _, header, _, *lines, _, _ = text.splitlines()
    return header.translate(_SIGNS), [line.translate(_SIGNS) for line in lines]


def _parts(blocks: dict[str, list[str]], n_columns: int) -> Iterator[list[str]]:
    """Return the lines of each part, with headings; a block stays together if it fits into a part."""
    part: list[str] = []
    for heading, lines in blocks.items():
        title = [rf"\multicolumn{{{n_columns}}}{{@{{}}l}}{{\textit{{{heading}}}}} \\"] if heading else []
        if part and len(part) + len(title) + len(lines) > _LINES:
            yield part
            part = []
        space = [r"\addlinespace"] if part and title else []
        part += [*space, *title, *lines[: _LINES - 1]]
        for start in range(_LINES - 1, len(lines), _LINES - 1):
            yield part
            part = [*title, *lines[start : start + _LINES - 1]]
    yield part


def _part(kinds: str, header: str, lines: Sequence[str]) -> str:
    return "\n".join(
        [
            r"\begingroup\footnotesize\setlength{\tabcolsep}{4pt}%",
            r"\sbox0{%",
            rf"\begin{{tabular}}{{@{{}}{kinds}@{{}}}}",
            *(r"\toprule", header, r"\midrule", *lines, r"\bottomrule"),
            r"\end{tabular}}%",
            r"\noindent\ifdim\wd0>\columnwidth\resizebox{\columnwidth}{!}{\usebox0}\else\usebox0\fi",
            r"\par\endgroup",
            "",
        ]
    )


def decimals(errors: Iterable[float]) -> int | None:
    """Return the decimals to the first digit of the smallest standard error; ``None`` if more than six."""
    positive = [error for error in errors if error > 0]
    if not positive:
        return None
    needed = max(0, -math.floor(math.log10(min(positive))))
    return needed if needed <= _MOST else None


def fixed(value: float, places: int | None) -> str:
    """Return a number with *places* decimals; with four significant digits if ``None`` or 1e6 or more."""
    return f"{value:.4g}" if places is None or abs(value) >= 1e6 else f"{value:.{places}f}"


def quartiles_cell(first: float, third: float, places: int | None) -> str:
    """Return quartiles as a range."""
    return f"{fixed(first, places)} to {fixed(third, places)}"


def p_cell(p: float | None) -> str:
    """Return a p-value with three decimals."""
    return "-" if p is None else "< 0.001" if p < 0.001 else f"{p:.3f}"
