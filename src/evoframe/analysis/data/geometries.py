"""Whether what a simulator gives to be drawn can be drawn."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.colors import is_color_like

from evoframe.contract import Geometry, GeometryPart

__all__ = ["checked"]

_LARGEST = 1e30  # m; more, or its square, has no place in 32 bits


def checked(given: Any) -> Geometry:
    """Return what a simulator's ``geometry`` gave if it can be drawn.

    Raises:
        TypeError: It is something else than a geometry.
        ValueError: There is nothing to see, or an array has another shape than it should, or a number that is
            no place or no time; says which.
    """
    if not isinstance(given, Geometry):
        raise TypeError(f"geometry() gave {type(given).__name__}, expected a Geometry")
    if not any(len(part.faces) for part in given.parts):
        raise ValueError("geometry() gave nothing that can be seen")
    frames = len(given.times)
    _check_numbers("times", given.times, (frames,))
    for part in given.parts:
        _check_part(part, frames)
    for name, positions in given.tracks.items():
        _check_numbers(f"the track '{name}'", positions, (frames, 3))
    return given


def _check_part(part: GeometryPart, frames: int) -> None:
    count = part.vertices.shape[1] if np.ndim(part.vertices) == 3 else 0
    _check_numbers(f"vertices of '{part.name}'", part.vertices, (frames, count, 3))
    if not is_color_like(part.colour) or not 0.0 <= part.opacity <= 1.0:
        raise ValueError(f"geometry() gave '{part.name}' the colour {part.colour!r}, opacity {part.opacity}")
    faces = np.asarray(part.faces)
    if faces.shape != (len(faces), 4) or not np.issubdtype(faces.dtype, np.integer):
        raise ValueError(f"geometry() gave faces of '{part.name}' that are no integers of shape (m, 4)")
    if len(faces) and not 0 <= faces.min() <= faces.max() < count:
        raise ValueError(
            f"geometry() gave faces of '{part.name}' with other corners than its {count} vertices"
        )


def _check_numbers(what: str, given: Any, shape: tuple[int, ...]) -> None:
    numbers = np.asarray(given, dtype=np.float64)
    if numbers.shape != shape or not shape[0]:
        raise ValueError(f"geometry() gave {what} of shape {numbers.shape}, expected {shape}")
    if not (np.abs(numbers) <= _LARGEST).all():
        raise ValueError(f"geometry() gave {what} that are not finite, or larger than {_LARGEST:g}")
