"""Regions of a VXA file: those that clamp cells are read and written, others are ignored."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import attrs
import pytest
from bars import bar
from lxml import etree

from evoframe import InputError
from evoframe_simulators import FixedRegion, Vox
from evoframe_simulators.vox.vxa import read_vxa
from evoframe_simulators.vox.vxa.boxes import read_regions
from evoframe_simulators.vox.vxa.cells import Lattice
from evoframe_simulators.vox.vxa.faults import Faults
from evoframe_simulators.vox.vxa.sections import Section

Write = Callable[..., Path]

LATTICE = Lattice((4, 1, 1), 0.05)
BOX = "<FRegion><PrimType>0</PrimType><dX>0.1</dX><dY>1</dY><dZ>1</dZ><DofFixed>{}</DofFixed></FRegion>"


def found(text: str) -> tuple[tuple[FixedRegion, ...], Faults]:
    """Return the regions of an environment and its faults."""
    faults = Faults()
    return read_regions(Section(etree.fromstring(f"<E>{text}</E>"), "E"), LATTICE, faults), faults


@pytest.mark.parametrize(
    "section", ["Boundary_Conditions/NumBCs", "Fixed_Regions/NumFixed", "Forced_Regions/NumForced"]
)
def test_each_section_of_regions_is_read_and_counted(section: str) -> None:
    tag, counted = section.split("/")
    [region], _ = found(f"<{tag}><{counted}>1</{counted}>{BOX.format(5)}</{tag}>")
    assert region.degrees_of_freedom == ("x", "z")
    assert (region.origin[0], region.size[0]) == (0.5 / 4, 0.0)
    with pytest.raises(InputError, match=r"found 2, expected 1, .* FRegion") as caught:
        found(f"<{tag}><{counted}>2</{counted}>{BOX.format(5)}</{tag}>")
    assert caught.value.key == f"E/{section}"


def test_older_sections_add_up_and_clamp_with_a_flag() -> None:
    flag = BOX.replace("<DofFixed>{}</DofFixed>", "<Fixed>1</Fixed>")
    regions, faults = found(
        f"<Fixed_Regions><NumFixed>1</NumFixed>{flag}</Fixed_Regions>"
        f"<Forced_Regions><NumForced>1</NumForced>{BOX.format(1)}</Forced_Regions>"
    )
    assert [len(region.degrees_of_freedom) for region in regions] == [6, 1]
    faults.check()


def test_older_sections_beside_newer_ones_are_rejected() -> None:
    _, faults = found(
        f"<Boundary_Conditions><NumBCs>0</NumBCs></Boundary_Conditions>"
        f"<Fixed_Regions><NumFixed>1</NumFixed>{BOX.format(1)}</Fixed_Regions>"
    )
    with pytest.raises(InputError, match=r"Boundary_Conditions\)$") as caught:
        faults.check()
    assert caught.value.key == "E/Fixed_Regions"


@pytest.mark.parametrize(
    "region",
    [
        FixedRegion((1.0, 0.0, 0.0), (1.0, 1.0, 1.0)),
        FixedRegion((-1.0, 0.0, 0.0), (1.0, 1.0, 1.0)),
        FixedRegion((0.0, 2.0, 0.0), (1.0, 1.0, 1.0)),
        FixedRegion((0.5, 0.0, 0.0), (0.0, 1.0, 1.0)),
    ],
)
def test_regions_without_cells_are_neither_written_nor_counted(region: FixedRegion) -> None:
    root = etree.fromstring(Vox(fixed=(region, FixedRegion())).export(bar(1, 1, 1, 1), "vxa").data)
    [section] = root.findall("Environment/Boundary_Conditions")
    assert section.findtext("NumBCs") == "1"
    assert [found.findtext("DofFixed") for found in section.findall("FRegion")] == ["63"]
    alone = etree.fromstring(Vox(fixed=(region,)).export(bar(1, 1, 1, 1), "vxa").data)
    assert alone.findtext("Environment/Boundary_Conditions/NumBCs") == "0"


def test_regions_without_cells_are_not_read(vxa: Write) -> None:
    assert read_vxa(vxa(X=1.5)).options["fixed"] == ()


@pytest.mark.parametrize("edge", ["5e-324", "1e308"])
def test_an_edge_out_of_range_is_rejected(vxa: Write, edge: str) -> None:
    path = vxa(Lattice_Dim=edge)
    with pytest.raises(InputError) as caught:
        Vox.settings_of(path)
    assert caught.value.source == str(path)


def test_settings_do_not_change_when_written_again(tmp_path: Path) -> None:
    path = tmp_path / "a.vxa"
    path.write_bytes(Vox().export(bar(1, 1, 1, 1), "vxa").data)
    once = read_vxa(path).settings()
    path.write_bytes(Vox(**attrs.asdict(once, recurse=False)).export(bar(1, 1, 1, 1), "vxa").data)
    assert read_vxa(path).settings() == once
