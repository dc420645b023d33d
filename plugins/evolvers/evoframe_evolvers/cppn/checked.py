"""Reading of saved JSON values that may be damaged: every fault is a ValueError that names the place."""

from __future__ import annotations

import math
from typing import Any, TypeVar

__all__ = ["entry", "number", "rows", "whole", "wholes"]

T = TypeVar("T")


def entry(table: Any, key: str, kind: type[T]) -> T:
    """Return the value of *key* in *table*, which must be of *kind*."""
    if not isinstance(table, dict) or key not in table:
        raise ValueError(f"'{key}' is missing")
    value = table[key]
    if not isinstance(value, kind):
        raise ValueError(f"'{key}' must be of type {kind.__name__}, not {value!r}")  # noqa: TRY004 - it is a bad state
    return value


def whole(table: Any, key: str, least: int | None = None) -> int:
    """Return the integer of *key*, which must not be below *least*."""
    value = entry(table, key, int)
    if isinstance(value, bool) or (least is not None and value < least):
        raise ValueError(
            f"'{key}' must be an integer{'' if least is None else f' from {least} up'}, not {value!r}"
        )
    return value


def wholes(table: Any, key: str) -> list[int]:
    """Return the list of integers of *key*."""
    items = rows(table, key)
    return [whole({key: item}, key) for item in items]


def number(table: Any, key: str) -> float:
    """Return the finite number of *key*."""
    value = entry(table, key, object)
    if isinstance(value, bool) or not isinstance(value, int | float) or not _is_finite(value):
        raise ValueError(f"'{key}' must be a finite number, not {value!r}")
    return float(value)


def _is_finite(value: float) -> bool:
    try:
        return math.isfinite(value)
    except OverflowError:  # JSON has integers beyond all floats
        return False


def rows(table: Any, key: str, width: int | None = None) -> list[Any]:
    """Return the list of *key*, whose items must be lists of *width* if that is given."""
    items = entry(table, key, list)
    if width is not None and not all(isinstance(item, list) and len(item) == width for item in items):
        raise ValueError(f"every item of '{key}' must be a list of {width}")
    return items
