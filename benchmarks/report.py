"""What a section has measured: tables, for people and as JSON."""

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
    """A section cannot be measured here; says why."""


@attrs.frozen
class Table:
    """Figures side by side.

    Attributes:
        title: What they are.
        columns: Names, with the unit.
        rows: A cell for each column; the first names the row.
        note: What one has to know to read them.
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
    """All that one section has to say.

    Attributes:
        title: What was measured.
        tables: The figures.
    """

    title: str
    tables: tuple[Table, ...]

    def to_json(self) -> dict[str, Any]:
        """Return it as JSON values: the rows of every table by its title."""
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
