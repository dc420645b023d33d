"""Decoding of one network into a body and its phase offsets: the encoder ``cppn-voxels``."""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar

import attrs
import numpy as np
from numpy.typing import NDArray

from evoframe import CONTROLLER, MORPHOLOGY, ArrayType, Design, Network
from evoframe_encoders.controller import CppnController
from evoframe_encoders.morphology import CppnMorphology

__all__ = ["CppnVoxels"]


@attrs.frozen
class CppnVoxels:
    """A body and its phase offsets from one network: one population can evolve complete designs.

    The first two outputs are those of ``cppn-morphology``, and the third is that of ``cppn-controller``,
    which here does not depend on the material.

    Attributes:
        body: Options of ``cppn-morphology``.
    """

    body: CppnMorphology = attrs.field(factory=CppnMorphology)

    input_names: ClassVar[tuple[str, ...]] = ("x", "y", "z")
    output_names: ClassVar[tuple[str, ...]] = ("presence", "material", "phase offset")
    measures: ClassVar[tuple[str, ...]] = CppnMorphology.measures

    @property
    def inputs(self) -> int:
        """The coordinates x, y, z."""
        return 3

    @property
    def outputs(self) -> int:
        """Presence, material and phase offset."""
        return 3

    @property
    def requires(self) -> tuple[str, ...]:
        """Nothing: the design is complete."""
        return ()

    @property
    def provides(self) -> tuple[str, ...]:
        """The morphology and the controller."""
        return (MORPHOLOGY, CONTROLLER)

    @property
    def array_types(self) -> Mapping[str, ArrayType]:
        """Both arrays have the shape of the canvas."""
        return {
            MORPHOLOGY: ArrayType("uint8", self.body.canvas),
            CONTROLLER: ArrayType("float64", self.body.canvas),
        }

    def measure(self, design: Design) -> Mapping[str, float]:
        """Return the measures of ``cppn-morphology``."""
        return self.body.measure(design)

    def decode(self, network: Network, design: Design) -> Design:
        """Return *design* with the body and the offsets that *network* encodes."""
        drawn = self.body.decode(lambda points: network(points)[:, :2], design)
        offsets = CppnController(normalized_coordinates=self.body.normalized_coordinates)
        return offsets.decode(lambda points: _offsets(network, points), drawn)


def _offsets(network: Network, points: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the third output at points whose fourth coordinate, the material, is left out."""
    return network(np.ascontiguousarray(points[:, :3]))[:, 2:]
