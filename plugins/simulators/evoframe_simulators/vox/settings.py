"""Settings of ``vox``, and quantities that depend on them alone."""

from __future__ import annotations

import math
from typing import Any, Literal

import attrs
from attrs import validators
from numpy.typing import NDArray

from evoframe import ADDED_LATER, CONTRACTILE, CONTROLLER, PASSIVE, Design
from evoframe_simulators.vox.limits import MOST_STEPS, VALID_PROPERTY, VALID_SETTING
from evoframe_simulators.vox.materials import PaletteMaterial, check_palette, round_to_single
from evoframe_simulators.vox.regions import FixedRegion

__all__ = ["VoxSettings", "amplitude_of", "materials_of", "period_of", "phase_cycles"]

# Options of the two built-in materials, which a palette replaces.
_BUILT_IN = (
    *("youngs_modulus", "poisson_ratio", "density", "expansion_coefficient"),
    *("static_friction", "dynamic_friction"),
)


@attrs.frozen(cache_hash=True)  # models and clocks are looked up by it
class VoxSettings:
    """Settings of a simulation; defaults from the paper (docs/experiment.md, "The simulation of a pair").

    The class checks the range of each value;
    :func:`evoframe_simulators.vox.models.possible_clocks` checks that the solver accepts their combination.

    Attributes:
        duration: Simulated time, s.
        voxel_size: Edge of a voxel, m.
        youngs_modulus: Young's modulus of both built-in materials, Pa; simulated in single precision.
        poisson_ratio: Poisson's ratio of both built-in materials.
        density: Density of both built-in materials, kg/m3.
        expansion_coefficient: Linear thermal expansion of a contractile voxel, 1/degree; 0: no contraction.
        static_friction: Coefficient of static friction of both built-in materials on the floor.
        dynamic_friction: Coefficient of dynamic friction of both built-in materials.
        palette: Materials that replace 1 (passive) and 3 (contractile) and the six values above: tables with
            ``code``, these six values and optionally ``name``. Empty: the built-in materials.
        temperature_base: Temperature at which a voxel has its nominal size, degrees.
        temperature_amplitude: Highest temperature of the oscillation, degrees (the paper's engine counts from
            zero, so the swing is this minus the base: 14.47 degrees, a linear strain of 0.1447).
        frequency: Frequency of the contraction, Hz.
        phase_unit: Unit of the controller's offsets: ``cycles`` as in the paper's engine, ``radians`` as in
            the paper's text.
        start_time: Time at which the contraction starts, s; its phase still runs from time 0.
        ramp: Time over which the contraction reaches its full amplitude, s.
        smallest_size: Smallest size of a voxel, as a multiple of its edge.
        largest_size: Largest size of a voxel, as a multiple of its edge.
        size_rule: Size of a voxel that would pass a limit: ``hold`` keeps its last value, as in the paper's
            engine; ``clamp`` gives it the limit.
        gravity: Acceleration along z, m/s2; negative is down.
        floor: Whether to add a floor at z = 0.
        floor_slope: Slope of the floor z = x tan(slope), degrees; its normal force remains vertical.
        falling_code: Material code whose contact with the plane z = 0 (or the sloped floor) ends the motion
            of a body, also without a floor; samples after that repeat its state. 0: none.
        fluid_drag: Half the density of the surrounding fluid times the drag coefficient, kg/m3.
        fluid_surface: Surface on which the fluid acts: ``bond-strain`` is that of the paper's engine, where a
            voxel reaches half an edge plus the strain of the bond on that side; with ``voxel-size``, it
            reaches half its size, and only the outer surface counts (docs/physics.md, section 7).
        fixed: Boxes whose voxels are clamped: tables with ``origin`` and ``size``, fractions of the canvas,
            and ``degrees_of_freedom``, a list from x, y, z, rx, ry, rz. Empty: the body is free.
        self_collision: Whether voxels that are not neighbors repel each other.
        collision_envelope: Distance between the centers of voxels at which repulsion starts, as a multiple of
            their mean size: 1.5 in the paper's engine; 1: repulsion starts on contact.
        collision_horizon: Radius of the search for contact candidates, in voxel edges.
        complete_contacts: Whether to find every contact in time; the paper's engine may find some late.
        contact_damping: Damping ratio of contacts between voxels; 0 in the paper's engine.
        contact_friction: Whether contacts between voxels have friction; not in the paper's engine.
        time_step_fraction: Time step as a fraction of the largest stable one.
        substeps: Number of solver steps in each time step; it does not change the sampled instants.
        step_limit: Maximum number of steps of a body; a body that requires more cannot be simulated. Bodies
            without bonds can require several times as many steps as others.
        bond_damping: Damping ratio of the bonds.
        slow_damping: Damping ratio of the motion relative to the ground.
        collision_damping: Damping ratio of the floor contact.
        largest_strain: Strain of a bond, dimensionless, beyond which the body counts as diverged.
        largest_distance: Distance of a voxel from its initial position, as a multiple of the longest edge of
            the canvas, beyond which the body counts as diverged.
        whole_body: Whether to simulate the whole body for the whole duration, so that a divergence anywhere
            counts. Otherwise only what can affect the recorded samples is simulated, and a body that diverges
            out of their reach has not diverged. Samples are the same, bit for bit, under the assumptions of
            docs/solver.md, "What is not computed".
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
    smallest_size: float = attrs.field(
        default=0.1, validator=VALID_SETTING["smallest_size"], metadata=ADDED_LATER
    )
    largest_size: float = attrs.field(
        default=3.0, validator=VALID_SETTING["largest_size"], metadata=ADDED_LATER
    )
    size_rule: Literal["hold", "clamp"] = attrs.field(default="hold", metadata=ADDED_LATER)
    gravity: float = attrs.field(default=0.0, validator=VALID_SETTING["gravity"])
    floor: bool = False
    floor_slope: float = attrs.field(default=0.0, validator=VALID_SETTING["floor_slope"])
    falling_code: int = attrs.field(default=0, validator=VALID_SETTING["falling_code"], metadata=ADDED_LATER)
    fluid_drag: float = attrs.field(default=0.0, validator=VALID_SETTING["fluid_drag"])
    fluid_surface: Literal["bond-strain", "voxel-size"] = attrs.field(
        default="bond-strain", metadata=ADDED_LATER
    )
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
    whole_body: bool = attrs.field(default=False, metadata=ADDED_LATER)


def materials_of(settings: VoxSettings) -> dict[int, PaletteMaterial]:
    """Return the material of each valid code, except 0 (empty)."""
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
    """Return the amplitude of the temperature oscillation, degrees.

    The engine holds it in single precision (docs/physics.md, section 1); double precision would change
    results by 4e-11 m.
    """
    return round_to_single(settings.temperature_amplitude - settings.temperature_base)


def period_of(settings: VoxSettings) -> float:
    """Return the period of the temperature oscillation, s, in single precision like the engine."""
    return round_to_single(1 / settings.frequency)
