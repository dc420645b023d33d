"""Strict reading of values from the sections of a file; errors contain the path of the tag."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator

import attrs
from lxml import etree

from evoframe import InputError
from evoframe_simulators.vox.vxa.document import shorten

__all__ = ["Section", "parse_number"]

_NUMBER = re.compile(r"[+-]?([0-9]+(\.[0-9]*)?|\.[0-9]+)([eE][+-]?[0-9]+)?")


def parse_number(text: str) -> float | None:
    """Parse a finite decimal number; return ``None`` for any other text."""
    if not _NUMBER.fullmatch(text):
        return None
    value = float(text)
    return value if math.isfinite(value) else None


@attrs.frozen
class Section:
    """An element that contains other elements.

    Attributes:
        element: The element.
        place: Path of tags from the root, for messages.
    """

    element: etree._Element
    place: str

    def at(self, tag: str) -> str:
        """Return the path of a tag in this section."""
        return f"{self.place}/{tag}" if self.place else tag

    def find(self, tag: str) -> Section | None:
        """Return the subsection *tag*, or ``None`` if it is missing.

        Raises:
            InputError: There is more than one.
        """
        found = self.element.findall(tag)
        if len(found) > 1:
            raise InputError(f"found {len(found)} times, expected once", key=self.at(tag))
        return Section(found[0], self.at(tag)) if found else None

    def get(self, tag: str) -> Section:
        """Return the subsection *tag*, without contents if it is missing.

        Raises:
            InputError: There is more than one.
        """
        return self.find(tag) or Section(etree.Element(tag), self.at(tag))

    def need(self, tag: str) -> Section:
        """Return the subsection *tag*.

        Raises:
            InputError: It is missing, or there is more than one.
        """
        found = self.find(tag)
        if found is None:
            raise InputError("missing section; a body cannot be read without it", key=self.at(tag))
        return found

    def count(self, tag: str) -> int:
        """Return the number of subsections *tag*."""
        return sum(1 for _ in self.element.iterchildren(tag))

    def all(self, tag: str) -> Iterator[Section]:
        """Yield all subsections *tag*, numbered from 1 in messages."""
        for n, found in enumerate(self.element.iterchildren(tag), 1):
            yield Section(found, f"{self.at(tag)} {n}")

    def text(self, tag: str) -> str | None:
        """Return the text of a tag without surrounding whitespace, or ``None`` if it is missing.

        Raises:
            InputError: There is more than one, or it contains tags.
        """
        found = self.find(tag)
        if found is None:
            return None
        if len(found.element):
            raise InputError("found tags, expected a value", key=found.place)
        return (found.element.text or "").strip()

    def number(
        self, tag: str, default: float, *, least: float = -math.inf, above: float = -math.inf
    ) -> float:
        """Return the number of a tag, or the default if it is missing.

        Raises:
            InputError: The value is not a finite number, or is out of range.
        """
        text = self.text(tag)
        value = default if text is None else parse_number(text)
        if value is None or value < least or not value > above:
            bound = f" of at least {least:g}" if math.isfinite(least) else ""
            bound = f" above {above:g}" if math.isfinite(above) else bound
            found = "nothing" if text is None else shorten(text)
            raise InputError(f"expected a number{bound}, found {found}", key=self.at(tag))
        return value

    def whole(self, tag: str, default: int | None = None, *, least: int = 0, most: int = 2**53) -> int:
        """Return the integer of a tag, written ``8`` or ``8.0``.

        Raises:
            InputError: The value is not an integer, is out of range, or is missing without a default.
        """
        text = self.text(tag)
        if text is None:
            if default is None:
                raise InputError(f"missing tag; expected an integer from {least} to {most}", key=self.at(tag))
            return default
        value = parse_number(text)
        if value is None or not value.is_integer() or not least <= value <= most:
            raise InputError(
                f"expected an integer from {least} to {most}, found {shorten(text)}", key=self.at(tag)
            )
        return int(value)

    def flag(self, tag: str) -> bool:
        """Return whether a tag is 1; a missing tag counts as 0.

        Raises:
            InputError: The value is neither 0 nor 1.
        """
        return bool(self.whole(tag, 0, most=1))
