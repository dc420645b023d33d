"""Results of a section: tables, printed and as JSON."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, TypeAlias

import attrs
from rich.console import Console
from rich.table import Table as RichTable

__all__ = ["Cell", "Row", "Section", "SectionError", "Table", "show"]

Cell: TypeAlias = str | float

Row: TypeAlias = tuple[Cell, ...]


class SectionError(Exception):
    """A section that cannot be measured on this machine."""


@attrs.frozen
class Table:
    """A table of figures.

    Attributes:
        title: Title of the table.
        columns: Names of the columns, with units.
        rows: A cell for each column; the first names the row.
        note: Explanation of the figures.
    """

    title: str
    columns: tuple[str, ...]
    rows: Sequence[Row]
    note: str = ""

    def records(self) -> list[dict[str, Cell]]:
        """Return each row by the names of its columns."""
        return [dict(zip(self.columns, row, strict=True)) for row in self.rows]


@attrs.frozen
class Section:
    """The results of a section.

    Attributes:
        title: The quantity measured.
        tables: The figures.
    """

    title: str
    tables: tuple[Table, ...]

    def to_json(self) -> dict[str, Any]:
        """Return the section as JSON values: the rows of each table by its title."""
        return {"title": self.title, "tables": {table.title: table.records() for table in self.tables}}


def show(console: Console, name: str, section: Section) -> None:
    """Print a section."""
    console.print(f"\n[bold]{name}[/]: {section.title}")
    for table in section.tables:
        console.print(f"\n[italic]{table.title}[/]", highlight=False)
        console.print(_printed(table))
        if table.note:
            console.print(table.note, style="dim", highlight=False)


def _printed(table: Table) -> RichTable:
    printed = RichTable(box=None, pad_edge=False)
    for index, column in enumerate(table.columns):
        printed.add_column(column, justify="right" if index else "left")
    for row in table.rows:
        printed.add_row(*(_text(cell) for cell in row))
    return printed


def _text(cell: Cell) -> str:
    if isinstance(cell, str):
        return cell
    return f"{cell:,.0f}" if isinstance(cell, int) or abs(cell) >= 999.5 else f"{cell:.3g}"
