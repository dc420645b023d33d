"""Encoders that decode networks into voxel bodies, and into phase offsets of their contractile voxels."""

from __future__ import annotations

from collections.abc import Mapping

from evoframe import Encoder, hookimpl
from evoframe_encoders.controller import CppnController
from evoframe_encoders.morphology import CppnMorphology
from evoframe_encoders.voxels import CppnVoxels

__all__ = ["CppnController", "CppnMorphology", "CppnVoxels", "evoframe_encoders"]


@hookimpl
def evoframe_encoders() -> Mapping[str, type[Encoder]]:
    """Register the encoders of this package."""
    return {
        "cppn-controller": CppnController,
        "cppn-morphology": CppnMorphology,
        "cppn-voxels": CppnVoxels,
    }
