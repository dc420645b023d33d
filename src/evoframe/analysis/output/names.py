"""Short names for files and links, made of titles: different ones for different titles."""

from __future__ import annotations

import re
from collections.abc import Iterable

__all__ = ["slugs"]

_LONGEST = 60


def slugs(titles: Iterable[str]) -> list[str]:
    """Return a name of ASCII letters, digits, dots and dashes for each title.

    No two are alike, on file systems that do not know capitals either: those that would be are numbered. They
    have about 60 letters at most, as file names must not be endless.
    """
    found: list[str] = []
    taken: set[str] = set()
    for title in titles:
        plain = re.sub(r"[^A-Za-z0-9.]+", "-", title.replace("= -", "= minus ")).strip("-.")
        plain = plain[:_LONGEST].rstrip("-.") or "unnamed"
        name, number = plain, 2
        while name.casefold() in taken:
            name, number = f"{plain}-{number}", number + 1
        taken.add(name.casefold())
        found.append(name)
    return found
