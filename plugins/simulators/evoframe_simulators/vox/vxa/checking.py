"""Check of all tags of a file against the schema: unsupported features are reported, never ignored."""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Mapping

from lxml import etree

from evoframe_simulators.vox.vxa.document import shorten
from evoframe_simulators.vox.vxa.faults import Faults
from evoframe_simulators.vox.vxa.schema import VXA, Role, Schema
from evoframe_simulators.vox.vxa.sections import Section, parse_number

__all__ = ["collect_unsupported"]

_OFF_WORDS = ("", "false")
_MATERIAL = "VXC/Palette/Material"


def collect_unsupported(
    section: Section, used: Collection[int], faults: Faults, schema: Schema = VXA
) -> None:
    """Collect all tags of a file that enable features that vox does not simulate (see :mod:`.vxa.schema`).

    Args:
        section: The file, or a section of it.
        used: Positions in the palette, from 1, of the materials in the body; others are not checked.
        faults: Collects the tags; materials and regions are numbered.
        schema: Schema of the section.
    """
    seen: Counter[str] = Counter()
    for element in section.element:
        tag = str(element.tag)
        seen[tag] += 1
        place = section.at(tag)
        if place == _MATERIAL and seen[tag] not in used:
            continue
        if tag in ("Material", "FRegion"):
            place = f"{place} {seen[tag]}"
        role = schema.get(tag)
        if isinstance(role, Mapping):
            collect_unsupported(Section(element, place), used, faults, role)
        elif not _is_accepted(element, role):
            value = shorten(" ".join(str(text) for text in element.itertext()))
            faults.unsupported(place, value, "unknown tag" if role is None else "")


def _is_accepted(element: etree._Element, role: Role | float | None) -> bool:
    """Return whether an element enables nothing that vox does not simulate."""
    if role is None:
        return _is_off(element)
    if isinstance(role, Role):
        return role is not Role.UNSUPPORTED
    text = (element.text or "").strip()
    is_the_number = not text or parse_number(text) == role or (role == 0.0 and _is_off(element))
    return is_the_number and not len(element)


def _is_off(element: etree._Element) -> bool:
    """Return whether all texts in an element are empty, zero or ``false``."""
    texts = (str(text).strip().lower() for text in element.itertext())
    return all(text in _OFF_WORDS or parse_number(text) == 0.0 for text in texts)
