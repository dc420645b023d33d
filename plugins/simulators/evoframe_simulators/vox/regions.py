"""Boxes in which voxels are held."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Literal, get_args

import attrs
import numpy as np
from attrs import validators
from numpy.typing import NDArray

from evoframe_simulators.vox.limits import check_distinct, check_finite

__all__ = ["DEGREES_OF_FREEDOM", "DegreeOfFreedom", "FixedRegion", "fixed_mask", "overlapping"]

DegreeOfFreedom = Literal["x", "y", "z", "rx", "ry", "rz"]

DEGREES_OF_FREEDOM: tuple[DegreeOfFreedom, ...] = get_args(DegreeOfFreedom)
"""In the order of their bits, the lowest first: the position along each axis, and the rotation about it."""


@attrs.frozen
class FixedRegion:
    """A box; voxels that overlap it are held where they are (physics.md, section 8).

    Attributes:
        origin: The box's corner with the least coordinates, as fractions of the canvas.
        size: Its edges, as fractions of the canvas. The default is the slab x = 0.
        degrees_of_freedom: Which of them the voxels lose: ``x``, ``y``, ``z``, and ``rx``, ``ry``, ``rz`` for
            the rotations about the axes of the world.
    """

    origin: tuple[float, float, float] = attrs.field(default=(0.0, 0.0, 0.0), validator=check_finite)
    size: tuple[float, float, float] = attrs.field(
        default=(0.001, 1.0, 1.0), validator=[validators.deep_iterable(validators.ge(0.0)), check_finite]
    )
    degrees_of_freedom: tuple[DegreeOfFreedom, ...] = attrs.field(
        default=DEGREES_OF_FREEDOM,
        validator=[validators.deep_iterable(validators.in_(DEGREES_OF_FREEDOM)), check_distinct],
    )

    @property
    def bits(self) -> int:
        """The degrees of freedom as the solver and the engine number them."""
        return sum(1 << DEGREES_OF_FREEDOM.index(freedom) for freedom in self.degrees_of_freedom)


def fixed_mask(regions: Iterable[FixedRegion], canvas: tuple[int, int, int]) -> NDArray[np.uint8]:
    """Return the degrees of freedom that each cell has lost, as bits, ``uint8[X, Y, Z]``."""
    mask = np.zeros(canvas, np.uint8)
    for region in regions:
        inside = [overlapping(*span) for span in zip(region.origin, region.size, canvas, strict=True)]
        mask[np.ix_(*inside)] |= np.uint8(region.bits)
    return mask


def overlapping(start: float, length: float, cells: int) -> NDArray[np.bool_]:
    """Return which cells of an axis overlap a span in fractions of it; what only touches it does not."""
    index = np.arange(cells)
    held: NDArray[np.bool_] = ((index + 1) / cells > start) & (index / cells < start + length)
    return held
