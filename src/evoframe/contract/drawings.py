"""What components give to be drawn: a body as meshes that move, a network as a graph.

The core draws what it is given; only a simulator knows what its designs look like.
"""

from __future__ import annotations

from collections.abc import Mapping

import attrs
import numpy as np
from numpy.typing import NDArray

__all__ = ["Geometry", "GeometryPart", "NetworkGraph", "NetworkLink"]


@attrs.frozen(eq=False)
class GeometryPart:
    """Something of one colour.

    Attributes:
        name: What a legend calls it, such as ``contractile``.
        colour: ``#rrggbb``.
        opacity: From 0 to 1; what surrounds other parts is best translucent.
        vertices: ``float64[frames, n, 3]``, m.
        faces: ``int64[m, 4]``, the corners of quadrilaterals as indices of vertices, counter-clockwise as
            seen from outside.
    """

    name: str
    colour: str
    opacity: float
    vertices: NDArray[np.float64]
    faces: NDArray[np.int64]


@attrs.frozen(eq=False)
class Geometry:
    """A design as it looks at several times.

    Attributes:
        times: ``float64[frames]``, s, ascending; the first is 0, before the first step.
        parts: What it consists of; all have as many frames.
        tracks: The points that the simulator follows, name -> ``float64[frames, 3]``, m.
    """

    times: NDArray[np.float64]
    parts: tuple[GeometryPart, ...]
    tracks: Mapping[str, NDArray[np.float64]]


@attrs.frozen
class NetworkLink:
    """A connection of a network.

    Attributes:
        start: The node that it comes from.
        end: The node that it goes to.
        weight: What it multiplies with.
    """

    start: int
    end: int
    weight: float


@attrs.frozen
class NetworkGraph:
    """A network as a genome encodes it.

    Attributes:
        inputs: The ids of input nodes, in order.
        outputs: The ids of output nodes, in order.
        labels: What stands at a node, such as the name of its activation: one for each node but the inputs.
        links: The connections that are enabled.
    """

    inputs: tuple[int, ...]
    outputs: tuple[int, ...]
    labels: Mapping[int, str]
    links: tuple[NetworkLink, ...]
