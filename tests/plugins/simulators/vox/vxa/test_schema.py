"""Tags of the dialect: each has one place and one treatment."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from pathlib import Path

import pytest
from lxml import etree

from evoframe_simulators.vox.vxa.schema import MATERIAL, REGION, VXA, Role, Schema

EXAMPLES = sorted((Path(__file__).parents[4] / "data" / "vxa").glob("*.vxa"))


UNKNOWN = {
    f"Simulator/{tag}" for tag in ("ErrorThreshold", "ThresholdTime", "MaxKP", "MaxKI", "MaxANTIWINDUP")
}
"""Tags that the authors write and their engine ignores; they are 0 in the example."""


def places(schema: Schema, place: str = "") -> Iterator[tuple[str, Schema | Role | float]]:
    """Yield the path and the role of every tag."""
    for tag, role in schema.items():
        yield f"{place}{tag}", role
        if isinstance(role, Mapping):
            yield from places(role, f"{place}{tag}/")


def test_every_tag_has_a_section_a_role_or_an_accepted_number() -> None:
    for place, role in places(VXA):
        assert isinstance(role, Role | float) or role, place


def test_materials_and_regions_have_their_named_schemas() -> None:
    known = dict(places(VXA))
    assert known["VXC/Palette/Material"] is MATERIAL
    assert {place for place, role in known.items() if role is REGION} == {
        f"Environment/{tag}/FRegion" for tag in ("Boundary_Conditions", "Fixed_Regions", "Forced_Regions")
    }


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_all_tags_of_the_examples_with_an_effect_are_known(path: Path) -> None:
    known = dict(places(VXA))
    inside = tuple(f"{place}/" for place, role in known.items() if not isinstance(role, Mapping))
    tree = etree.parse(path)
    found = {
        re.sub(r"\[\d+\]", "", tree.getelementpath(element))
        for element in tree.getroot().iterdescendants("*")
    }
    assert {place for place in found - {*known} if not place.startswith(inside)} <= UNKNOWN
