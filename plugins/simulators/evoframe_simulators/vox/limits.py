"""Limits and validators of the options of ``vox``.

The ranges of numbers come from the solver's own table.
"""

from __future__ import annotations

from collections.abc import Sequence
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
    "InRange",
    "check_distinct",
    "check_finite",
    "check_printable",
]

LARGEST_CODE = 255
"""Largest code of a material: a cell of a body is one byte."""

MOST_CELLS = 2**24
"""Largest number of cells in a canvas, also for the solver."""

MOST_CYCLES = 1e6
"""Largest absolute phase offset; beyond it, single precision cannot hold a fraction of a cycle."""

MOST_RECORD_BYTES = 2**32
"""Largest record of one body, bytes."""

MOST_STEPS = 2**53
"""Largest number of steps in a simulation; a ``float`` holds all smaller integers exactly."""


@attrs.frozen(repr=False)
class InRange:
    """An attrs validator that rejects numbers outside a range of the solver."""

    span: libvox.Range

    def __call__(self, _: Any, attribute: attrs.Attribute[Any], value: float) -> None:
        """Check a value."""
        if value not in self.span:
            raise ValueError(f"'{attribute.name}' must be {self.span.words}: {value}")

    def __repr__(self) -> str:
        return f"<Validator for x {self.span.words}>"


VALID_SETTING = {name: InRange(span) for name, span in libvox.SETTING_RANGES.items()}
"""Validator of each number among the solver's settings, by the solver's name."""

VALID_PROPERTY = {name: InRange(span) for name, span in libvox.PROPERTY_RANGES.items()}
"""Validator of each property of a material, by the solver's name."""


def check_finite(_: Any, attribute: attrs.Attribute[Any], value: Sequence[float]) -> None:
    """Reject numbers that are infinite or NaN; an attrs validator.

    Raises:
        ValueError: A number is not finite.
    """
    if not np.isfinite(value).all():
        raise ValueError(f"'{attribute.name}' must be finite: {list(value)}")


def check_distinct(_: Any, attribute: attrs.Attribute[Any], value: Sequence[str]) -> None:
    """Reject a list with duplicates; an attrs validator.

    Raises:
        ValueError: A word is in the list more than once.
    """
    if len(set(value)) < len(value):
        raise ValueError(f"'{attribute.name}' must not contain duplicates: {list(value)}")


def check_printable(_: Any, attribute: attrs.Attribute[str], value: str) -> None:
    """Reject a text with line breaks or control characters; an attrs validator.

    Raises:
        ValueError: The text is not printable.
    """
    if not value.isprintable():
        raise ValueError(f"'{attribute.name}' must be one line of printable characters: {value!r}")
