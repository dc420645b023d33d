"""Decoding of networks into bodies: the encoder ``cppn-morphology``."""

from __future__ import annotations

import math
from collections.abc import Mapping
from functools import lru_cache
from typing import Any, ClassVar

import attrs
import numpy as np
from attrs.validators import ge
from numpy.typing import NDArray

from evoframe import CONTRACTILE, EMPTY, MORPHOLOGY, PASSIVE, ArrayType, Design, Network
from evoframe_encoders.canvas import Canvas, voxel_points

__all__ = ["CppnMorphology"]

_MOST_VOXELS = 2**24


def _possible_canvas(_instance: Any, attribute: attrs.Attribute[Canvas], canvas: Canvas) -> None:
    lengths = canvas if isinstance(canvas, tuple) else ()
    if len(lengths) != 3 or not all(isinstance(n, int) and n >= 1 for n in lengths):
        raise ValueError(f"'{attribute.name}' must be three whole numbers of at least 1: {canvas}")
    if math.prod(canvas) > _MOST_VOXELS:
        raise ValueError(f"'{attribute.name}' must have at most {_MOST_VOXELS} voxels: {canvas}")


def _drawn(enclosure: bool) -> tuple[slice, slice, slice]:
    """Return the slices of a canvas that the network determines."""
    return (slice(1, -1),) * 3 if enclosure else (slice(None),) * 3


@lru_cache(maxsize=8)
def _points(canvas: Canvas, normalized: bool, enclosure: bool) -> NDArray[np.float64]:
    """Return the coordinates of the voxels that the network determines, ``float64[n, 3]``, read-only."""
    points = np.array(voxel_points(canvas, normalized)[_drawn(enclosure)].reshape(-1, 3))
    points.setflags(write=False)
    return points


@attrs.frozen
class CppnMorphology:
    """A body from a network that gives the presence and material of each voxel.

    A voxel is present if the absolute value of the first output reaches *threshold*; a present voxel is
    contractile if that of the second output reaches it too, and otherwise passive. With *enclosure*, the
    outermost layer of the canvas is always passive, so the free end exists and the body is never empty.
    Without *enclosure*, a body can be empty, and can consist of several parts unless *connected* is set.

    Attributes:
        canvas: Number of voxels along x, y and z.
        enclosure: Whether the outermost layer is passive, and the network determines the interior only
            (paper).
        threshold: Threshold for the absolute values of the outputs, dimensionless (paper).
        normalized_coordinates: Whether the input coordinates run from -1 to 1 along each axis of the canvas;
            otherwise they are voxel indices (paper).
        connected: Whether to keep only the largest part whose voxels are connected face to face; of equally
            large parts, the first one along x, then y, then z.
    """

    canvas: Canvas = attrs.field(default=(20, 8, 8), validator=_possible_canvas)
    enclosure: bool = True
    threshold: float = attrs.field(default=0.5, validator=ge(0.0))
    normalized_coordinates: bool = False
    connected: bool = False

    input_names: ClassVar[tuple[str, ...]] = ("x", "y", "z")
    output_names: ClassVar[tuple[str, ...]] = ("presence", "material")
    measures: ClassVar[tuple[str, ...]] = ("count-contractile", "filled-share")

    @property
    def inputs(self) -> int:
        """The coordinates x, y, z."""
        return 3

    @property
    def outputs(self) -> int:
        """Presence and material."""
        return 2

    @property
    def requires(self) -> tuple[str, ...]:
        """Nothing: the body is the first part of a design."""
        return ()

    @property
    def provides(self) -> tuple[str, ...]:
        """The morphology, ``uint8[X, Y, Z]``: 0 empty, 1 passive, 3 contractile."""
        return (MORPHOLOGY,)

    @property
    def array_types(self) -> Mapping[str, ArrayType]:
        """The morphology has the type uint8 and the shape of the canvas."""
        return {MORPHOLOGY: ArrayType("uint8", self.canvas)}

    def measure(self, design: Design) -> Mapping[str, float]:
        """Return the number of contractile voxels, and the share of voxels that are not empty.

        The share refers to the voxels that the network determines: with *enclosure*, those of the interior.
        """
        drawn = design.roles[MORPHOLOGY][_drawn(self.enclosure)]
        filled = float(np.mean(drawn != EMPTY)) if drawn.size else 0.0
        return {"count-contractile": float(np.sum(drawn == CONTRACTILE)), "filled-share": filled}

    def decode(self, network: Network, design: Design) -> Design:
        """Return *design* with the morphology that *network* encodes."""
        body = np.full(self.canvas, PASSIVE, dtype=np.uint8)
        drawn = body[_drawn(self.enclosure)]
        points = _points(self.canvas, self.normalized_coordinates, self.enclosure)
        present, contractile = (np.abs(network(points)) >= self.threshold).T
        materials = np.where(present, np.where(contractile, CONTRACTILE, PASSIVE), EMPTY)
        drawn[:] = materials.reshape(drawn.shape)
        if self.connected:
            body = _largest_part(body)
        body.setflags(write=False)
        return design.with_role(MORPHOLOGY, body)


def _largest_part(body: NDArray[np.uint8]) -> NDArray[np.uint8]:
    from scipy import ndimage  # noqa: PLC0415 - slow to import, and needed here only

    parts, n_parts = ndimage.label(body != EMPTY)  # connects voxels face to face by default
    if n_parts < 2:
        return body
    largest = 1 + int(np.argmax(np.bincount(parts.ravel())[1:]))
    return np.where(parts == largest, body, EMPTY).astype(np.uint8)
