"""From a network to phase offsets: the encoder ``cppn-controller``."""

from __future__ import annotations

import math

import attrs
import numpy as np

from evoframe import CONTRACTILE, CONTROLLER, MORPHOLOGY, Design, Network
from evoframe_encoders.canvas import voxel_points

__all__ = ["CppnController"]

_LARGEST_OFFSET = 2.0 * math.pi


@attrs.frozen
class CppnController:
    """Phase offsets drawn by a network that is asked at each contractile voxel of a body.

    The network sees the coordinates and the material code of a voxel; its output is clamped to +-2 pi. Empty
    and passive voxels do not contract, so the network is not asked there and their offset is 0. That changes
    no simulation, but the code that the network sees is always 3.

    Attributes:
        normalized_coordinates: Whether each axis of the canvas runs from -1 to 1; the paper's networks see
            the indices of voxels.
    """

    normalized_coordinates: bool = False

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
        """The morphology: a controller is decoded against a body."""
        return (MORPHOLOGY,)

    @property
    def provides(self) -> tuple[str, ...]:
        """The controller, ``float64[X, Y, Z]``: phase offsets within +-2 pi."""
        return (CONTROLLER,)

    def decode(self, network: Network, design: Design) -> Design:
        """Return *design* with the phase offsets that *network* draws on its body."""
        body = design.roles[MORPHOLOGY]
        contracts = body == CONTRACTILE
        points = np.full((np.count_nonzero(contracts), 4), float(CONTRACTILE))
        points[:, :3] = voxel_points(body.shape, self.normalized_coordinates)[contracts]
        offsets = np.zeros(body.shape)
        offsets[contracts] = np.clip(network(points)[:, 0], -_LARGEST_OFFSET, _LARGEST_OFFSET)
        offsets.setflags(write=False)
        return design.with_role(CONTROLLER, offsets)
