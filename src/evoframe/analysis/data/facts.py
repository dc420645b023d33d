"""Settings that a reader of a report needs first."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

__all__ = ["facts_of"]


def facts_of(configurations: Sequence[Mapping[str, Any]], unit: str = "") -> dict[str, str]:
    """Return objective, aggregator, collaboration strategy with its options, and seed: label -> values.

    Args:
        configurations: Tables of one run, or of all cells of a study; different values are listed.
        unit: Unit of the scores; meters are shown as millimeters.
    """
    shown = {"m": " (mm)", "": ""}.get(unit, f" ({unit})")
    strategies = [tables["collaboration"] for tables in configurations]
    options = dict.fromkeys(key for table in strategies for key in table if key != "name")
    return {
        "objective": _listed(tables["objective"]["name"] for tables in configurations) + shown,
        "aggregator": _listed(tables["aggregator"]["name"] for tables in configurations),
        "collaboration": _listed(table["name"] for table in strategies),
        **{option: _listed(table[option] for table in strategies if option in table) for option in options},
        "seed": _listed(tables["run"]["seed"] for tables in configurations),
    }


def _listed(values: Iterable[Any]) -> str:
    """Return different values, each once, separated by commas."""
    return ", ".join(dict.fromkeys(map(str, values)))
