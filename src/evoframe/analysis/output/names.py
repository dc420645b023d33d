"""Short names for files and links, made of titles: different ones for different titles."""

from __future__ import annotations

from collections.abc import Iterable

from slugify import slugify

__all__ = ["slugs"]

_LONGEST = 60


def slugs(titles: Iterable[str]) -> list[str]:
    """Return a name of ASCII letters, digits, dots and dashes for each title.

    No two are alike, on file systems that do not know capitals either: those that would be are numbered. They
    have about 60 letters at most, as file names must not be endless.
    """
    found: dict[str, str] = {}  # as file systems without capitals see it -> the name
    for title in titles:
        slug = slugify(
            title,
            entities=False,
            decimal=False,
            hexadecimal=False,  # a title is not HTML
            lowercase=False,
            allow_unicode=True,  # else names would depend on which library is there to transliterate
            regex_pattern=r"[^A-Za-z0-9.]+",
            replacements=[("= -", "= minus "), (",", " ")],  # a number with commas keeps its parts
        )
        plain = slug.strip("-.")[:_LONGEST].rstrip("-.") or "unnamed"
        name, number = plain, 2
        while name.casefold() in found:
            name, number = f"{plain}-{number}", number + 1
        found[name.casefold()] = name
    return list(found.values())
