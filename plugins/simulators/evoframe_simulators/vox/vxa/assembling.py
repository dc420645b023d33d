"""Reading of VXA, VXC and VXD files as documents with the sections of a VXA file.

A VXC file has only the section ``VXC``: lattice, palette and body. A VXD file of voxcraft has sections that
replace those of a base, a VXA file: the attribute ``replace`` of each names the section, as in
``VXA.VXC.Structure``.
"""

from __future__ import annotations

import re
from pathlib import Path

import attrs
from lxml import etree

from evoframe import ConfigurationError, InputError
from evoframe_simulators.files import naming_source
from evoframe_simulators.vox.vxa.document import parse_xml, shorten
from evoframe_simulators.vox.vxa.sections import Section

__all__ = ["SUFFIXES", "Document", "read_document"]

SUFFIXES = (".vxa", ".vxc", ".vxd")

_PATH = re.compile(r"VXA(\.[A-Za-z_][A-Za-z0-9_]*){1,8}")
_MOST_REPLACED = 100


@attrs.frozen
class Document:
    """A file, completed by its base.

    Attributes:
        root: Contents with the sections of a VXA file.
        base: The base, if there is one.
        complete: Whether it has settings of a simulation, which a VXC file alone lacks.
    """

    root: Section
    base: Path | None = None
    complete: bool = True


def read_document(path: Path, base: Path | None = None) -> Document:
    """Read a file; the root tag tells its kind.

    Args:
        path: A VXA, VXC or VXD file.
        base: VXA file that completes a VXC or VXD file. Without it, a VXD file is completed by ``base.vxa``
            in its directory, or by the only VXA file there.

    Raises:
        InputError: A file cannot be read or is of another kind, or a VXD file has no base.
        ConfigurationError: A VXA file has a base.
    """
    with naming_source(path):
        element = parse_xml(path)
        tag = str(element.tag)
        if tag not in ("VXA", "VXC", "VXD"):
            raise InputError(
                f"is not a VXA file: found root tag {shorten(tag)}, expected VXA, VXC (a body alone) or VXD "
                "(sections that replace those of a base)"
            )
    if tag == "VXA":
        if base is not None:
            raise ConfigurationError(f"{path} is a VXA file, which has no base", source="--base")
        return Document(Section(element, ""))
    if tag == "VXC" and base is None:
        return Document(Section(_within("VXA", element), ""), complete=False)
    found = base or _sibling(path)
    whole = _vxa(found)
    with naming_source(path):
        parts = [("VXA.VXC", element)] if tag == "VXC" else _parts(element)
        for target, part in parts:
            _replace(whole, target.split(".")[1:], part)
    return Document(Section(whole, ""), found)


def _within(tag: str, element: etree._Element) -> etree._Element:
    parent = etree.Element(tag)
    parent.append(element)
    return parent


def _vxa(path: Path) -> etree._Element:
    with naming_source(path):
        element = parse_xml(path)
        if element.tag != "VXA":
            raise InputError(f"found root tag {shorten(str(element.tag))}, expected VXA, as in every base")
    return element


def _sibling(path: Path) -> Path:
    """Return the base of a VXD file in its directory."""
    with naming_source(path.parent):
        found = sorted(each for each in path.parent.iterdir() if each.suffix.lower() == ".vxa")
    named = [each for each in found if each.name.lower() == "base.vxa"] or found
    if len(named) != 1:
        problem = "no VXA file is beside it" if not named else f"{len(named)} VXA files are beside it"
        raise InputError(
            f"is a VXD file, which completes a base, but {problem}; name the base with --base", source=path
        )
    return named[0]


def _parts(element: etree._Element) -> list[tuple[str, etree._Element]]:
    """Return the sections that replace others, with the path of each, as voxcraft does."""
    parts = [(str(part.get("replace", "")), part) for part in element]
    named = [(target, part) for target, part in parts if target]
    if not named or len(named) > _MOST_REPLACED:
        raise InputError(f"found {len(named)} tags with the attribute replace, expected some", key="VXD")
    for target, part in named:
        if not _PATH.fullmatch(target):
            found = f"found {shorten(target)}, expected a path such as VXA.VXC.Structure"
            raise InputError(found, key=f"VXD/{part.tag} replace")
    return named


def _replace(whole: etree._Element, path: list[str], part: etree._Element) -> None:
    """Put a section in the place of the one at *path*, and create those around it that are missing."""
    parent = whole
    for tag in path[:-1]:
        inner = parent.find(tag)
        parent = etree.SubElement(parent, tag) if inner is None else inner
    part.tag = path[-1]
    if "replace" in part.attrib:
        del part.attrib["replace"]
    old = parent.find(path[-1])
    if old is None:
        parent.append(part)
    else:
        parent.replace(old, part)
