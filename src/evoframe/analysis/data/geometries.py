"""Validation of geometries returned by simulators."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.colors import is_color_like

from evoframe.contract import Geometry, GeometryPart

__all__ = ["validate_geometry"]

_LARGEST = 1e30  # m; squares of larger numbers do not fit into 32-bit floats


def validate_geometry(given: Any) -> Geometry:
    """Return the geometry that a simulator returned, after validating it.

    Raises:
        TypeError: *given* is not a geometry.
        ValueError: No part is visible, or an array has an unexpected shape, or values that are not finite or
            too large; the text names the array.
    """
    if not isinstance(given, Geometry):
        raise TypeError(f"geometry() returned {type(given).__name__}, expected a Geometry")
    if not any(len(part.faces) for part in given.parts):
        raise ValueError("geometry() returned no visible part, expected at least one face")
    frames = len(given.times)
    _check_numbers("times", given.times, (frames,))
    for part in given.parts:
        _check_part(part, frames)
    for name, positions in given.tracks.items():
        _check_numbers(f"track '{name}'", positions, (frames, 3))
    return given


def _check_part(part: GeometryPart, frames: int) -> None:
    count = part.vertices.shape[1] if np.ndim(part.vertices) == 3 else 0
    _check_numbers(f"vertices of '{part.name}'", part.vertices, (frames, count, 3))
    if not is_color_like(part.colour) or not 0.0 <= part.opacity <= 1.0:
        raise ValueError(
            f"geometry() returned '{part.name}' with colour {part.colour!r} and opacity {part.opacity}, "
            "expected a color of matplotlib and a number from 0 to 1"
        )
    faces = np.asarray(part.faces)
    if faces.shape != (len(faces), 4) or not np.issubdtype(faces.dtype, np.integer):
        raise ValueError(
            f"geometry() returned faces of '{part.name}' as {faces.dtype}{faces.shape}, "
            "expected integers (m, 4)"
        )
    if len(faces) and not 0 <= faces.min() <= faces.max() < count:
        raise ValueError(
            f"geometry() returned faces of '{part.name}' with vertices {faces.min()} to {faces.max()}, "
            f"expected 0 to {count - 1}"
        )


def _check_numbers(what: str, given: Any, shape: tuple[int, ...]) -> None:
    numbers = np.asarray(given, dtype=np.float64)
    if numbers.shape != shape or not shape[0]:
        raise ValueError(f"geometry() returned {what} of shape {numbers.shape}, expected {shape}")
    if not (np.abs(numbers) <= _LARGEST).all():
        raise ValueError(
            f"geometry() returned {what} with numbers that are not finite or exceed {_LARGEST:g}"
        )
