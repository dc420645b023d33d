"""Decoding of networks into phase offsets: the encoder ``cppn-controller``."""

from __future__ import annotations

import math
from collections.abc import Mapping
from functools import lru_cache
from typing import ClassVar

import attrs
import numpy as np
from numpy.typing import NDArray

from evoframe import CONTRACTILE, CONTROLLER, MORPHOLOGY, ArrayType, Design, Network
from evoframe_encoders.canvas import Canvas, voxel_points

__all__ = ["CppnController"]

_LARGEST_OFFSET = 2.0 * math.pi


@lru_cache(maxsize=8)
def _points(canvas: Canvas, normalized: bool) -> NDArray[np.float64]:
    """Return the network's inputs for each voxel as if it were contractile, ``float64[X * Y * Z, 4]``.

    It is read-only, so that the core evaluates a network only once for all bodies.
    """
    coordinates = voxel_points(canvas, normalized).reshape(-1, 3)
    points = np.insert(coordinates, 3, float(CONTRACTILE), axis=1)
    points.setflags(write=False)
    return points


@attrs.frozen
class CppnController:
    """Phase offsets from a network that is evaluated at the contractile voxels of a body.

    The network's inputs are the coordinates and the material code of a voxel, which is 3 for all contractile
    voxels; its output is clamped to +-2 pi. Empty and passive voxels have the offset 0, which does not affect
    simulations, since they do not contract.

    The network is evaluated at all voxels of the canvas, so that one evaluation is enough for all bodies with
    which it is paired.

    Attributes:
        normalized_coordinates: Whether the input coordinates run from -1 to 1 along each axis of the canvas;
            otherwise they are voxel indices (paper).
    """

    normalized_coordinates: bool = False

    input_names: ClassVar[tuple[str, ...]] = ("x", "y", "z", "material")
    output_names: ClassVar[tuple[str, ...]] = ("phase offset",)

    @property
    def inputs(self) -> int:
        """The coordinates x, y, z and the material code."""
        return 4

    @property
    def outputs(self) -> int:
        """The phase offset."""
        return 1

    @property
    def requires(self) -> tuple[str, ...]:
        """The morphology: the offsets depend on the body."""
        return (MORPHOLOGY,)

    @property
    def provides(self) -> tuple[str, ...]:
        """The controller, ``float64[X, Y, Z]``: phase offsets within +-2 pi."""
        return (CONTROLLER,)

    @property
    def array_types(self) -> Mapping[str, ArrayType]:
        """Both arrays have three axes of any lengths."""
        anywhere = (None, None, None)
        return {MORPHOLOGY: ArrayType("uint8", anywhere), CONTROLLER: ArrayType("float64", anywhere)}

    def decode(self, network: Network, design: Design) -> Design:
        """Return *design* with the phase offsets that *network* gives for its body."""
        body = design.roles[MORPHOLOGY]
        everywhere = network(_points(body.shape, self.normalized_coordinates)).reshape(body.shape)
        clamped = everywhere.clip(-_LARGEST_OFFSET, _LARGEST_OFFSET)
        offsets = np.where(body == CONTRACTILE, clamped, 0.0)
        offsets.setflags(write=False)
        return design.with_role(CONTROLLER, offsets)
