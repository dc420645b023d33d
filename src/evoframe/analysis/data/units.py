"""What axes are called, and in which unit numbers are shown."""

from __future__ import annotations

from collections.abc import Mapping

from evoframe.analysis.data.studies import Yardstick

__all__ = ["CURVE_CAPTIONS", "CURVE_NAMES", "NAMES", "axis_title", "factor_of", "with_unit"]

NAMES: Mapping[Yardstick, str] = {"score": "best pair simulated", "fitness": "best fitness"}

CURVE_NAMES: Mapping[Yardstick, str] = {"score": "best score so far", "fitness": "best fitness"}
"""Titles of axes of values over generations; the score of the best pair never decreases."""

CURVE_CAPTIONS: Mapping[Yardstick, str] = {
    "score": "Best score so far, after each generation",
    "fitness": "Best fitness in each generation",
}


def factor_of(unit: str) -> float:
    """Return what values in *unit* are multiplied by to be shown: displacements are millimetres."""
    return 1000.0 if unit == "m" else 1.0


def axis_title(name: str, unit: str) -> str:
    """Return the title of an axis of values in *unit*."""
    shown = {"m": " (mm)", "": ""}.get(unit, f" ({unit})")
    return f"{name}{shown}"


def with_unit(value: float, unit: str) -> str:
    """Return a value as it is told: ``5.041 mm``."""
    return f"{value * factor_of(unit):.4g} {'mm' if unit == 'm' else unit}".rstrip()
