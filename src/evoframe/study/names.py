"""What the cells of a study are called in an article."""

from __future__ import annotations

from collections.abc import Mapping

__all__ = ["called", "last_of", "name_of", "title_of"]


def called(value: str) -> str:
    """Return what a value of the grid is called: an average is AM, as the paper writes it."""
    return value.upper() if len(value) == 2 else value


def title_of(settings: Mapping[str, str]) -> str:
    """Return what cells have in common that share these settings: ``n = 2``."""
    return ", ".join(f"{last_of(key)} = {value}" for key, value in settings.items())


def name_of(settings: Mapping[str, str]) -> str:
    """Return what a cell is called among all others: ``WM (n = 2)``; empty if it has no settings."""
    *others, last = [*settings] or [""]
    title = title_of({key: settings[key] for key in others})
    name = called(settings.get(last, ""))
    return f"{name} ({title})" if title else name


def last_of(key: str) -> str:
    """Return what a table calls a dotted key: its last part."""
    return key.rsplit(".", 1)[-1]
