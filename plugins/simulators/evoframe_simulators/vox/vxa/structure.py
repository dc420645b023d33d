"""Body of a VXA file: layers of characters for materials, and of numbers for offsets."""

from __future__ import annotations

import math
from collections.abc import Iterator
from string import whitespace
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from evoframe import InputError
from evoframe_simulators.vox.bodies import check_cycles
from evoframe_simulators.vox.limits import MOST_CELLS
from evoframe_simulators.vox.vxa.document import shorten
from evoframe_simulators.vox.vxa.file import FIRST_CHARACTER
from evoframe_simulators.vox.vxa.sections import Section, parse_number

__all__ = ["read_canvas", "read_material", "read_phase"]

T = TypeVar("T", np.uint8, np.float64)


def read_canvas(structure: Section) -> tuple[int, int, int]:
    """Return the number of cells along x, y and z.

    Raises:
        InputError: A number is not a positive integer, or there are too many cells.
    """
    x, y, z = (structure.whole(f"{axis}_Voxels", least=1) for axis in "XYZ")
    if math.prod((x, y, z)) > MOST_CELLS:
        found = f"{x} x {y} x {z} = {x * y * z}"
        raise InputError(f"found {found} cells, expected at most {MOST_CELLS}", key=structure.place)
    return x, y, z


def read_material(structure: Section, canvas: tuple[int, int, int], materials: int) -> NDArray[np.uint8]:
    """Return the materials of the cells, ``uint8[X, Y, Z]``.

    Args:
        structure: Section with one layer of characters for each z, x fastest.
        canvas: Number of cells along x, y and z.
        materials: Number of materials in the palette.

    Raises:
        InputError: Layers are missing or have another length, a material is not in the palette, or there are
            no voxels.
    """
    rows = []
    for layer in _layers(structure.need("Data"), canvas):
        cells = _text(layer)
        if len(cells) != canvas[0] * canvas[1]:
            raise InputError(f"found {len(cells)} cells, expected {canvas[0]} x {canvas[1]}", key=layer.place)
        codes = np.frombuffer(cells.encode("utf-32-le"), "<u4").astype(np.int64) - FIRST_CHARACTER
        wrong = np.flatnonzero((codes < 0) | (codes > materials))
        if wrong.size:
            raise InputError(
                f"cell {shorten(cells[wrong[0]])} has material {codes[wrong[0]]}, expected 0 (empty) to "
                f"{materials}, the number of materials in the palette",
                key=layer.place,
            )
        rows.append(codes.astype(np.uint8))
    material = _arranged(rows, canvas)
    if not material.any():
        raise InputError("has no voxels", key=structure.place)
    return material


def read_phase(structure: Section, canvas: tuple[int, int, int]) -> NDArray[np.float64]:
    """Return the phase offsets of the cells, ``float64[X, Y, Z]``; 0 everywhere if the section is missing.

    Raises:
        InputError: Layers are missing, have another length, or contain something other than numbers.
    """
    section = structure.find("PhaseOffset")
    if section is None:
        return np.zeros(canvas)
    rows = []
    for layer in _layers(section, canvas):
        items = _text(layer).removesuffix(",")  # a comma may follow the last offset
        cells = items.count(",") + 1
        if cells != canvas[0] * canvas[1]:  # before creating the strings
            raise InputError(f"found {cells} offsets, expected {canvas[0]} x {canvas[1]}", key=layer.place)
        row = np.empty(cells)
        for n, item in enumerate(items.split(",")):
            offset = parse_number(item.strip())
            if offset is None:
                raise InputError(f"found offset {shorten(item)}, expected a finite number", key=layer.place)
            row[n] = offset
        rows.append(row)
    phase = _arranged(rows, canvas)
    check_cycles(phase, section.place)
    return phase


def _layers(section: Section, canvas: tuple[int, int, int]) -> Iterator[Section]:
    layers = section.count("Layer")
    if layers != canvas[2]:
        raise InputError(f"found {layers} layers, expected Z_Voxels = {canvas[2]}", key=section.place)
    yield from section.all("Layer")


def _text(layer: Section) -> str:
    if len(layer.element):
        raise InputError("found tags, expected text", key=layer.place)
    return (layer.element.text or "").strip(whitespace)  # ASCII; other blanks are materials 85 and 112


def _arranged(rows: list[NDArray[T]], canvas: tuple[int, int, int]) -> NDArray[T]:
    """Arrange layers, x fastest, as an array ``[X, Y, Z]``."""
    x, y, z = canvas
    return np.ascontiguousarray(np.stack(rows).reshape(z, y, x).transpose(2, 1, 0))
