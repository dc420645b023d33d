"""Parsing of untrusted XML: of limited size, without entities, external files or network access."""

from __future__ import annotations

import re
from pathlib import Path

from lxml import etree

from evoframe import InputError

__all__ = ["parse_xml", "shorten"]

_MOST_BYTES = 64 * 2**20
_MOST_ELEMENTS = 2**20  # the parser requires at least a hundred bytes for each, however short it is
_LONGEST_SHOWN = 60

# Beginnings of an XML document in encodings of more than one byte for a character, the longer ones first.
_WIDE = (
    *((start, "utf-32-le") for start in (b"\xff\xfe\0\0", b"<\0\0\0")),
    *((start, "utf-32-be") for start in (b"\0\0\xfe\xff", b"\0\0\0<")),
    *((start, "utf-16-le") for start in (b"\xff\xfe", b"<\0")),
    *((start, "utf-16-be") for start in (b"\xfe\xff", b"\0<")),
)
_DECLARED = re.compile(r"<\?xml[^>]*?\sencoding\s*=\s*[\"']([A-Za-z0-9._-]{1,40})[\"']")


def parse_xml(path: Path) -> etree._Element:
    """Return the root of an XML file.

    The text is decoded as UTF-8, or as ISO-8859-1 if that fails; the declared encoding is ignored. UTF-16 is
    read if the file declares it, by a byte order mark or by name.

    Raises:
        OSError: The file cannot be read.
        InputError: The file is too large, is not XML, is in another encoding, or defines entities.
    """
    text = _bounded_text(path)
    parser = etree.XMLParser(
        encoding="utf-8",
        load_dtd=False,
        no_network=True,
        resolve_entities=False,
        huge_tree=False,  # keeps libxml2's limits on depth and length of texts
        remove_comments=True,
        remove_pis=True,
        collect_ids=False,
    )
    try:
        return etree.fromstring(text.encode(), parser)
    except etree.XMLSyntaxError as error:
        raise InputError(f"is not XML: {shorten(error.msg or 'unknown error', quoted=False)}") from error


def shorten(text: str, *, quoted: bool = True) -> str:
    """Return a text from a file, shortened and printable, for a message."""
    line = " ".join(text.split())
    printable = "".join(char if char.isprintable() else "?" for char in line[: 2 * _LONGEST_SHOWN])
    longest = _LONGEST_SHOWN if quoted else 2 * _LONGEST_SHOWN
    short = printable if len(line) <= longest else f"{printable[:longest]}..."
    return f"'{short}'" if quoted else short


def _bounded_text(path: Path) -> str:
    """Return the text of a file that is small enough for the parser and declares no entities."""
    with path.open("rb") as file:
        data = file.read(_MOST_BYTES + 1)
    if len(data) > _MOST_BYTES:
        raise InputError(f"exceeds {_MOST_BYTES // 2**20} MiB")
    text = _decoded(data)
    if "<!DOCTYPE" in text or "<!ENTITY" in text:
        raise InputError("contains a DOCTYPE or an ENTITY, which is not allowed; remove it")
    # Every element has an end and every attribute quotes; materials use neither of these characters.
    elements = text.count("</") + text.count("/>")
    quotes = text.count('"') + text.count("'")
    if max(elements, quotes // 2) > _MOST_ELEMENTS:
        raise InputError(f"exceeds {_MOST_ELEMENTS} elements or attributes")
    return text


def _decoded(data: bytes) -> str:
    start, encoding = next((wide for wide in _WIDE if data.startswith(wide[0])), (b"", ""))
    if encoding:
        return _decoded_wide(data, encoding, marked=b"<" not in start)
    try:
        return data.decode("utf-8")
    except UnicodeDecodeError:
        return data.decode("iso-8859-1")


def _decoded_wide(data: bytes, encoding: str, *, marked: bool) -> str:
    """Return a text with more than one byte for a character, if the file declares its encoding."""
    name = encoding.upper()[: len("UTF-16")]
    try:
        text = data.decode(encoding).removeprefix("\ufeff")
    except UnicodeDecodeError as error:
        raise InputError(f"is not {name} text, although it begins like one") from error
    found = _DECLARED.match(text)
    declared = found[1] if found else ""
    if name != "UTF-16" or not (declared.upper().startswith(name) or (marked and not declared)):
        without = "does not declare it" if not declared else f"declares {declared}"
        problem = f"is in {name}" + (f", but {without}" if name == "UTF-16" else "")
        raise InputError(f"{problem}; expected UTF-8, or UTF-16 that is declared; save it as UTF-8")
    return text
