"""The contents of a VXA file, and the settings that simulate it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import attrs
import numpy as np
from numpy.typing import NDArray

from evoframe import InputError
from evoframe_simulators.vox.models import possible_clocks, time_step_of, without_number
from evoframe_simulators.vox.settings import VoxSettings

__all__ = ["FIRST_CHARACTER", "SHAPES", "VxaFile"]

FIRST_CHARACTER = 48
"""In a layer of the structure, a material is one character: ``0`` and the position in the palette added."""

SHAPES = ("a box", "a cylinder", "a sphere", "a mesh")
"""What a region's ``PrimType`` stands for."""


@attrs.frozen(eq=False)
class VxaFile:
    """A body with its controller, and the options of ``vox`` that say how it is to be simulated.

    Attributes:
        options: Name -> value, as arguments of ``VoxSettings``.
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

    def settings(self) -> VoxSettings:
        """Return the settings that simulate the body; those that a file does not name have their defaults.

        Raises:
            InputError: A value is out of range, or the solver cannot work with them; says which, or why.
        """
        try:
            settings = VoxSettings(**self.options)
            if self.steps is not None:
                duration = (self.steps - 0.5) * time_step_of(settings, self.material)
                settings = attrs.evolve(settings, duration=duration)
            possible_clocks(settings)
        except ValueError as error:
            raise InputError(without_number(error)) from error
        return settings
