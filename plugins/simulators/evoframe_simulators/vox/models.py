"""Solver models for settings, and the clocks (time step and number of steps) of bodies."""

from __future__ import annotations

import functools
import itertools
import math

import attrs
import numpy as np
from numpy.typing import NDArray

import evoframe_libvox as libvox
from evoframe_simulators.vox.materials import solver_palette
from evoframe_simulators.vox.regions import fixed_mask
from evoframe_simulators.vox.sampling import Clock
from evoframe_simulators.vox.settings import VoxSettings, amplitude_of, materials_of, period_of

__all__ = [
    "acting_codes",
    "clock_of",
    "clocks_of",
    "model_of",
    "possible_clocks",
    "strip_body_index",
    "time_step_of",
]

_UNLIMITED = 2**63 - 1
_INSTANT = math.ulp(0.0)  # s; shorter than any time step

Canvas = tuple[int, int, int]


@functools.lru_cache(maxsize=16)
def model_of(settings: VoxSettings, canvas: Canvas) -> libvox.Model:
    """Return the model of settings on a canvas; it is read-only, so threads can share it.

    Raises:
        ValueError: The solver rejects the settings.
    """
    return libvox.Model(
        canvas,
        solver_palette(materials_of(settings)),
        _solver_settings(settings),
        fixed_mask(settings.fixed, canvas),
        whole_body=settings.whole_body,
    )


@functools.lru_cache(maxsize=16)
def acting_codes(settings: VoxSettings) -> NDArray[np.bool_]:
    """Return a mask of the codes whose voxels respond to phase offsets, ``bool[256]``, read-only."""
    acting = np.zeros(256, np.bool_)
    if amplitude_of(settings) != 0.0:
        for code, material in materials_of(settings).items():
            acting[code] = material.expansion_coefficient != 0.0
    acting.setflags(write=False)
    return acting


def clock_of(settings: VoxSettings, material: NDArray[np.uint8]) -> Clock:
    """Return the clock of a body, ``uint8[X, Y, Z]``.

    Raises:
        ValueError: The body cannot be simulated.
    """
    x, y, z = material.shape
    return _clock(settings, (x, y, z), material.tobytes())


@functools.lru_cache(maxsize=8)  # for bodies that are being paired with many controllers
def _clock(settings: VoxSettings, canvas: Canvas, cells: bytes) -> Clock:
    material = np.frombuffer(cells, np.uint8).reshape(1, *canvas)
    [clock] = clocks_of(settings, model_of(settings, canvas), material)
    return clock


def clocks_of(settings: VoxSettings, model: libvox.Model, material: NDArray[np.uint8]) -> list[Clock]:
    """Return the clock of each body, ``uint8[N, X, Y, Z]``.

    Raises:
        ValueError: A body cannot be simulated; the message contains its index.
    """
    time_steps, steps = model.time_steps(material)
    return [
        Clock(time_step, total, settings.substeps)
        for time_step, total in zip(time_steps.tolist(), steps.tolist(), strict=True)
    ]


def time_step_of(settings: VoxSettings, material: NDArray[np.uint8]) -> float:
    """Return the time step of a body, ``uint8[X, Y, Z]``, in s; it does not depend on the duration.

    Raises:
        ValueError: The solver rejects the settings or the body.
    """
    return clock_of(attrs.evolve(settings, duration=_INSTANT), material).time_step


def possible_clocks(settings: VoxSettings) -> list[Clock]:
    """Return every clock that a body can have: one for each pair of materials, and one without bonds.

    Raises:
        ValueError: The solver rejects the settings, or every body with a bond exceeds the limit of steps.
    """
    palette = solver_palette(materials_of(settings))
    distinct = sorted({material: code for code, material in palette.items()}.values())
    bars = list(itertools.combinations_with_replacement(distinct, 2))
    bodies = np.array([*bars, *((0, code) for code in distinct)], np.uint8).reshape(-1, 2, 1, 1)
    unlimited = attrs.evolve(_solver_settings(settings), step_limit=_UNLIMITED)
    free = libvox.Model((2, 1, 1), palette, unlimited, np.zeros((2, 1, 1), np.uint8))
    try:
        clocks = clocks_of(settings, free, bodies)
    except ValueError as error:
        raise ValueError(strip_body_index(error)) from error
    fewest = min(clock.steps for clock in clocks[: len(bars)])
    if fewest > settings.step_limit:
        raise ValueError(
            f"duration = {settings.duration} s requires {fewest} steps, "
            f"but step_limit = {settings.step_limit}; reduce duration or increase step_limit"
        )
    return clocks


def strip_body_index(error: Exception) -> str:
    """Return the solver's message without the index of the body, which is valid only within its batch."""
    return str(error).partition(" (body ")[0]


def _solver_settings(settings: VoxSettings) -> libvox.Settings:
    return libvox.Settings(
        voxel_size=settings.voxel_size,
        duration=settings.duration,
        time_step_fraction=settings.time_step_fraction,
        substeps=settings.substeps,
        step_limit=settings.step_limit,
        temperature_amplitude=amplitude_of(settings),
        period=period_of(settings),
        start_time=settings.start_time,
        ramp=settings.ramp,
        smallest_size=settings.smallest_size,
        largest_size=settings.largest_size,
        size_clamp=settings.size_rule == "clamp",
        gravity=settings.gravity,
        floor=settings.floor,
        floor_slope=settings.floor_slope,
        falling_code=settings.falling_code,
        fluid_drag=settings.fluid_drag,
        fluid_by_size=settings.fluid_surface == "voxel-size",
        bond_damping=settings.bond_damping,
        slow_damping=settings.slow_damping,
        floor_damping=settings.collision_damping,
        contact_damping=settings.contact_damping,
        self_collision=settings.self_collision,
        contact_friction=settings.contact_friction,
        complete_contacts=settings.complete_contacts,
        collision_envelope=settings.collision_envelope,
        collision_horizon=settings.collision_horizon,
        largest_strain=settings.largest_strain,
        largest_distance=settings.largest_distance,
    )
