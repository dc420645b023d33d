"""What a VXA file says."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import attrs
import numpy as np
from numpy.typing import NDArray

__all__ = ["FIRST_CHARACTER", "SHAPES", "VxaFile"]

FIRST_CHARACTER = 48
"""In a layer of the structure, a material is one character: ``0`` and the position in the palette added."""

SHAPES = ("a box", "a cylinder", "a sphere", "a mesh")
"""What a region's ``PrimType`` stands for."""


@attrs.frozen(eq=False)
class VxaFile:
    """A body with its controller, and the options of ``vox`` that describe how it is to be simulated.

    Attributes:
        options: Name -> value, as arguments of ``Vox``.
        material: ``uint8[X, Y, Z]``, positions in the palette; 0 is empty.
        phase: ``float64[X, Y, Z]``, the offsets as they stand in the file, which the engine reads in cycles.
        steps: How many steps to make, if the file counts them and says no duration.
    """

    options: Mapping[str, Any]
    material: NDArray[np.uint8]
    phase: NDArray[np.float64]
    steps: int | None = None

    @property
    def canvas(self) -> tuple[int, int, int]:
        """Cells along x, y and z."""
        x, y, z = self.material.shape
        return x, y, z
