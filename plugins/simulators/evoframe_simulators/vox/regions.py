"""Boxes in which voxels are clamped."""

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
"""In the order of their bits, lowest first: translation along each axis, then rotation about it."""


@attrs.frozen
class FixedRegion:
    """A box; voxels that overlap it are clamped (docs/physics.md, section 8).

    Attributes:
        origin: Corner with the smallest coordinates, as fractions of the canvas.
        size: Lengths of the edges, as fractions of the canvas; the default covers the voxels at x = 0.
        degrees_of_freedom: Clamped degrees of freedom: ``x``, ``y``, ``z``, and ``rx``, ``ry``, ``rz`` for
            rotations about the axes of the world.
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
        """The clamped degrees of freedom as bits, in the numbering of solver and engine."""
        return sum(1 << DEGREES_OF_FREEDOM.index(freedom) for freedom in self.degrees_of_freedom)


def fixed_mask(regions: Iterable[FixedRegion], canvas: tuple[int, int, int]) -> NDArray[np.uint8]:
    """Return the clamped degrees of freedom of each cell as bits, ``uint8[X, Y, Z]``."""
    mask = np.zeros(canvas, np.uint8)
    for region in regions:
        inside = [overlapping(*span) for span in zip(region.origin, region.size, canvas, strict=True)]
        mask[np.ix_(*inside)] |= np.uint8(region.bits)
    return mask


def overlapping(start: float, length: float, cells: int) -> NDArray[np.bool_]:
    """Return a mask of the cells of an axis that overlap a span of it; touching is not overlapping."""
    index = np.arange(cells)
    held: NDArray[np.bool_] = ((index + 1) / cells > start) & (index / cells < start + length)
    return held
