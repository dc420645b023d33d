"""Bodies as figures, fit for an article."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from matplotlib.patches import Patch
from mpl_toolkits.mplot3d.art3d import Poly3DCollection
from numpy.typing import NDArray

from evoframe.analysis.plain import plain
from evoframe.drawings import Geometry, GeometryPart

__all__ = ["body"]

_WIDTH = 3.5  # inches: a column of an article
_ELEVATION, _AZIMUTH = 24.0, -62.0  # degrees; the free end, at the greatest x, is in front
_LIGHT = np.array([0.30, -0.65, 0.70])  # from the front, above


@plain
def body(geometry: Geometry, title: str = "", frame: int = 0) -> Figure:
    """Return a design as it looks at one time, with what surrounds other parts translucent.

    Args:
        geometry: What is drawn.
        title: What stands above it.
        frame: Which of its times.
    """
    figure = Figure(figsize=(_WIDTH, 2.0))
    axes: Any = figure.add_axes((0.0, 0.1, 1.0, 0.84), projection="3d")
    corners = [part.vertices[frame][part.faces] for part in geometry.parts]
    colours = [_shaded(part, faces) for part, faces in zip(geometry.parts, corners, strict=True)]
    # One collection: faces of several are not drawn from back to front.
    axes.add_collection3d(
        Poly3DCollection(
            np.concatenate(corners),
            facecolors=np.concatenate(colours),
            edgecolors=np.concatenate([_edges(part) for part in geometry.parts]),
            linewidths=0.25,
            clip_on=False,
        )
    )
    all_corners = np.concatenate([faces.reshape(-1, 3) for faces in corners])
    extent = _arrange(axes, all_corners.min(axis=0), all_corners.max(axis=0))
    _legend(figure, geometry.parts)
    figure.text(0.5, 0.98, title, size=9, ha="center", va="top")
    figure.text(0.98, 0.86, "\u2009\u00d7\u2009".join(f"{x:.3g}" for x in extent) + " m", size=7, ha="right")
    return figure


def _shaded(part: GeometryPart, faces: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the colour of each face, ``float64[m, 4]``, darker where it looks away from the light."""
    across = np.cross(faces[:, 2] - faces[:, 0], faces[:, 3] - faces[:, 1])
    lengths = np.linalg.norm(across, axis=1, keepdims=True)
    normals = np.divide(across, lengths, out=np.zeros_like(across), where=lengths > 0)
    light = 0.7 + 0.3 * np.clip(normals @ _LIGHT, 0.0, 1.0)
    colour = light[:, None] * np.array(to_rgb(part.colour))
    return np.column_stack([colour, np.full(len(faces), part.opacity)])


def _edges(part: GeometryPart) -> NDArray[np.float64]:
    shade = 0.4 * np.array(to_rgb(part.colour))
    return np.tile([*shade, 1.0 if part.opacity == 1.0 else 0.3 * part.opacity], (len(part.faces), 1))


def _arrange(axes: Any, least: NDArray[np.float64], most: NDArray[np.float64]) -> NDArray[np.float64]:
    """Show what is between two corners, with equal axes, and return its extent."""
    extent = np.maximum(most - least, 1e-9)
    axes.set(xlim=(least[0], least[0] + extent[0]), ylim=(least[1], least[1] + extent[1]))
    axes.set_zlim(least[2], least[2] + extent[2])
    axes.set_box_aspect(extent.tolist(), zoom=1.4)
    axes.view_init(_ELEVATION, _AZIMUTH)
    axes.set_proj_type("persp", focal_length=0.8)
    axes.set_axis_off()
    length = 0.12 * extent.max()
    start = least - length * np.array([0.9, 0.9, 0.3])
    for name, along in zip("xyz", np.eye(3), strict=True):
        axes.quiver(*start, *(length * along), color="black", lw=0.7, arrow_length_ratio=0.3, clip_on=False)
        axes.text(*(start + 1.35 * length * along), name, size=7, ha="center", va="center")
    return extent


def _legend(figure: Figure, parts: Sequence[GeometryPart]) -> None:
    figure.legend(
        handles=[
            Patch(facecolor=(*to_rgb(part.colour), max(part.opacity, 0.2)), label=part.name) for part in parts
        ],
        loc="lower center",
        ncols=len(parts),
        frameon=False,
        fontsize=7,
        handlelength=1.0,
    )
