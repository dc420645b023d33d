"""Choice of the objective for bodies of files that contain their own settings."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, Literal, TypeAlias

import numpy as np
from numpy.typing import NDArray

from evoframe_simulators.vox.models import possible_clocks
from evoframe_simulators.vox.regions import FixedRegion, fixed_mask
from evoframe_simulators.vox.settings import VoxSettings

__all__ = ["Motion", "motion_of", "objective_of"]

Motion: TypeAlias = Literal["face", "tip", "body"]
"""The point whose motion describes that of a body."""

_MOST_SAMPLES = 1_000_000
_X, _Y, _Z = (FixedRegion(degrees_of_freedom=(axis,)).bits for axis in ("x", "y", "z"))


def objective_of(settings: VoxSettings, bodies: Iterable[NDArray[np.uint8]]) -> dict[str, Any]:
    """Return the objective that fits bodies: the table ``objective`` of a configuration.

    The displacement of the free face, or else of the tip, is measured from the first to the last step. If a
    body is free, its center of mass is followed instead, from the start of the contraction on, which excludes
    the motion by which the body settles on the floor.

    Args:
        settings: Settings of the simulation.
        bodies: Materials of the bodies, each ``uint8[X, Y, Z]``; those without voxels do not matter.
    """
    every = _interval(settings)
    motions = {motion_of(settings, material) for material in bodies if material.any()}
    if motions in ({"face"}, {"tip"}):
        [point] = motions
        return {"name": f"{point}-yz", "every": every, "first": 0, "last": -1}
    after = settings.start_time if settings.start_time < settings.duration else 0.0
    return {"name": "travel", "along": "xy", "every": every, "after": after}


def _interval(settings: VoxSettings) -> float:
    """Return 0, or if a body can have very many steps, an interval with which its samples fit into memory."""
    steps = max(clock.steps for clock in possible_clocks(settings))
    return settings.duration / _MOST_SAMPLES if steps > _MOST_SAMPLES else 0.0


def motion_of(settings: VoxSettings, material: NDArray[np.uint8]) -> Motion:
    """Return the point that moves with a body's deformation: ``body`` if no other point does.

    A body is held if both horizontal directions are fixed, each for some voxel. ``body`` follows if it is not
    held, or if neither the free face nor the tip can move in the yz plane.

    Args:
        settings: Settings of the simulation.
        material: Materials of a body with voxels, ``uint8[X, Y, Z]``.
    """
    x, y, z = material.shape
    present = material > 0
    fixed = np.where(present, fixed_mask(settings.fixed, (x, y, z)), 0)
    if not (fixed & _X).any() or not (fixed & _Y).any():
        return "body"
    moves = present & (fixed & (_Y | _Z) != _Y | _Z)
    if moves[np.flatnonzero(present.any(axis=(1, 2)))[-1]].any():
        return "face"
    tip = tuple(np.argwhere(present.transpose(2, 1, 0))[-1][::-1])  # the last voxel if x varies fastest
    return "tip" if moves[tip] else "body"
