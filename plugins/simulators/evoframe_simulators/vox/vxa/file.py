"""Contents of a VXA file, and its settings."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import attrs
import numpy as np
from numpy.typing import NDArray

from evoframe import InputError
from evoframe_simulators.vox.models import possible_clocks, strip_body_index, time_step_of
from evoframe_simulators.vox.settings import VoxSettings

__all__ = ["FIRST_CHARACTER", "SHAPES", "VxaFile"]

FIRST_CHARACTER = 48
"""Code point of ``0``; the character of a material in a layer is this plus its position in the palette."""

SHAPES = ("a box", "a cylinder", "a sphere", "a mesh")
"""Shapes by a region's ``PrimType``."""


@attrs.frozen(eq=False)
class VxaFile:
    """A body with its controller, and the options of ``vox`` for its simulation.

    Attributes:
        options: Name -> value, as arguments of ``VoxSettings``.
        material: Positions in the palette, ``uint8[X, Y, Z]``; 0 is empty.
        phase: Unconverted offsets, ``float64[X, Y, Z]``; the engine interprets them as cycles.
        steps: Number of steps, if the file sets it instead of a duration.
    """

    options: Mapping[str, Any]
    material: NDArray[np.uint8]
    phase: NDArray[np.float64]
    steps: int | None = None

    @property
    def canvas(self) -> tuple[int, int, int]:
        """Number of cells along x, y and z."""
        x, y, z = self.material.shape
        return x, y, z

    def settings(self) -> VoxSettings:
        """Return the settings for the body; settings that are not in the file have their defaults.

        Raises:
            InputError: A value is out of range, or the solver rejects the combination.
        """
        try:
            settings = VoxSettings(**self.options)
            if self.steps is not None:
                duration = (self.steps - 0.5) * time_step_of(settings, self.material)
                settings = attrs.evolve(settings, duration=duration)
            possible_clocks(settings)
        except ValueError as error:
            raise InputError(strip_body_index(error)) from error
        return settings
