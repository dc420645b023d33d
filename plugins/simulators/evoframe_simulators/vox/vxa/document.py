"""XML from anyone: bounded before it is parsed, without entities, files or networks."""

from __future__ import annotations

from pathlib import Path

from lxml import etree

from evoframe import InputError

__all__ = ["parsed", "shown"]

_MOST_BYTES = 64 * 2**20
_MOST_ELEMENTS = 2**20  # the parser needs a hundred bytes and more for each, however short it is
_LONGEST_SHOWN = 60


def parsed(path: Path) -> etree._Element:
    """Return the root of an XML file.

    The text is UTF-8, or else ISO-8859-1, whatever it declares itself to be.

    Raises:
        OSError: The file cannot be read.
        InputError: It is too large, no XML, or defines entities; says which.
    """
    text = _bounded_text(path)
    parser = etree.XMLParser(
        encoding="utf-8",
        load_dtd=False,
        no_network=True,
        resolve_entities=False,
        huge_tree=False,  # libxml2's own limits to depth and to the length of a text stay in force
        remove_comments=True,
        remove_pis=True,
        collect_ids=False,
    )
    try:
        return etree.fromstring(text.encode(), parser)
    except etree.XMLSyntaxError as error:
        raise InputError(f"is no XML: {shown(error.msg or 'unknown fault', quoted=False)}") from error


def shown(text: str, *, quoted: bool = True) -> str:
    """Return a text from a file in a form and length that a message can bear."""
    line = " ".join(text.split())
    printable = "".join(char if char.isprintable() else "?" for char in line[: 2 * _LONGEST_SHOWN])
    longest = _LONGEST_SHOWN if quoted else 2 * _LONGEST_SHOWN
    short = printable if len(line) <= longest else f"{printable[:longest]}..."
    return f"'{short}'" if quoted else short


def _bounded_text(path: Path) -> str:
    """Return the text of a file, unless it is larger than a parser should be given, or names entities."""
    with path.open("rb") as file:
        data = file.read(_MOST_BYTES + 1)
    if len(data) > _MOST_BYTES:
        raise InputError(f"is larger than {_MOST_BYTES // 2**20} MiB")
    try:
        text = data.decode("utf-8")
    except UnicodeDecodeError:
        text = data.decode("iso-8859-1")
    if "<!DOCTYPE" in text or "<!ENTITY" in text:
        raise InputError("has a DOCTYPE or an ENTITY, which no VXA file needs; they are not read")
    # Every element has an end, every attribute its quotes; and neither character stands for a material.
    elements = text.count("</") + text.count("/>")
    quotes = text.count('"') + text.count("'")
    if max(elements, quotes // 2) > _MOST_ELEMENTS:
        raise InputError(f"has more than {_MOST_ELEMENTS} elements or attributes")
    return text
