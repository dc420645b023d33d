"""Every tag of a file against the schema: what vox does not simulate is named, never ignored."""

from __future__ import annotations

from collections.abc import Collection

from lxml import etree

from evoframe_simulators.vox.vxa.document import shown
from evoframe_simulators.vox.vxa.schema import VXA, Role, Schema
from evoframe_simulators.vox.vxa.sections import Refusals, Section, number_in

__all__ = ["refuse_the_unknown"]

_OFF_WORDS = ("", "false")
_MATERIAL = "VXC/Palette/Material"


def refuse_the_unknown(root: Section, used: Collection[int], refusals: Refusals) -> None:
    """Note every tag of a file that asks for more than vox does (see :mod:`.vxa.schema`).

    Args:
        root: The file.
        used: The positions in the palette, from 1, of the materials that voxels have; others are passed by.
        refusals: Where it is noted.
    """
    _check_section(root, VXA, used, refusals)


def _check_section(section: Section, schema: Schema, used: Collection[int], refusals: Refusals) -> None:
    """Check all tags in a section; equal names are numbered where there may be several."""
    seen: dict[str, int] = {}
    for element in section.element:
        tag = str(element.tag)
        seen[tag] = seen.get(tag, 0) + 1
        place = section.at(tag)
        if place == _MATERIAL and seen[tag] not in used:
            continue
        if tag in ("Material", "FRegion"):
            place = f"{place} {seen[tag]}"
        _check_tag(Section(element, place), schema.get(tag), used, refusals)


def _check_tag(
    found: Section, role: Schema | Role | float | None, used: Collection[int], refusals: Refusals
) -> None:
    if role is None:
        if not _is_off(found.element):
            refusals.add(found.place, _value(found.element), "unknown to vox")
    elif role is Role.REFUSED:
        refusals.add(found.place, _value(found.element))
    elif isinstance(role, float):
        if not _is(found.element, role):
            refusals.add(found.place, _value(found.element))
    elif not isinstance(role, Role):
        _check_section(found, role, used, refusals)


def _is(element: etree._Element, wanted: float) -> bool:
    """Return whether an element holds the one number that is accepted, or nothing."""
    text = (element.text or "").strip()
    return not len(element) and (
        not text or number_in(text) == wanted or (wanted == 0.0 and _is_off(element))
    )


def _is_off(element: etree._Element) -> bool:
    """Return whether all that an element holds is empty, a zero or ``false``."""
    texts = (str(text).strip().lower() for text in element.itertext())
    return all(text in _OFF_WORDS or number_in(text) == 0.0 for text in texts)


def _value(element: etree._Element) -> str:
    return shown(" ".join(str(text) for text in element.itertext()))
