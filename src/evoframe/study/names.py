"""What the cells of a study are called in an article."""

from __future__ import annotations

from collections.abc import Collection, Mapping

__all__ = ["called", "headings", "name_of", "title_of"]


def called(value: str) -> str:
    """Return what a value of the grid is called: an average is AM, as the paper writes it."""
    return value.upper() if len(value) == 2 else value


def headings(keys: Collection[str]) -> dict[str, str]:
    """Return what each dotted key is called: its last part, or as many as tell it from the others."""
    return {key: _shortest(key, [other for other in keys if other != key]) for key in keys}


def title_of(settings: Mapping[str, str], names: Mapping[str, str]) -> str:
    """Return what cells have in common that share these settings: ``n = 2``.

    Args:
        settings: Dotted key -> value.
        names: What the keys are called.
    """
    return ", ".join(f"{names[key]} = {value}" for key, value in settings.items())


def name_of(settings: Mapping[str, str]) -> str:
    """Return what a cell is called among all others: ``WM (n = 2)``; empty if it has no settings."""
    *others, last = [*settings] or [""]
    title = title_of({key: settings[key] for key in others}, headings(settings))
    name = called(settings.get(last, ""))
    return f"{name} ({title})" if title else name


def _shortest(key: str, others: Collection[str]) -> str:
    parts = key.split(".")
    endings = [".".join(parts[-n:]) for n in range(1, len(parts) + 1)]
    return next((end for end in endings if not any(f".{other}".endswith(f".{end}") for other in others)), key)
