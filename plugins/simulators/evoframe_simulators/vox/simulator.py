"""The simulator ``vox``: bodies of voxels, held or free, whose contractile voxels swing."""

from __future__ import annotations

import functools
import hashlib
import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, ClassVar, Literal, TypeVar

import attrs
import numpy as np
from attrs import validators
from numpy.typing import NDArray

import evoframe_libvox as libvox
from evoframe import (
    CONTROLLER,
    MORPHOLOGY,
    ConfigurationError,
    Design,
    Export,
    Geometry,
    InputError,
    Outcome,
    Record,
    Variant,
)
from evoframe_simulators.vox.bodies import check_codes, check_design, read_bodies
from evoframe_simulators.vox.geometry import geometry
from evoframe_simulators.vox.materials import PaletteMaterial, check_palette, materials_of
from evoframe_simulators.vox.models import (
    acting_codes,
    clock_of,
    clocks_of,
    model_of,
    possible_clocks,
    without_number,
)
from evoframe_simulators.vox.published import published_bodies
from evoframe_simulators.vox.regions import FixedRegion
from evoframe_simulators.vox.sampling import check_samples
from evoframe_simulators.vox.tracks import FURTHER, POINTS, check_room, check_tracks, shape_of
from evoframe_simulators.vox.verification import variants
from evoframe_simulators.vox.vxa import VxaFile, left_out, read_vxa, write_vxa

__all__ = ["Vox"]

_POSITIVE = validators.gt(0.0)
_NOT_NEGATIVE = validators.ge(0.0)

R = TypeVar("R")


def _within(least: float, most: float) -> list[Any]:
    return [validators.ge(least), validators.le(most)]


@attrs.frozen(cache_hash=True)  # its models are looked up by it
class Vox:
    """Voxels on libvox; the defaults are the paper's (paper.md, "The simulation of one pair").

    The whole slab x = 0 of the canvas is clamped in all six degrees of freedom, and there is neither gravity
    nor floor. A design without any voxel cannot be simulated and counts as diverged at step 0. Beside its
    points it records ``voxels``, ``energy``, ``strain`` and ``momentum``: see ``evoframe_simulators.tracks``.

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

    requires: ClassVar[tuple[str, ...]] = (MORPHOLOGY, CONTROLLER)
    tracks: ClassVar[tuple[libvox.Track, ...]] = POINTS
    formats: ClassVar[tuple[str, ...]] = ("vxa",)

    duration: float = attrs.field(default=0.07, validator=_POSITIVE)
    voxel_size: float = attrs.field(default=0.05, validator=_POSITIVE)
    youngs_modulus: float = attrs.field(default=5e6, validator=_POSITIVE)
    poisson_ratio: float = attrs.field(default=0.35, validator=[validators.ge(0.0), validators.lt(0.5)])
    density: float = attrs.field(default=1e6, validator=_POSITIVE)
    expansion_coefficient: float = 0.01
    static_friction: float = attrs.field(default=1.0, validator=_NOT_NEGATIVE)
    dynamic_friction: float = attrs.field(default=0.5, validator=_NOT_NEGATIVE)
    palette: tuple[PaletteMaterial, ...] = attrs.field(default=(), validator=check_palette)
    temperature_base: float = 25.0
    temperature_amplitude: float = 39.4714242553
    frequency: float = attrs.field(default=4.0, validator=_POSITIVE)
    phase_unit: Literal["cycles", "radians"] = "cycles"
    start_time: float = attrs.field(default=0.0, validator=_NOT_NEGATIVE)
    ramp: float = attrs.field(default=0.0, validator=_NOT_NEGATIVE)
    gravity: float = 0.0
    floor: bool = False
    floor_slope: float = attrs.field(default=0.0, validator=_within(-89.0, 89.0))
    fluid_drag: float = attrs.field(default=0.0, validator=_NOT_NEGATIVE)
    fixed: tuple[FixedRegion, ...] = (FixedRegion(),)
    self_collision: bool = True
    collision_envelope: float = attrs.field(default=1.5, validator=_within(1.0, 2.0))
    collision_horizon: float = attrs.field(default=2.0, validator=_within(1.0, 4.0))
    complete_contacts: bool = False
    contact_damping: float = attrs.field(default=0.0, validator=_NOT_NEGATIVE)
    contact_friction: bool = False
    time_step_fraction: float = attrs.field(default=0.9, validator=[validators.gt(0.0), validators.le(1.0)])
    substeps: int = attrs.field(default=1, validator=_within(1, 1000))
    step_limit: int = attrs.field(default=10_000_000, validator=_within(1, 2**53))
    bond_damping: float = attrs.field(default=1.0, validator=_NOT_NEGATIVE)
    slow_damping: float = attrs.field(default=0.01, validator=_NOT_NEGATIVE)
    collision_damping: float = attrs.field(default=0.8, validator=_NOT_NEGATIVE)
    largest_strain: float = attrs.field(default=100.0, validator=_POSITIVE)
    largest_distance: float = attrs.field(default=100.0, validator=_POSITIVE)

    def __attrs_post_init__(self) -> None:
        possible_clocks(self)  # the solver has the last word on what it can do with these settings

    def check(self, record: Record) -> None:
        """Refuse a record with a track or a sample that there will not be, or that ends too early.

        Raises:
            ConfigurationError: Says what there is.
        """
        check_tracks(record.tracks)
        check_samples(record, possible_clocks(self), self.duration)

    def key(self, design: Design, record: Record) -> bytes:
        """Return a digest of the body, the offsets that act, and the record.

        Raises:
            InputError: The design is no body with a controller.
        """
        check_design(design)
        material, phase = design.roles[MORPHOLOGY], self._phase_cycles(design)
        acting = phase[acting_codes(self).take(material)]
        with np.errstate(over="ignore"):  # left to the solver to refuse
            single = acting.astype(np.float32) + np.float32(0)  # as the engine reads it, and without -0
        digest = hashlib.blake2b(_written(material.shape, record), digest_size=20)
        digest.update(material.tobytes())
        digest.update(single.tobytes())
        return digest.digest()

    def simulate(self, designs: Sequence[Design], record: Record) -> list[Outcome]:
        """Return the outcome of each design, in order.

        Raises:
            InputError: A design is no body with a controller, or its record would be too large.
        """
        for design in designs:
            check_design(design)
        outcomes: dict[int, Outcome] = {}
        for canvas, indices in _by_canvas(designs):
            try:
                outcomes |= self._simulate(canvas, {index: designs[index] for index in indices}, record)
            except ValueError as error:  # the solver's words for what cells hold
                for index in indices:  # it does not say which code it does not know
                    check_codes(designs[index].roles[MORPHOLOGY], materials_of(self))
                raise InputError(without_number(error)) from error
        return [
            outcomes[index] if index in outcomes else _nothing(design, record)
            for index, design in enumerate(designs)
        ]

    def variants(self, design: Design, record: Record) -> list[Variant]:
        """Return what ``evoframe verify`` compares a design with (see ``evoframe_simulators.verification``).

        Raises:
            InputError: The design is no body with a controller.
        """
        check_design(design)
        try:
            return variants(self, design, record)
        except ValueError as error:  # the solver's words for what cells hold
            raise InputError(without_number(error)) from error

    def geometry(self, design: Design, frames: int) -> Geometry:
        """Return what is drawn of a body (see ``evoframe_simulators.geometry``).

        Raises:
            InputError: The design is no body with a controller, or has no voxel.
            ValueError: *frames* is not positive.
        """
        return geometry(self, design, frames)

    def random_controller(self, design: Design, rng: np.random.Generator) -> Design:
        """Return the body with offsets drawn from [-2 pi, 2 pi), uniformly, for every cell of its canvas.

        Cells that are empty or do not act have offsets too, so that all bodies of a canvas get the same. As
        with any controller, ``phase_unit`` says how they are read.

        Raises:
            InputError: The design is no body with a controller.
        """
        check_design(design)
        offsets = rng.uniform(-math.tau, math.tau, design.roles[MORPHOLOGY].shape)
        return design.with_role(CONTROLLER, offsets)

    def published(self) -> list[tuple[str, Design]]:
        """Return the bodies of ``evoframe_simulators.published`` with their labels, all offsets being 0."""
        return [
            (label, Design({MORPHOLOGY: material, CONTROLLER: np.zeros(material.shape)}))
            for label, material in published_bodies().items()
        ]

    def read(self, path: Path) -> list[tuple[str, Design]]:
        """Return the bodies of an ``.npz`` or ``.vxa`` file with their labels.

        An ``.npz`` file has ``material`` (``[X, Y, Z]`` or ``[N, X, Y, Z]``, codes of the palette) and
        ``phase_cycles`` of the same shape. The offsets of a ``.vxa`` file are taken as they stand there, so
        that ``phase_unit`` says how they are read.

        Raises:
            InputError: The file cannot be read, or is something else.
        """
        materials = materials_of(self)
        if path.suffix.lower() == ".vxa":
            file = read_vxa(path)
            _checked(path, check_codes, file.material, materials)
            return [(path.name, Design({MORPHOLOGY: file.material, CONTROLLER: file.phase}))]
        if path.suffix.lower() != ".npz":
            raise InputError(f"{path}: vox reads .npz and .vxa files, and this is neither by its name")
        unit = 1.0 if self.phase_unit == "cycles" else math.tau
        return [
            (label, Design({MORPHOLOGY: material, CONTROLLER: phase_cycles * unit}))
            for label, material, phase_cycles in read_bodies(path, materials)
        ]

    @classmethod
    def settings_of(cls, path: Path) -> Mapping[str, Any] | None:
        """Return all options as a ``.vxa`` file has them, as TOML values; ``None`` for other files.

        Raises:
            InputError: The file cannot be read, is no such file, or asks for what vox does not do; says what.
        """
        if path.suffix.lower() != ".vxa":
            return None
        vox = _checked(path, cls._as_in, read_vxa(path))
        return attrs.asdict(vox, value_serializer=_listed)

    def export(self, design: Design, format: str) -> Export:  # noqa: A002 - the protocol's word
        """Return a design with these settings as a file of the format ``vxa``.

        Raises:
            ConfigurationError: There is no such format.
            InputError: The design cannot be simulated, or has what the format cannot say.
        """
        if format not in self.formats:
            raise ConfigurationError(f"vox does not write '{format}'; formats: {', '.join(self.formats)}")
        check_design(design)
        material, phase = design.roles[MORPHOLOGY], self._phase_cycles(design)
        acting = acting_codes(self)[material]
        check_codes(material, materials_of(self))
        return Export(write_vxa(self, material, phase, acting), left_out(self))

    def provenance(self) -> dict[str, str]:
        """Return the kernel that computes, and the compiler that made it."""
        return {"libvox kernel": model_of(self, (1, 1, 1)).kernel, "libvox compiler": libvox.COMPILER}

    @classmethod
    def _as_in(cls, file: VxaFile) -> Vox:
        """Return the simulator that a file describes."""
        if file.steps is None:
            return cls(**file.options)
        brief = cls(**file.options, duration=math.ulp(0.0))
        [clock] = clocks_of(brief, model_of(brief, file.canvas), file.material[None])
        return attrs.evolve(brief, duration=(file.steps - 0.5) * clock.time_step)

    def _phase_cycles(self, design: Design) -> NDArray[np.float64]:
        phase: NDArray[np.float64] = design.roles[CONTROLLER]
        return phase if self.phase_unit == "cycles" else phase / math.tau

    def _simulate(
        self, canvas: tuple[int, int, int], designs: dict[int, Design], record: Record
    ) -> dict[int, Outcome]:
        """Simulate designs on one canvas together, as far as they have the same number of samples."""
        model = model_of(self, canvas)
        clocks = {
            number: clock_of(self, canvas, design.roles[MORPHOLOGY].tobytes())
            for number, design in designs.items()
        }
        samples = {clock: clock.samples(record) for clock in set(clocks.values())}
        tracks = tuple(track for track in (*POINTS, *FURTHER) if track in record.tracks)
        outcomes: dict[int, Outcome] = {}
        for count in {len(taken) for taken in samples.values()}:
            check_room(tracks, canvas, count)
            chosen = {number: clock for number, clock in clocks.items() if len(samples[clock]) == count}
            result = model.simulate(
                np.stack([designs[number].roles[MORPHOLOGY] for number in chosen]),
                np.stack([self._phase_cycles(designs[number]) for number in chosen]),
                np.stack([samples[clock] for clock in chosen.values()]),
                tracks,
            )
            for place, (number, clock) in enumerate(chosen.items()):
                outcomes[number] = Outcome(
                    steps=samples[clock],
                    times=samples[clock] * np.float64(clock.time_step),
                    tracks={name: track[place] for name, track in result.tracks.items()},
                    diverged_at=int(result.diverged_step[place]) or None,
                )
        return outcomes


def _checked(path: Path, function: Callable[..., R], *arguments: Any) -> R:
    """Call a function, and name the file in what it has to say against it."""
    try:
        return function(*arguments)
    except (InputError, ValueError) as error:
        raise InputError(f"{path}: {without_number(error)}") from error


@functools.lru_cache(maxsize=16)
def _written(shape: tuple[int, ...], record: Record) -> bytes:
    """Return in bytes what a key says beside what stands in the cells."""
    return repr((shape, record)).encode()


def _listed(_: Any, __: Any, value: Any) -> Any:
    """Return a list for a tuple, as TOML has no other."""
    return list(value) if isinstance(value, tuple) else value


def _by_canvas(designs: Sequence[Design]) -> Iterator[tuple[tuple[int, int, int], list[int]]]:
    """Group the designs that have a voxel by their canvas."""
    groups: dict[tuple[int, int, int], list[int]] = {}
    for index, design in enumerate(designs):
        material = design.roles[MORPHOLOGY]
        if material.any():
            x, y, z = material.shape
            groups.setdefault((x, y, z), []).append(index)
    yield from groups.items()


def _nothing(design: Design, record: Record) -> Outcome:
    canvas = design.roles[MORPHOLOGY].shape
    tracks = {track: np.zeros((0, *shape_of(track, canvas))) for track in record.tracks}
    return Outcome(np.zeros(0, np.int64), np.zeros(0), tracks, diverged_at=0)
