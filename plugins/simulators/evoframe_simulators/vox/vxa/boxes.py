"""Regions of a VXA file in which voxels are clamped."""

from __future__ import annotations

from collections.abc import Iterator

from evoframe import InputError
from evoframe_simulators.vox.regions import DEGREES_OF_FREEDOM, FixedRegion
from evoframe_simulators.vox.vxa.cells import Lattice, as_engine_holds
from evoframe_simulators.vox.vxa.document import shorten
from evoframe_simulators.vox.vxa.faults import Faults
from evoframe_simulators.vox.vxa.file import SHAPES
from evoframe_simulators.vox.vxa.sections import Section

__all__ = ["read_regions"]

_ALL = 2 ** len(DEGREES_OF_FREEDOM) - 1
_OLDER = {"Fixed_Regions": "NumFixed", "Forced_Regions": "NumForced"}


def read_regions(environment: Section, lattice: Lattice, faults: Faults) -> tuple[FixedRegion, ...]:
    """Return the regions that clamp cells, also those of older files; regions without effect are omitted.

    Each clamps the same cells as in the engine (see :mod:`~evoframe_simulators.vox.vxa.cells`).

    Args:
        environment: Section with ``Boundary_Conditions``, or ``Fixed_Regions`` and ``Forced_Regions``.
        lattice: The cells.
        faults: Collects the regions that are not boxes.

    Raises:
        InputError: The number of regions differs from the declared one, or a region is invalid.
    """
    newer = environment.find("Boundary_Conditions")
    older = [(environment.find(tag), counted) for tag, counted in _OLDER.items()]
    if newer is None:
        found = [region for section, counted in older for region in _listed(section, counted)]
    else:
        found = list(_listed(newer, "NumBCs"))
        for section, counted in older:
            if section is not None and any(_listed(section, counted)):  # the engine ignores these
                faults.unsupported(section.place, "regions", "beside Boundary_Conditions")
    boxes = [_box(region, faults) for region in found]
    holding = [box for box in boxes if box is not None and box.degrees_of_freedom]
    held = [as_engine_holds(box, lattice) for box in holding]
    return tuple(box for box in held if box is not None)


def _listed(section: Section | None, counted: str) -> Iterator[Section]:
    if section is None:
        return
    declared, found = section.whole(counted, 0), section.count("FRegion")
    if declared != found:
        raise InputError(
            f"found {declared}, expected {found}, the number of FRegion", key=section.at(counted)
        )
    yield from section.all("FRegion")


def _box(region: Section, faults: Faults) -> FixedRegion | None:
    shape = region.whole("PrimType", most=len(SHAPES) - 1)
    if shape:
        faults.unsupported(region.at("PrimType"), shorten(str(shape)), f"{SHAPES[shape]}; vox supports boxes")
        return None
    x, y, z = (region.number(axis, 0.0) for axis in "XYZ")
    dx, dy, dz = (region.number(f"d{axis}", 0.0, least=0.0) for axis in "XYZ")
    bits = region.whole("DofFixed", _ALL if region.flag("Fixed") else 0, most=_ALL)
    held = tuple(freedom for n, freedom in enumerate(DEGREES_OF_FREEDOM) if bits >> n & 1)
    return FixedRegion((x, y, z), (dx, dy, dz), held)
