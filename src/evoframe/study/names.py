"""Names of a study's cells in tables and figures."""

from __future__ import annotations

from collections.abc import Collection, Mapping

__all__ = ["called", "headings", "name_of", "title_of"]


def called(value: str) -> str:
    """Return the name of a value of the grid: averages are in capitals (AM), as in the paper."""
    return value.upper() if len(value) == 2 else value


def headings(keys: Collection[str]) -> dict[str, str]:
    """Return the name of each dotted key: its last part, or more parts if other keys end alike."""
    return {key: _shortest(key, [other for other in keys if other != key]) for key in keys}


def title_of(settings: Mapping[str, str], names: Mapping[str, str]) -> str:
    """Return the title of the cells that share these settings, such as ``n = 2``.

    Args:
        settings: Dotted key -> value.
        names: Dotted key -> its name.
    """
    return ", ".join(f"{names[key]} = {value}" for key, value in settings.items())


def name_of(settings: Mapping[str, str]) -> str:
    """Return the name of a cell, such as ``WM (n = 2)``; empty if it has no settings."""
    *others, last = [*settings] or [""]
    title = title_of({key: settings[key] for key in others}, headings(settings))
    name = called(settings.get(last, ""))
    return f"{name} ({title})" if title else name


def _shortest(key: str, others: Collection[str]) -> str:
    parts = key.split(".")
    endings = [".".join(parts[-n:]) for n in range(1, len(parts) + 1)]
    return next((end for end in endings if not any(f".{other}".endswith(f".{end}") for other in others)), key)
