"""Parts of messages, shared by all packages of the core."""

from __future__ import annotations

import difflib
import json
from collections.abc import Iterable
from typing import Any

from evoframe.errors import EvoframeError

__all__ = ["cause_of", "found", "full_text", "quantity", "suggestion", "unit_factor", "unit_name"]


def suggestion(word: str, known: Iterable[str], label: str = "") -> str:
    """Return the end of a message about an unknown *word*: a close match, and the valid words.

    Args:
        word: The word found.
        known: The valid words.
        label: Heading of the list of valid words; no list if empty.
    """
    words = list(known)
    close = difflib.get_close_matches(word, words, n=1, cutoff=0.5)
    meant = f"; did you mean '{close[0]}'?" if close else ""
    listed = f"{'' if meant else ';'} {label}: {', '.join(words) or 'none'}" if label else ""
    return meant + listed


def found(value: Any) -> str:
    """Return *value* in the notation of a configuration file."""
    return json.dumps(value, default=str, ensure_ascii=False)


def full_text(error: BaseException) -> str:
    """Return the text of an error and its notes (:meth:`BaseException.add_note`), one per line."""
    return "\n  ".join([str(error), *getattr(error, "__notes__", ())])


def cause_of(error: BaseException) -> str:
    """Return the text of an error, with its type in front unless it is an error of evoframe."""
    text = full_text(error)
    return text if isinstance(error, EvoframeError) else f"{type(error).__name__}: {text}"


def unit_factor(unit: str) -> float:
    """Return the factor from values in *unit* to displayed values: meters are displayed as millimeters."""
    return 1000.0 if unit == "m" else 1.0


def unit_name(unit: str) -> str:
    """Return the unit in which values in *unit* are displayed."""
    return "mm" if unit == "m" else unit


def quantity(value: float, unit: str, digits: int = 4) -> str:
    """Return a value in *unit* as displayed, with significant *digits*: ``3.781 mm`` for 0.0037813 m."""
    number = f"{value * unit_factor(unit):z.{digits}g}"  # z: no negative zero
    return f"{number} {unit_name(unit)}".rstrip()
