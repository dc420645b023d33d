"""Titles of axes and columns, and the units in which reports show numbers."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import pandas as pd

from evoframe.analysis.data.studies import Yardstick
from evoframe.messages import unit_factor, unit_name

__all__ = ["AXIS_NAMES", "CURVE_CAPTIONS", "CURVE_NAMES", "NAMES", "axis_title", "in_unit"]

NAMES: Mapping[Yardstick, str] = {"score": "score of the best pair", "fitness": "best fitness"}
"""Names in sentences and headings."""

AXIS_NAMES: Mapping[Yardstick, str] = {"score": "best pair", "fitness": "best fitness"}
"""Titles of axes, which have less space."""

CURVE_NAMES: Mapping[Yardstick, str] = {"score": "best pair so far", "fitness": "best fitness"}
"""Titles of axes of values over generations; the score of the best pair never decreases."""

CURVE_CAPTIONS: Mapping[Yardstick, str] = {
    "score": "Score of the best pair so far, after each generation",
    "fitness": "Best fitness in each generation",
}


def axis_title(name: str, unit: str) -> str:
    """Return the title of an axis or column with its unit, as in ``best fitness (mm)``."""
    return f"{name} ({unit_name(unit)})" if unit else name


def in_unit(table: pd.DataFrame, columns: Sequence[str], unit: str) -> pd.DataFrame:
    """Return a table with *columns* converted from *unit* to the unit of reports, stated in their titles."""
    shown = table.copy()
    factor = unit_factor(unit)
    if factor != 1.0:
        for column in columns:
            shown[column] = [None if pd.isna(value) else value * factor for value in table[column]]
    return shown.rename(columns={column: axis_title(column, unit) for column in columns})
