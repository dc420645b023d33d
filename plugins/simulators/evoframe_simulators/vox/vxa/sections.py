"""Values out of the sections of a file: strictly, and with their place in every complaint."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator

import attrs
from lxml import etree

from evoframe import InputError
from evoframe_simulators.vox.vxa.document import shown

__all__ = ["Refusals", "Section", "number_in"]

_NUMBER = re.compile(r"[+-]?([0-9]+(\.[0-9]*)?|\.[0-9]+)([eE][+-]?[0-9]+)?")


def number_in(text: str) -> float | None:
    """Return the finite decimal number that a text is, and nothing for any other text."""
    if not _NUMBER.fullmatch(text):
        return None
    value = float(text)
    return value if math.isfinite(value) else None


@attrs.frozen
class Refusals:
    """What a file asks for and vox does not do, collected so that one message names all of it."""

    _found: list[str] = attrs.field(factory=list)

    def add(self, place: str, value: str, why: str = "") -> None:
        """Note a tag, its value, and a reason where tag and value do not tell."""
        self._found.append(f"{place} = {value}" + (f" ({why})" if why else ""))

    def check(self) -> None:
        """Refuse the file if anything was noted.

        Raises:
            InputError: With all of it.
        """
        if self._found:
            raise InputError(f"asks for what vox does not simulate: {'; '.join(self._found)}")


@attrs.frozen
class Section:
    """An element with others in it.

    Attributes:
        element: Itself.
        place: The tags that lead to it from the root, for messages.
    """

    element: etree._Element
    place: str

    def at(self, tag: str) -> str:
        """Return the place of a tag in this section."""
        return f"{self.place}/{tag}" if self.place else tag

    def find(self, tag: str) -> Section | None:
        """Return the section of this name in it.

        Raises:
            InputError: There is more than one.
        """
        found = self.element.findall(tag)
        if len(found) > 1:
            raise InputError(f"{self.at(tag)} is there {len(found)} times; expected once")
        return Section(found[0], self.at(tag)) if found else None

    def need(self, tag: str) -> Section:
        """Return the section of this name in it.

        Raises:
            InputError: There is none, or more than one.
        """
        found = self.find(tag)
        if found is None:
            raise InputError(f"has no {self.at(tag)}, which every VXA file should have")
        return found

    def count(self, tag: str) -> int:
        """Return how many sections of this name are in it."""
        return sum(1 for _ in self.element.iterchildren(tag))

    def all(self, tag: str) -> Iterator[Section]:
        """Yield all sections of this name in it, numbered from 1 in messages."""
        for n, found in enumerate(self.element.iterchildren(tag), 1):
            yield Section(found, f"{self.at(tag)} {n}")

    def text(self, tag: str) -> str | None:
        """Return the text of a tag without blanks around it, or nothing if there is no such tag.

        Raises:
            InputError: It is there twice, or has further tags in it.
        """
        found = self.find(tag)
        if found is None:
            return None
        if len(found.element):
            raise InputError(f"{found.place} has tags in it; expected a value")
        return (found.element.text or "").strip()

    def number(
        self, tag: str, default: float, *, least: float = -math.inf, above: float = -math.inf
    ) -> float:
        """Return the number of a tag, or the default if there is no such tag.

        Raises:
            InputError: It is no finite number, or out of range.
        """
        text = self.text(tag)
        value = default if text is None else number_in(text)
        if value is None or value < least or not value > above:
            bound = f" of at least {least:g}" if math.isfinite(least) else ""
            bound = f" above {above:g}" if math.isfinite(above) else bound
            found = "nothing" if text is None else shown(text)
            raise InputError(f"{self.at(tag)}: expected a number{bound}, found {found}")
        return value

    def whole(self, tag: str, default: int | None = None, *, least: int = 0, most: int = 2**53) -> int:
        """Return the whole number of a tag, written ``8`` or ``8.0``.

        Raises:
            InputError: It is none, out of range, or missing without a default.
        """
        text = self.text(tag)
        if text is None:
            if default is None:
                raise InputError(f"has no {self.at(tag)}")
            return default
        value = number_in(text)
        if value is None or not value.is_integer() or not least <= value <= most:
            raise InputError(
                f"{self.at(tag)}: expected a whole number from {least} to {most}, found {shown(text)}"
            )
        return int(value)

    def flag(self, tag: str) -> bool:
        """Return whether a tag is 1; it is 0 if there is none.

        Raises:
            InputError: It is something else.
        """
        return bool(self.whole(tag, 0, most=1))
