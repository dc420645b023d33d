"""Titles of axes and columns, and the units in which reports show numbers."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import pandas as pd

from evoframe.analysis.data.studies import Yardstick

__all__ = ["CURVE_CAPTIONS", "CURVE_NAMES", "NAMES", "axis_title", "factor_of", "in_unit", "with_unit"]

NAMES: Mapping[Yardstick, str] = {"score": "best score", "fitness": "best fitness"}

CURVE_NAMES: Mapping[Yardstick, str] = {"score": "best score so far", "fitness": "best fitness"}
"""Titles of axes of values over generations; the score of the best pair never decreases."""

CURVE_CAPTIONS: Mapping[Yardstick, str] = {
    "score": "Best score so far, after each generation",
    "fitness": "Best fitness in each generation",
}


def factor_of(unit: str) -> float:
    """Return the factor from *unit* to the unit of reports: meters become millimeters."""
    return 1000.0 if unit == "m" else 1.0


def axis_title(name: str, unit: str) -> str:
    """Return the title of an axis or column with its unit, as in ``best score (mm)``."""
    shown = {"m": " (mm)", "": ""}.get(unit, f" ({unit})")
    return f"{name}{shown}"


def in_unit(table: pd.DataFrame, columns: Sequence[str], unit: str) -> pd.DataFrame:
    """Return a table with *columns* converted from *unit* to the unit of reports, stated in their titles."""
    shown = table.copy()
    if unit == "m":
        for column in columns:
            shown[column] = [None if pd.isna(value) else value * 1000.0 for value in table[column]]
    return shown.rename(columns={column: axis_title(column, unit) for column in columns})


def with_unit(value: float, unit: str, digits: int = 4) -> str:
    """Return a value with its unit, as in ``5.041 mm``."""
    return f"{value * factor_of(unit):.{digits}g} {'mm' if unit == 'm' else unit}".rstrip()
