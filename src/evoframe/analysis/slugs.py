"""Short names for files and links, made of titles: different ones for different titles."""

from __future__ import annotations

import re
from collections.abc import Iterable

__all__ = ["slugs"]


def slugs(titles: Iterable[str]) -> list[str]:
    """Return a name of ASCII letters, digits, dots and dashes for each title.

    No two are alike, on file systems that do not know capitals either: those that would be are numbered.
    """
    found: list[str] = []
    taken: set[str] = set()
    for title in titles:
        plain = re.sub(r"[^A-Za-z0-9.]+", "-", title.replace("= -", "= minus ")).strip("-.") or "unnamed"
        name, number = plain, 2
        while name.casefold() in taken:
            name, number = f"{plain}-{number}", number + 1
        taken.add(name.casefold())
        found.append(name)
    return found
