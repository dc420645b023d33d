"""Figures of bodies for print."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.colors import to_rgb
from matplotlib.patches import Patch
from mpl_toolkits.mplot3d import proj3d
from mpl_toolkits.mplot3d.art3d import Poly3DCollection
from numpy.typing import NDArray

from evoframe.analysis.drawing import Figure
from evoframe.analysis.figures.plain import plain
from evoframe.analysis.figures.printed import COLUMN
from evoframe.contract import Geometry, GeometryPart

__all__ = ["body"]

_BESIDE, _ABOVE, _BELOW, _TALLEST = 0.12, 0.40, 0.30, 2.0  # inches: margins, and greatest height of the body
_ELEVATION, _AZIMUTH = 24.0, -62.0  # degrees; the free end, at the greatest x, faces the viewer
_LIGHT = np.array([0.30, -0.65, 0.70])  # from the front, above


@plain
def body(geometry: Geometry, title: str = "", frame: int = 0) -> Figure:
    """Draw a design at one time, with translucent parts around opaque ones.

    Args:
        geometry: The geometry of the design.
        title: Title of the figure.
        frame: Index of the time.
    """
    figure = Figure(figsize=(COLUMN, COLUMN))
    axes: Any = figure.add_axes((0.0, 0.0, 1.0, 1.0), projection="3d")
    corners = [part.vertices[frame][part.faces] for part in geometry.parts]
    colours = [_shaded(part, faces) for part, faces in zip(geometry.parts, corners, strict=True)]
    edges = [
        np.tile(
            [*(0.4 * np.array(to_rgb(part.colour))), 1.0 if part.opacity == 1.0 else 0.3 * part.opacity],
            (len(part.faces), 1),
        )
        for part in geometry.parts
    ]
    # A single collection, because matplotlib sorts faces by depth only within a collection.
    axes.add_collection3d(
        Poly3DCollection(
            np.concatenate(corners),
            facecolors=np.concatenate(colours),
            edgecolors=np.concatenate(edges),
            linewidths=0.25,
            clip_on=False,
        )
    )
    all_corners = np.concatenate([faces.reshape(-1, 3) for faces in corners])
    extent = _arrange(axes, all_corners.min(axis=0), all_corners.max(axis=0))
    tips = _draw_directions(axes, all_corners.min(axis=0), 0.12 * extent.max())
    _fit(figure, axes, np.concatenate([all_corners, tips]))
    figure.legend(
        handles=[
            Patch(facecolor=(*to_rgb(part.colour), max(part.opacity, 0.2)), label=part.name)
            for part in geometry.parts
        ],
        loc="lower center",
        ncols=len(geometry.parts),
        frameon=False,
        fontsize=7,
        handlelength=1.0,
    )
    _write(figure, 0.04, title, size=9)
    _write(figure, 0.22, "\u2009\u00d7\u2009".join(map(_millimeters, extent)) + " mm", size=7)
    return figure


def _millimeters(length: float) -> str:
    """Return a length in meters as millimeters with three significant digits, such as ``1000``."""
    return f"{float(f'{1000 * length:.3g}'):g}"


def _write(figure: Figure, below: float, text: str, size: int) -> None:
    """Write a line of text, *below* inches below the upper edge."""
    figure.text(0.5, 1.0 - below / figure.get_figheight(), text, size=size, ha="center", va="top")


def _shaded(part: GeometryPart, faces: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the color of each face, ``float64[m, 4]``, darker if it faces away from the light."""
    across = np.cross(faces[:, 2] - faces[:, 0], faces[:, 3] - faces[:, 1])
    lengths = np.linalg.norm(across, axis=1, keepdims=True)
    normals = np.divide(across, lengths, out=np.zeros_like(across), where=lengths > 0)
    light = 0.7 + 0.3 * np.clip(normals @ _LIGHT, 0.0, 1.0)
    colour = light[:, None] * np.array(to_rgb(part.colour))
    return np.column_stack([colour, np.full(len(faces), part.opacity)])


def _arrange(axes: Any, least: NDArray[np.float64], most: NDArray[np.float64]) -> NDArray[np.float64]:
    """Fit the axes, with equal scales, to the box between two corners, and return its extent."""
    extent = np.maximum(most - least, 1e-9)
    axes.set(xlim=(least[0], least[0] + extent[0]), ylim=(least[1], least[1] + extent[1]))
    axes.set_zlim(least[2], least[2] + extent[2])
    axes.set_box_aspect(extent.tolist())
    axes.view_init(_ELEVATION, _AZIMUTH)
    axes.set_proj_type("persp", focal_length=0.8)
    axes.set_axis_off()
    return extent


def _draw_directions(axes: Any, corner: NDArray[np.float64], length: float) -> NDArray[np.float64]:
    """Draw an arrow along each axis near a corner, and return the positions of their letters."""
    start = corner - length * np.array([0.9, 0.9, 0.3])
    tips = start + 1.35 * length * np.eye(3)
    for name, along, tip in zip("xyz", np.eye(3), tips, strict=True):
        axes.quiver(*start, *(length * along), color="black", lw=0.7, arrow_length_ratio=0.3, clip_on=False)
        axes.text(*tip, name, size=7, ha="center", va="center")
    return tips


def _fit(figure: Figure, axes: Any, points: NDArray[np.float64]) -> None:
    """Scale the axes so that *points* fill the width or the greatest height between the texts."""
    x, y, _ = proj3d.proj_transform(*points.T, axes.get_proj())
    shown = axes.transAxes.inverted().transform(axes.transData.transform(np.column_stack([x, y])))
    (left, low), (right, high) = shown.min(axis=0), shown.max(axis=0)
    side = min((COLUMN - 2 * _BESIDE) / (right - left), _TALLEST / (high - low))  # of the square of the axes
    height = _ABOVE + side * (high - low) + _BELOW
    figure.set_figheight(height)
    corner = 0.5 * (COLUMN - side * (left + right)) / COLUMN, (_BELOW - side * low) / height
    axes.set_position((*corner, side / COLUMN, side / height))
