"""Settings of ``vox``: one value that decides how bodies are simulated, and what follows from it alone."""

from __future__ import annotations

import math
from typing import Any, Literal

import attrs
from attrs import validators
from numpy.typing import NDArray

from evoframe import CONTRACTILE, CONTROLLER, PASSIVE, Design
from evoframe_simulators.vox.limits import MOST_STEPS, VALID_PROPERTY, VALID_SETTING
from evoframe_simulators.vox.materials import PaletteMaterial, check_palette, single
from evoframe_simulators.vox.regions import FixedRegion

__all__ = ["VoxSettings", "amplitude_of", "materials_of", "period_of", "phase_cycles"]

# Options that describe the two built-in materials, and so say nothing of a palette.
_BUILT_IN = (
    *("youngs_modulus", "poisson_ratio", "density", "expansion_coefficient"),
    *("static_friction", "dynamic_friction"),
)


@attrs.frozen(cache_hash=True)  # models and clocks are looked up by it
class VoxSettings:
    """Settings of a simulation; the defaults are the paper's (paper.md, "The simulation of one pair").

    Each value is in its own range. Whether the solver can work with all of them together is checked by
    :func:`evoframe_simulators.vox.models.possible_clocks`.

    Attributes:
        duration: Simulated time, s.
        voxel_size: Edge of a voxel, m.
        youngs_modulus: Of both materials, Pa.
        poisson_ratio: Of both materials.
        density: Of both materials, kg/m3.
        expansion_coefficient: Linear thermal expansion of a contractile voxel, 1/degree; 0 switches it off.
        static_friction: Of both materials on the floor: share of its push up to which a resting voxel sticks.
        dynamic_friction: Of both materials: share of a push that brakes a sliding voxel.
        palette: If it has entries, they replace the materials 1 (passive) and 3 (contractile), and the six
            values above have no effect: tables with ``code``, these values, and perhaps ``name``.
        temperature_base: Degrees at which a voxel has its nominal size.
        temperature_amplitude: Highest temperature of the oscillation, degrees (the paper's engine counts from
            zero, so the swing is this less the base: 14.47 degrees, a linear strain of 0.1447).
        frequency: Of the contraction, Hz.
        phase_unit: How the controller's offsets are read. ``cycles`` is what the paper's engine does,
            ``radians`` what the paper says.
        start_time: When the contraction begins, s; its clock runs from 0 all the same.
        ramp: Seconds from then until it has its full amplitude.
        gravity: Acceleration along z, m/s2; negative is down.
        floor: Whether there is one, at z = 0.
        floor_slope: Degrees; the floor is z = x tan(slope), but pushes vertically all the same.
        fluid_drag: Half the density of the fluid around times its drag coefficient, kg/m3.
        fixed: Boxes whose voxels are held: tables with ``origin`` and ``size``, fractions of the canvas, and
            ``degrees_of_freedom``, a list out of x, y, z, rx, ry, rz. With none the body is free.
        self_collision: Whether voxels that are no neighbours repel each other.
        collision_envelope: How close they must come, in mean sizes: 1.5 in the paper's engine, 1 is touching.
        collision_horizon: How far candidates for contact are looked for, in voxel edges.
        complete_contacts: Whether no contact is missed; the paper's engine may find some late.
        contact_damping: Damping ratio of the push between voxels; the paper's engine has none.
        contact_friction: Whether voxels that touch brake each other; not in the paper's engine.
        time_step_fraction: Of the largest stable time step.
        substeps: Steps that each such step is made in; samples are taken at the same instants however many.
        step_limit: A body that needs more steps is refused. One without bonds needs several times as many.
        bond_damping: Damping ratio of the bonds.
        slow_damping: Damping ratio against the ground.
        collision_damping: Damping ratio of the floor's push.
        largest_strain: A bond that is strained more makes the body count as diverged.
        largest_distance: So does a voxel that is further from its start, in longest edges of the canvas.
    """

    duration: float = attrs.field(default=0.07, validator=VALID_SETTING["duration"])
    voxel_size: float = attrs.field(default=0.05, validator=VALID_SETTING["voxel_size"])
    youngs_modulus: float = attrs.field(default=5e6, validator=VALID_PROPERTY["youngs_modulus"])
    poisson_ratio: float = attrs.field(default=0.35, validator=VALID_PROPERTY["poisson_ratio"])
    density: float = attrs.field(default=1e6, validator=VALID_PROPERTY["density"])
    expansion_coefficient: float = attrs.field(default=0.01, validator=VALID_PROPERTY["expansion"])
    static_friction: float = attrs.field(default=1.0, validator=VALID_PROPERTY["static_friction"])
    dynamic_friction: float = attrs.field(default=0.5, validator=VALID_PROPERTY["dynamic_friction"])
    palette: tuple[PaletteMaterial, ...] = attrs.field(default=(), validator=check_palette)
    temperature_base: float = 25.0
    temperature_amplitude: float = 39.4714242553
    frequency: float = attrs.field(default=4.0, validator=validators.gt(0.0))
    phase_unit: Literal["cycles", "radians"] = "cycles"
    start_time: float = attrs.field(default=0.0, validator=VALID_SETTING["start_time"])
    ramp: float = attrs.field(default=0.0, validator=VALID_SETTING["ramp"])
    gravity: float = attrs.field(default=0.0, validator=VALID_SETTING["gravity"])
    floor: bool = False
    floor_slope: float = attrs.field(default=0.0, validator=VALID_SETTING["floor_slope"])
    fluid_drag: float = attrs.field(default=0.0, validator=VALID_SETTING["fluid_drag"])
    fixed: tuple[FixedRegion, ...] = (FixedRegion(),)
    self_collision: bool = True
    collision_envelope: float = attrs.field(default=1.5, validator=VALID_SETTING["collision_envelope"])
    collision_horizon: float = attrs.field(default=2.0, validator=VALID_SETTING["collision_horizon"])
    complete_contacts: bool = False
    contact_damping: float = attrs.field(default=0.0, validator=VALID_SETTING["contact_damping"])
    contact_friction: bool = False
    time_step_fraction: float = attrs.field(default=0.9, validator=VALID_SETTING["time_step_fraction"])
    substeps: int = attrs.field(default=1, validator=VALID_SETTING["substeps"])
    step_limit: int = attrs.field(
        default=10_000_000, validator=[VALID_SETTING["step_limit"], validators.le(MOST_STEPS)]
    )
    bond_damping: float = attrs.field(default=1.0, validator=VALID_SETTING["bond_damping"])
    slow_damping: float = attrs.field(default=0.01, validator=VALID_SETTING["slow_damping"])
    collision_damping: float = attrs.field(default=0.8, validator=VALID_SETTING["floor_damping"])
    largest_strain: float = attrs.field(default=100.0, validator=VALID_SETTING["largest_strain"])
    largest_distance: float = attrs.field(default=100.0, validator=VALID_SETTING["largest_distance"])


def materials_of(settings: VoxSettings) -> dict[int, PaletteMaterial]:
    """Return the material of each code that a body may have."""
    if settings.palette:
        return {material.code: material for material in settings.palette}
    options = {name: getattr(settings, name) for name in _BUILT_IN}
    passive = {**options, "expansion_coefficient": 0.0}
    return {
        PASSIVE: PaletteMaterial(code=PASSIVE, name="passive", **passive),
        CONTRACTILE: PaletteMaterial(code=CONTRACTILE, name="contractile", **options),
    }


def phase_cycles(settings: VoxSettings, design: Design) -> NDArray[Any]:
    """Return the offsets of a design's controller in cycles, ``float64[X, Y, Z]``."""
    phase = design.roles[CONTROLLER]
    return phase if settings.phase_unit == "cycles" else phase / math.tau


def amplitude_of(settings: VoxSettings) -> float:
    """Return the amplitude of the temperature's swing, degrees.

    The engine holds it in single precision (physics.md, section 1): without, 4e-11 m are lost.
    """
    return single(settings.temperature_amplitude - settings.temperature_base)


def period_of(settings: VoxSettings) -> float:
    """Return the period of the temperature's swing, s, which the engine holds in single precision, too."""
    return single(1 / settings.frequency)
