"""Drawable values that components provide: bodies as moving meshes, and networks as graphs.

The core draws these values; only a simulator knows the shape of its designs.
"""

from __future__ import annotations

from collections.abc import Mapping

import attrs
import numpy as np
from numpy.typing import NDArray

__all__ = ["Geometry", "GeometryPart", "NetworkGraph", "NetworkLink"]


@attrs.frozen(eq=False)
class GeometryPart:
    """A part of a body in one color.

    Attributes:
        name: Name in the legend, such as ``contractile``.
        colour: Color as ``#rrggbb``.
        opacity: From 0 to 1; a part that encloses others should be translucent.
        vertices: ``float64[frames, n, 3]``, m.
        faces: ``int64[m, 4]``, corners of quadrilaterals as indices of vertices, counter-clockwise seen from
            outside.
    """

    name: str
    colour: str
    opacity: float
    vertices: NDArray[np.float64]
    faces: NDArray[np.int64]


@attrs.frozen(eq=False)
class Geometry:
    """The shape of a design at several times.

    Attributes:
        times: ``float64[frames]``, s, ascending; the first is 0, before the first step.
        parts: Parts of the body, each with the same number of frames.
        tracks: Points that the simulator tracks, name -> ``float64[frames, 3]``, m.
    """

    times: NDArray[np.float64]
    parts: tuple[GeometryPart, ...]
    tracks: Mapping[str, NDArray[np.float64]]


@attrs.frozen
class NetworkLink:
    """A connection of a network.

    Attributes:
        start: Source node.
        end: Target node.
        weight: Factor of the value of the source node.
    """

    start: int
    end: int
    weight: float


@attrs.frozen
class NetworkGraph:
    """A network as a genome encodes it.

    Attributes:
        inputs: Ids of the input nodes, in order.
        outputs: Ids of the output nodes, in order.
        labels: Label of each node except the inputs, such as the name of its activation function.
        links: The enabled connections.
    """

    inputs: tuple[int, ...]
    outputs: tuple[int, ...]
    labels: Mapping[int, str]
    links: tuple[NetworkLink, ...]
