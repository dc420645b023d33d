"""Regions with faces at the centers of cells, which clamp the same cells in the engine and in ``vox``.

Engine and ``vox`` compare the faces of a region with those of cells in different arithmetic. If a face lies
between two cells, rounding may include a cell in one of them but not in the other.
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
        canvas: Number of cells along x, y and z.
        edge: Edge of a cell, m.
    """

    canvas: tuple[int, int, int]
    edge: float


def as_vox_holds(region: FixedRegion, canvas: tuple[int, int, int]) -> FixedRegion | None:
    """Return a center-to-center region with the cells that ``vox`` clamps; ``None`` if there are none."""
    axes = zip(region.origin, region.size, canvas, strict=True)
    held = [np.flatnonzero(overlapping(*span)).tolist() for span in axes]
    spans = [(cells[0], cells[-1]) if cells else None for cells in held]
    return _from_center_to_center(region, spans, canvas)


def as_engine_holds(region: FixedRegion, lattice: Lattice) -> FixedRegion | None:
    """Return a center-to-center region with the cells that the engine clamps; ``None`` if there are none."""
    axes = zip(region.origin, region.size, lattice.canvas, strict=True)
    spans = [_held_by_engine(*span, lattice.edge) for span in axes]
    return _from_center_to_center(region, spans, lattice.canvas)


def _held_by_engine(start: float, length: float, cells: int, edge: float) -> _Span:
    """Return the cells whose upper face is beyond the region's start and lower face before its end."""
    whole = edge * cells
    half = edge / 2 / whole

    def center(cell: int) -> float:
        return edge * (cell + 0.5) / whole

    # The faces ascend despite rounding, so a binary search finds the cells.
    first = bisect_right(range(cells), start, key=lambda cell: center(cell) + half)
    past = bisect_left(range(cells), start + length, key=lambda cell: center(cell) - half)
    return (first, past - 1) if first < past else None


def _from_center_to_center(
    region: FixedRegion, spans: Sequence[_Span], canvas: tuple[int, int, int]
) -> FixedRegion | None:
    held = [span for span in spans if span is not None]
    if len(held) < len(canvas):
        return None
    x, y, z = ((first + 0.5) / cells for (first, _), cells in zip(held, canvas, strict=True))
    dx, dy, dz = ((last - first) / cells for (first, last), cells in zip(held, canvas, strict=True))
    return attrs.evolve(region, origin=(x, y, z), size=(dx, dy, dz))
