"""Short, distinct names for files and links, derived from titles."""

from __future__ import annotations

from collections.abc import Iterable

from slugify import slugify

__all__ = ["slugs"]

_LONGEST = 60


def slugs(titles: Iterable[str]) -> list[str]:
    """Return a name of ASCII letters, digits, dots and dashes for each title.

    The names differ even on file systems that ignore case: duplicates are numbered. A name has about 60
    characters at most.
    """
    found: dict[str, str] = {}  # name without case -> name
    for title in titles:
        slug = slugify(
            title,
            entities=False,
            decimal=False,
            hexadecimal=False,  # a title is not HTML
            lowercase=False,
            allow_unicode=True,  # transliteration would depend on the installed libraries
            regex_pattern=r"[^A-Za-z0-9.]+",
            replacements=[("= -", "= minus "), (",", " ")],  # a number with commas keeps its parts
        )
        plain = slug.strip("-.")[:_LONGEST].rstrip("-.") or "unnamed"
        name, number = plain, 2
        while name.casefold() in found:
            name, number = f"{plain}-{number}", number + 1
        found[name.casefold()] = name
    return list(found.values())
