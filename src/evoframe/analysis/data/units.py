"""Titles of axes and columns, and the units in which reports show numbers."""

from __future__ import annotations

from collections.abc import Mapping

from evoframe.analysis.data.studies import Yardstick

__all__ = ["NAMES", "axis_title", "factor_of", "with_unit"]

NAMES: Mapping[Yardstick, str] = {"score": "score of the best pair", "fitness": "best fitness"}


def factor_of(unit: str) -> float:
    """Return the factor from *unit* to the unit of reports: meters become millimeters."""
    return 1000.0 if unit == "m" else 1.0


def axis_title(name: str, unit: str) -> str:
    """Return the title of an axis of values in *unit*."""
    shown = {"m": " (mm)", "": ""}.get(unit, f" ({unit})")
    return f"{name}{shown}"


def with_unit(value: float, unit: str, digits: int = 4) -> str:
    """Return a value with its unit, as in ``5.041 mm``."""
    return f"{value * factor_of(unit):.{digits}g} {'mm' if unit == 'm' else unit}".rstrip()
