"""Regions from the centre of a cell to that of another, which hold the same cells however it is computed.

The engine compares the faces of a region with those of the cells in another arithmetic than ``vox``. Where
a face lies between two cells, rounding may make the one hold a cell that the other does not.
"""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections.abc import Sequence
from typing import TypeAlias

import attrs
import numpy as np

from evoframe_simulators.vox.regions import FixedRegion, overlapping

__all__ = ["Lattice", "as_engine_holds", "as_vox_holds"]

_Span: TypeAlias = tuple[int, int] | None  # the first and the last cell along an axis


@attrs.frozen
class Lattice:
    """The cells of a file.

    Attributes:
        canvas: Cells along x, y and z.
        edge: Of a cell, m.
    """

    canvas: tuple[int, int, int]
    edge: float


def as_vox_holds(region: FixedRegion, canvas: tuple[int, int, int]) -> FixedRegion | None:
    """Return a region from centre to centre that holds what ``vox`` holds; nothing if that is no cell."""
    axes = zip(region.origin, region.size, canvas, strict=True)
    held = [np.flatnonzero(overlapping(*span)).tolist() for span in axes]
    spans = [(cells[0], cells[-1]) if cells else None for cells in held]
    return _from_centre_to_centre(region, spans, canvas)


def as_engine_holds(region: FixedRegion, lattice: Lattice) -> FixedRegion | None:
    """Return a region from centre to centre that holds what the engine holds; nothing if that is no cell."""
    axes = zip(region.origin, region.size, lattice.canvas, strict=True)
    spans = [_held_by_engine(*span, lattice.edge) for span in axes]
    return _from_centre_to_centre(region, spans, lattice.canvas)


def _held_by_engine(start: float, length: float, cells: int, edge: float) -> _Span:
    """Return the cells whose centres, moved by half an edge either way, are beyond the region's faces."""
    whole = edge * cells
    half = edge / 2 / whole

    def centre(cell: int) -> float:
        return edge * (cell + 0.5) / whole

    # Rounded as they are, the faces ascend; so there is no need to look at all of the cells.
    first = bisect_right(range(cells), start, key=lambda cell: centre(cell) + half)
    past = bisect_left(range(cells), start + length, key=lambda cell: centre(cell) - half)
    return (first, past - 1) if first < past else None


def _from_centre_to_centre(
    region: FixedRegion, spans: Sequence[_Span], canvas: tuple[int, int, int]
) -> FixedRegion | None:
    held = [span for span in spans if span is not None]
    if len(held) < len(canvas):
        return None
    x, y, z = ((first + 0.5) / cells for (first, _), cells in zip(held, canvas, strict=True))
    dx, dy, dz = ((last - first) / cells for (first, last), cells in zip(held, canvas, strict=True))
    return attrs.evolve(region, origin=(x, y, z), size=(dx, dy, dz))
