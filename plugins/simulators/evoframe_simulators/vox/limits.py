"""Limits of what ``vox`` accepts, and the validators of its options: each is stated once, here."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import attrs
import numpy as np
from attrs import validators

__all__ = [
    "LARGEST_CODE",
    "MOST_CELLS",
    "MOST_CYCLES",
    "MOST_RECORD_BYTES",
    "MOST_STEPS",
    "MOST_SUBSTEPS",
    "NOT_NEGATIVE",
    "POISSON_RATIO",
    "POSITIVE",
    "check_distinct",
    "check_finite",
    "check_printable",
    "within",
]

LARGEST_CODE = 255
"""Of a material: a cell of a body is one byte."""

MOST_CELLS = 2**24
"""Of a canvas; more would not fit into the solver, either."""

MOST_CYCLES = 1e6
"""Of a phase offset, either way; beyond, single precision knows no fraction of a cycle."""

MOST_RECORD_BYTES = 2**32
"""Of what is recorded of one body."""

MOST_STEPS = 2**53
"""Of a simulation; every smaller whole number is a ``float`` of its own."""

MOST_SUBSTEPS = 1000
"""Of a nominal time step."""

POSITIVE = validators.gt(0.0)
NOT_NEGATIVE = validators.ge(0.0)
POISSON_RATIO = validators.and_(validators.ge(0.0), validators.lt(0.5))


def within(least: float, most: float) -> Any:
    """Return a validator of numbers from *least* to *most*, both included."""
    return validators.and_(validators.ge(least), validators.le(most))


def check_finite(_: Any, attribute: attrs.Attribute[Any], value: Sequence[float]) -> None:
    """Refuse numbers that are infinite or NaN; an attrs validator.

    Raises:
        ValueError: Shows the numbers.
    """
    if not np.isfinite(value).all():
        raise ValueError(f"'{attribute.name}' must be finite: {list(value)}")


def check_distinct(_: Any, attribute: attrs.Attribute[Any], value: Sequence[str]) -> None:
    """Refuse a list that has a word more than once; an attrs validator.

    Raises:
        ValueError: Shows the list.
    """
    if len(set(value)) < len(value):
        raise ValueError(f"'{attribute.name}' must have each one once: {list(value)}")


def check_printable(_: Any, attribute: attrs.Attribute[str], value: str) -> None:
    """Refuse a text with line breaks or control characters; an attrs validator.

    Raises:
        ValueError: Shows the text.
    """
    if not value.isprintable():
        raise ValueError(f"'{attribute.name}' must be one line of printable characters: {value!r}")
