"""Encoders: networks become voxel bodies, phase offsets of contractile voxels, or vectors of numbers."""

from __future__ import annotations

from collections.abc import Mapping

from evoframe import Encoder, hookimpl
from evoframe_encoders.controller import CppnController
from evoframe_encoders.morphology import CppnMorphology
from evoframe_encoders.vector import Vector
from evoframe_encoders.voxels import CppnVoxels

__all__ = ["CppnController", "CppnMorphology", "CppnVoxels", "Vector", "evoframe_encoders"]


@hookimpl
def evoframe_encoders() -> Mapping[str, type[Encoder]]:
    """Register the encoders of this package."""
    return {
        "cppn-controller": CppnController,
        "cppn-morphology": CppnMorphology,
        "cppn-voxels": CppnVoxels,
        "vector": Vector,
    }
