"""Functions that the tests of several contracts share."""

from __future__ import annotations

from typing import Any


def name_of(value: object) -> str:
    """Return the name of a law or of a component's class, as the id of a test case."""
    return value if isinstance(value, str) else type(value).__name__


def starting(run: type[Any], base: type[Any]) -> Any:
    """Return a component like *base* that starts *run* instead."""
    return type(run.__name__, (base,), {"run": run})()
