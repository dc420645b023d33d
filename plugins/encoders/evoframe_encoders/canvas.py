"""Input points of networks: the coordinates of the voxels of a canvas."""

from __future__ import annotations

from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

__all__ = ["Canvas", "voxel_points"]

Canvas: TypeAlias = tuple[int, int, int]
"""Number of voxels along x, y and z."""


def voxel_points(canvas: Canvas, normalized: bool) -> NDArray[np.float64]:
    """Return the coordinates of all voxels, ``float64[X, Y, Z, 3]``.

    Args:
        canvas: Number of voxels along x, y and z.
        normalized: Whether each axis runs from -1 to 1 (0 if it has one voxel), instead of the voxel indices.
    """
    axes = [np.linspace(-1.0, 1.0, n) if normalized else np.arange(n, dtype=np.float64) for n in canvas]
    if normalized:
        axes = [axis if len(axis) > 1 else np.zeros(1) for axis in axes]
    return np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1)
