"""Limits of what ``vox`` accepts, and the validators of its options.

The ranges of numbers that the solver takes are those of its own table.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import attrs
import numpy as np

import evoframe_libvox as libvox

__all__ = [
    "LARGEST_CODE",
    "MOST_CELLS",
    "MOST_CYCLES",
    "MOST_RECORD_BYTES",
    "MOST_STEPS",
    "VALID_PROPERTY",
    "VALID_SETTING",
    "check_distinct",
    "check_finite",
    "check_printable",
    "in_range",
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


def in_range(span: libvox.Range) -> Callable[[Any, attrs.Attribute[Any], float], None]:
    """Return a validator that refuses numbers outside a range of the solver."""

    def check(_: Any, attribute: attrs.Attribute[Any], value: float) -> None:
        if value not in span:
            raise ValueError(f"'{attribute.name}' must be {span.words}: {value}")

    return check


VALID_SETTING = {name: in_range(span) for name, span in libvox.SETTING_RANGES.items()}
"""Validator of each number among the solver's settings, by the solver's name."""

VALID_PROPERTY = {name: in_range(span) for name, span in libvox.PROPERTY_RANGES.items()}
"""Validator of each property of a material, by the solver's name."""


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
