"""The solver's models of a simulator's settings."""

from __future__ import annotations

import functools
import itertools
from typing import TYPE_CHECKING

import attrs
import numpy as np
from numpy.typing import NDArray

import evoframe_libvox as libvox
from evoframe_simulators.vox.materials import materials_of, single, solver_palette
from evoframe_simulators.vox.regions import fixed_mask
from evoframe_simulators.vox.sampling import Clock

if TYPE_CHECKING:
    from evoframe_simulators.vox.simulator import Vox

__all__ = [
    "acting_codes",
    "amplitude_of",
    "clock_of",
    "clocks_of",
    "model_of",
    "possible_clocks",
    "without_number",
]

_UNLIMITED = 2**63 - 1


@functools.lru_cache(maxsize=16)
def model_of(vox: Vox, canvas: tuple[int, int, int]) -> libvox.Model:
    """Return the model of settings on a canvas; it is read-only, so threads share it.

    Raises:
        ValueError: The solver cannot work with the settings; says what is wrong.
    """
    return libvox.Model(
        canvas, solver_palette(materials_of(vox)), _settings(vox), fixed_mask(vox.fixed, canvas)
    )


@functools.lru_cache(maxsize=16)
def acting_codes(vox: Vox) -> NDArray[np.bool_]:
    """Return of each code whether the offsets change the size of its voxels, ``bool[256]``, read-only."""
    acting = np.zeros(256, np.bool_)
    if amplitude_of(vox) != 0.0:
        for code, material in materials_of(vox).items():
            acting[code] = material.expansion_coefficient != 0.0
    acting.setflags(write=False)
    return acting


@functools.lru_cache(maxsize=8)  # the bodies that meet many controllers just now
def clock_of(vox: Vox, canvas: tuple[int, int, int], cells: bytes) -> Clock:
    """Return the clock of a body that is given by the bytes of its material codes.

    Raises:
        ValueError: It cannot be simulated; says why.
    """
    [clock] = clocks_of(vox, model_of(vox, canvas), np.frombuffer(cells, np.uint8).reshape(1, *canvas))
    return clock


def clocks_of(vox: Vox, model: libvox.Model, material: NDArray[np.uint8]) -> list[Clock]:
    """Return the clock of each body, ``uint8[N, X, Y, Z]``.

    Raises:
        ValueError: A body cannot be simulated; says why and which.
    """
    time_steps, steps = model.time_steps(material)
    return [Clock(*clock, vox.substeps) for clock in zip(time_steps.tolist(), steps.tolist(), strict=True)]


def possible_clocks(vox: Vox) -> list[Clock]:
    """Return every clock that a body can have: that of one pair of materials, or of one that has no bond.

    Raises:
        ValueError: The solver cannot work with the settings, or no body with a bond is done within the limit
            of steps; says what is wrong.
    """
    palette = solver_palette(materials_of(vox))
    distinct = sorted({material: code for code, material in palette.items()}.values())
    bars = list(itertools.combinations_with_replacement(distinct, 2))
    bodies = np.array([*bars, *((0, code) for code in distinct)], np.uint8).reshape(-1, 2, 1, 1)
    unlimited = attrs.evolve(_settings(vox), step_limit=_UNLIMITED)
    free = libvox.Model((2, 1, 1), palette, unlimited, np.zeros((2, 1, 1), np.uint8))
    try:
        clocks = clocks_of(vox, free, bodies)
    except ValueError as error:
        raise ValueError(without_number(error)) from error
    fewest = min(clock.steps for clock in clocks[: len(bars)])
    if fewest > vox.step_limit:
        raise ValueError(
            f"duration = {vox.duration} s takes {fewest} steps, more than step_limit = {vox.step_limit}; "
            "simulate less time, or raise the limit"
        )
    return clocks


def without_number(error: Exception) -> str:
    """Return the solver's words without the number of the body, which nobody knows outside of its batch."""
    return str(error).partition(" (body ")[0]


def amplitude_of(vox: Vox) -> float:
    """Return the amplitude of the temperature's swing, degrees.

    The engine holds it in single precision (physics.md, section 1): without, 4e-11 m are lost.
    """
    return single(vox.temperature_amplitude - vox.temperature_base)


def _settings(vox: Vox) -> libvox.Settings:
    return libvox.Settings(
        voxel_size=vox.voxel_size,
        duration=vox.duration,
        time_step_fraction=vox.time_step_fraction,
        substeps=vox.substeps,
        step_limit=vox.step_limit,
        temperature_amplitude=amplitude_of(vox),
        period=single(1 / vox.frequency),
        start_time=vox.start_time,
        ramp=vox.ramp,
        gravity=vox.gravity,
        floor=vox.floor,
        floor_slope=vox.floor_slope,
        fluid_drag=vox.fluid_drag,
        bond_damping=vox.bond_damping,
        slow_damping=vox.slow_damping,
        floor_damping=vox.collision_damping,
        contact_damping=vox.contact_damping,
        self_collision=vox.self_collision,
        contact_friction=vox.contact_friction,
        complete_contacts=vox.complete_contacts,
        collision_envelope=vox.collision_envelope,
        collision_horizon=vox.collision_horizon,
        largest_strain=vox.largest_strain,
        largest_distance=vox.largest_distance,
    )
