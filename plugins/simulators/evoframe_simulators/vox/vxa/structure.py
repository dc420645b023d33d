"""The body in a VXA file: layer upon layer of characters, and the offsets of its voxels."""

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
from evoframe_simulators.vox.vxa.document import shown
from evoframe_simulators.vox.vxa.file import FIRST_CHARACTER
from evoframe_simulators.vox.vxa.sections import Section, number_in

__all__ = ["canvas_in", "material_in", "phase_in"]

T = TypeVar("T", np.uint8, np.float64)


def canvas_in(structure: Section) -> tuple[int, int, int]:
    """Return how many cells there are along x, y and z.

    Raises:
        InputError: A length is no whole number from 1, or there are too many cells.
    """
    x, y, z = (structure.whole(f"{axis}_Voxels", least=1) for axis in "XYZ")
    if math.prod((x, y, z)) > MOST_CELLS:
        raise InputError(f"{structure.place} has {x} x {y} x {z} = {x * y * z} cells; at most {MOST_CELLS}")
    return x, y, z


def material_in(structure: Section, canvas: tuple[int, int, int], materials: int) -> NDArray[np.uint8]:
    """Return the materials of the cells, ``uint8[X, Y, Z]``.

    Args:
        structure: Has one layer of characters for each z, x fastest.
        canvas: Cells along x, y and z.
        materials: How many the palette has.

    Raises:
        InputError: Layers are missing or have another length, a material is not in the palette, or there is
            no voxel.
    """
    rows = []
    for layer in _layers(structure.need("Data"), canvas):
        cells = _text(layer)
        if len(cells) != canvas[0] * canvas[1]:
            raise InputError(f"{layer.place} has {len(cells)} cells; expected {canvas[0]} x {canvas[1]}")
        codes = np.frombuffer(cells.encode("utf-32-le"), "<u4").astype(np.int64) - FIRST_CHARACTER
        wrong = np.flatnonzero((codes < 0) | (codes > materials))
        if wrong.size:
            raise InputError(
                f"{layer.place} has the cell {shown(cells[wrong[0]])}, material {codes[wrong[0]]}; "
                f"the palette has {materials}, and 0 is empty"
            )
        rows.append(codes.astype(np.uint8))
    material = _arranged(rows, canvas)
    if not material.any():
        raise InputError(f"{structure.place} has no voxel")
    return material


def phase_in(structure: Section, canvas: tuple[int, int, int]) -> NDArray[np.float64]:
    """Return the phase offsets of the cells, ``float64[X, Y, Z]``; 0 everywhere if there are none.

    Raises:
        InputError: Layers are missing or have another length, or hold something else.
    """
    section = structure.find("PhaseOffset")
    if section is None:
        return np.zeros(canvas)
    rows = []
    for layer in _layers(section, canvas):
        items = _text(layer).removesuffix(",")  # which may follow the last offset
        cells = items.count(",") + 1
        if cells != canvas[0] * canvas[1]:  # before so many strings are made
            raise InputError(f"{layer.place} has {cells} offsets; expected {canvas[0]} x {canvas[1]}")
        row = np.empty(cells)
        for n, item in enumerate(items.split(",")):
            offset = number_in(item.strip())
            if offset is None:
                raise InputError(f"{layer.place} has the offset {shown(item)}; expected a finite number")
            row[n] = offset
        rows.append(row)
    phase = _arranged(rows, canvas)
    check_cycles(phase, section.place)
    return phase


def _layers(section: Section, canvas: tuple[int, int, int]) -> Iterator[Section]:
    layers = section.count("Layer")
    if layers != canvas[2]:
        raise InputError(f"{section.place} has {layers} layers; expected Z_Voxels = {canvas[2]}")
    yield from section.all("Layer")


def _text(layer: Section) -> str:
    if len(layer.element):
        raise InputError(f"{layer.place} has tags in it; expected text")
    return (layer.element.text or "").strip(whitespace)  # of ASCII: others are the materials 85 and 112


def _arranged(rows: list[NDArray[T]], canvas: tuple[int, int, int]) -> NDArray[T]:
    """Return layers, x fastest, as an array ``[X, Y, Z]``."""
    x, y, z = canvas
    return np.ascontiguousarray(np.stack(rows).reshape(z, y, x).transpose(2, 1, 0))
