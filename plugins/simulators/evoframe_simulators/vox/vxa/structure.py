"""Body of a VXA file: layers of encoded materials, and of numbers for offsets."""

from __future__ import annotations

import math
from collections.abc import Iterator
from string import whitespace
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from evoframe import InputError
from evoframe_simulators.vox.bodies import check_cycles
from evoframe_simulators.vox.limits import LARGEST_CODE, MOST_CELLS
from evoframe_simulators.vox.vxa.compression import decode_layer
from evoframe_simulators.vox.vxa.document import shorten
from evoframe_simulators.vox.vxa.sections import Section, parse_number

__all__ = ["read_canvas", "read_material", "read_phase"]

T = TypeVar("T", np.uint8, np.float64)

_BEGINNING = 200  # characters of a layer in which blanks are looked for


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


def read_material(
    structure: Section, canvas: tuple[int, int, int], materials: int, compression: str = "ASCII_READABLE"
) -> NDArray[np.uint8]:
    """Return the materials of the cells, ``uint8[X, Y, Z]``.

    Args:
        structure: Section with one layer for each z, x fastest.
        canvas: Number of cells along x, y and z.
        materials: Number of materials in the palette.
        compression: Encoding of the layers, a key of :data:`~.compression.COMPRESSIONS`.

    Raises:
        InputError: Layers are missing or have another length, a material is not in the palette, or there are
            no voxels.
    """
    rows = []
    for layer in _layers(structure.need("Data"), canvas):
        try:
            codes = decode_layer(_text(layer), compression, canvas[0] * canvas[1])
        except InputError as error:
            raise InputError(f"{error.problem}{_sides(canvas)}", key=layer.place) from error
        wrong = np.flatnonzero((codes < 0) | (codes > min(materials, LARGEST_CODE)))
        if wrong.size:
            raise InputError(
                f"cell {wrong[0] + 1}{_shown(layer, compression, wrong[0])} has material {codes[wrong[0]]}, "
                f"expected 0 (empty) to {materials}, the number of materials in the palette",
                key=layer.place,
            )
        rows.append(codes.astype(np.uint8))
    material = _arranged(rows, canvas)
    if not material.any():
        raise InputError("has no voxels", key=structure.place)
    return material


def _sides(canvas: tuple[int, int, int]) -> str:
    return f" (X_Voxels x Y_Voxels = {canvas[0]} x {canvas[1]})"


def _shown(layer: Section, compression: str, cell: int) -> str:
    """Return the character of a cell for a message, if cells are characters."""
    return f" {shorten(_text(layer)[cell])}" if compression == "ASCII_READABLE" else ""


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
            blanks = ", found blanks" if cells == 1 and len(items[:_BEGINNING].split()) > 1 else ""
            raise InputError(
                f"found {cells} {'offset' if cells == 1 else 'offsets'}, expected {canvas[0]} x {canvas[1]} "
                f"with commas between them{blanks}",
                key=layer.place,
            )
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
