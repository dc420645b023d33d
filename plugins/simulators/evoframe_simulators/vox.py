"""The simulator ``vox``: one end of a body is clamped, contractile voxels swing, the rest follows."""

from __future__ import annotations

import functools
import hashlib
import math
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import ClassVar, Literal

import attrs
import numpy as np
from attrs import validators
from numpy.typing import NDArray

import evoframe_libvox as libvox
from evoframe import (
    CONTRACTILE,
    CONTROLLER,
    MORPHOLOGY,
    PASSIVE,
    ConfigurationError,
    Design,
    InputError,
    Outcome,
    Record,
)
from evoframe_simulators.bodies import check_design, read_bodies
from evoframe_simulators.sampling import count_samples, sample_steps

__all__ = ["Vox"]

_POSITIVE = validators.gt(0.0)
_NOT_NEGATIVE = validators.ge(0.0)


@attrs.frozen
class Vox:
    """Voxel actuators on libvox; the defaults are the paper's (paper.md, "The simulation of one pair").

    The whole slab x = 0 of the canvas is clamped in all six degrees of freedom. The paper's friction and
    collision damping need a floor and have no option here, since there is none. A design without any voxel
    cannot be simulated and counts as diverged at step 0.

    Attributes:
        duration: Simulated time, s.
        voxel_size: Edge of a voxel, m.
        youngs_modulus: Of both materials, Pa.
        poisson_ratio: Of both materials.
        density: Of both materials, kg/m3.
        expansion_coefficient: Linear thermal expansion of a contractile voxel, 1/degree; 0 switches it off.
        temperature_base: Degrees at which a voxel has its nominal size.
        temperature_amplitude: Highest temperature of the oscillation, degrees (the paper's engine counts from
            zero, so the swing is this less the base: 14.47 degrees, a linear strain of 0.1447).
        frequency: Of the contraction, Hz.
        phase_unit: How the controller's offsets are read. ``cycles`` is what the paper's engine does,
            ``radians`` what the paper says.
        self_collision: Whether voxels that are no neighbours repel each other closer than 1.5 edges.
        collision_horizon: How far candidates for contact are looked for, in voxel edges.
        time_step_fraction: Of the largest stable time step.
        bond_damping: Damping ratio of the bonds.
        slow_damping: Damping ratio against the ground.
    """

    requires: ClassVar[tuple[str, ...]] = (MORPHOLOGY, CONTROLLER)
    tracks: ClassVar[tuple[libvox.Track, ...]] = ("tip", "face", "body")

    duration: float = attrs.field(default=0.07, validator=_POSITIVE)
    voxel_size: float = attrs.field(default=0.05, validator=_POSITIVE)
    youngs_modulus: float = attrs.field(default=5e6, validator=_POSITIVE)
    poisson_ratio: float = attrs.field(default=0.35, validator=[validators.ge(0.0), validators.lt(0.5)])
    density: float = attrs.field(default=1e6, validator=_POSITIVE)
    expansion_coefficient: float = 0.01
    temperature_base: float = 25.0
    temperature_amplitude: float = 39.4714242553
    frequency: float = attrs.field(default=4.0, validator=_POSITIVE)
    phase_unit: Literal["cycles", "radians"] = "cycles"
    self_collision: bool = True
    collision_horizon: float = attrs.field(default=2.0, validator=_POSITIVE)
    time_step_fraction: float = attrs.field(default=0.9, validator=[validators.gt(0.0), validators.le(1.0)])
    bond_damping: float = attrs.field(default=1.0, validator=_NOT_NEGATIVE)
    slow_damping: float = attrs.field(default=0.01, validator=_NOT_NEGATIVE)

    def __attrs_post_init__(self) -> None:
        self._clocks()  # the solver has the last word on what it can do with these settings

    def _clocks(self) -> list[tuple[float, int]]:
        """Return the time step, s, and the number of steps of a body with bonds, and of one without."""
        try:
            time_steps, steps = _model(self, (2, 1, 1)).time_steps(_bar_and_lone_voxel())
        except ValueError as error:
            raise ValueError(_without_number(error)) from error
        return list(zip(time_steps.tolist(), steps.tolist(), strict=True))

    def check(self, record: Record) -> None:
        """Refuse a record with a track or a sample that there will not be.

        Raises:
            ConfigurationError: Says what there is.
        """
        for track in record.tracks:
            if track not in self.tracks:
                raise ConfigurationError(f"vox has no track '{track}'; tracks: {', '.join(self.tracks)}")
        if record.samples:
            last = max(record.samples)
            taken, steps = min((count_samples(*clock, record.every), clock[1]) for clock in self._clocks())
            if last >= taken:
                raise ConfigurationError(
                    f"sample {last} of one every {record.every} s is never taken: vox makes "
                    f"{steps} steps in simulator.duration = {self.duration} s, samples 0 to {taken - 1}"
                )

    def key(self, design: Design, record: Record) -> bytes:
        """Return a digest of the body, the offsets that act, and the record.

        Raises:
            InputError: The design is no body with a controller.
        """
        check_design(design)
        material, phase = design.roles[MORPHOLOGY], self._phase_cycles(design)
        acting = phase[material == CONTRACTILE] if self.expansion_coefficient else phase[:0]
        with np.errstate(over="ignore"):  # left to the solver to refuse
            single = acting.astype(np.float32) + np.float32(0)  # as the engine reads it, and without -0
        digest = hashlib.blake2b(repr((material.shape, record)).encode(), digest_size=20)
        digest.update(material.tobytes())
        digest.update(single.tobytes())
        return digest.digest()

    def simulate(self, designs: Sequence[Design], record: Record) -> list[Outcome]:
        """Return the outcome of each design, in order.

        Raises:
            InputError: A design is no body with a controller.
        """
        for design in designs:
            check_design(design)
        outcomes: dict[int, Outcome] = {}
        for canvas, indices in _by_canvas(designs):
            try:
                outcomes |= self._simulate(canvas, {index: designs[index] for index in indices}, record)
            except ValueError as error:  # the solver's words for what cells hold
                raise InputError(_without_number(error)) from error
        nothing = _nothing(record)
        return [outcomes.get(index, nothing) for index in range(len(designs))]

    def read(self, path: Path) -> list[tuple[str, Design]]:
        """Return the bodies of an ``.npz`` file with their labels.

        The file has ``material`` (``[X, Y, Z]`` or ``[N, X, Y, Z]``; codes 0, 1, 3) and ``phase_cycles`` of
        the same shape.

        Raises:
            InputError: The file cannot be read, or is something else.
        """
        unit = 1.0 if self.phase_unit == "cycles" else math.tau
        return [
            (label, Design({MORPHOLOGY: material, CONTROLLER: phase_cycles * unit}))
            for label, material, phase_cycles in read_bodies(path)
        ]

    def provenance(self) -> dict[str, str]:
        """Return the kernel that computes."""
        return {"libvox kernel": libvox.KERNEL}

    def _phase_cycles(self, design: Design) -> NDArray[np.float64]:
        phase: NDArray[np.float64] = design.roles[CONTROLLER]
        return phase if self.phase_unit == "cycles" else phase / math.tau

    def _simulate(
        self, canvas: tuple[int, int, int], designs: dict[int, Design], record: Record
    ) -> dict[int, Outcome]:
        """Simulate designs on one canvas together, as far as they share a time step."""
        model = _model(self, canvas)
        numbers = np.array(list(designs))
        material = np.stack([design.roles[MORPHOLOGY] for design in designs.values()])
        phase = np.stack([self._phase_cycles(design) for design in designs.values()])
        time_steps, steps = model.time_steps(material)
        outcomes: dict[int, Outcome] = {}
        for time_step in np.unique(time_steps):
            chosen = time_steps == time_step
            samples = sample_steps(float(time_step), int(steps[chosen][0]), record)
            tracks = tuple(track for track in self.tracks if track in record.tracks)
            result = model.simulate(material[chosen], phase[chosen], samples, tracks)
            for row, number in enumerate(numbers[chosen].tolist()):
                outcomes[number] = Outcome(
                    steps=samples,
                    times=samples * time_step,
                    tracks={name: track[row] for name, track in result.tracks.items()},
                    diverged_at=int(result.diverged_step[row]) or None,
                )
        return outcomes


def _by_canvas(designs: Sequence[Design]) -> Iterator[tuple[tuple[int, int, int], list[int]]]:
    """Group the designs that have a voxel by their canvas."""
    groups: dict[tuple[int, int, int], list[int]] = {}
    for index, design in enumerate(designs):
        material = design.roles[MORPHOLOGY]
        if material.any():
            x, y, z = material.shape
            groups.setdefault((x, y, z), []).append(index)
    yield from groups.items()


def _nothing(record: Record) -> Outcome:
    none = np.zeros((0, 3))
    return Outcome(np.zeros(0, np.int64), np.zeros(0), dict.fromkeys(record.tracks, none), diverged_at=0)


def _without_number(error: ValueError) -> str:
    """Return the solver's words without the number of the body, which nobody knows outside of its batch."""
    return str(error).partition(" (body ")[0]


def _bar_and_lone_voxel() -> NDArray[np.uint8]:
    return np.array([[PASSIVE, PASSIVE], [0, PASSIVE]], np.uint8).reshape(2, 2, 1, 1)


@functools.lru_cache(maxsize=16)
def _model(vox: Vox, canvas: tuple[int, int, int]) -> libvox.Model:
    """Return the model of a setting on a canvas; it is read-only, so threads share it."""
    passive = libvox.Material(vox.youngs_modulus, vox.poisson_ratio, vox.density, 0.0)
    contractile = attrs.evolve(passive, expansion=vox.expansion_coefficient)
    clamped = np.zeros(canvas, bool)
    clamped[0] = True
    settings = libvox.Settings(
        voxel_size=vox.voxel_size,
        time_step_fraction=vox.time_step_fraction,
        duration=vox.duration,
        # The engine holds this in single precision (physics.md, section 1): without, 4e-11 m are lost.
        temperature_amplitude=float(np.float32(vox.temperature_amplitude - vox.temperature_base)),
        period=1 / vox.frequency,
        bond_damping=vox.bond_damping,
        slow_damping=vox.slow_damping,
        self_collision=vox.self_collision,
        collision_horizon=vox.collision_horizon,
    )
    return libvox.Model(canvas, {PASSIVE: passive, CONTRACTILE: contractile}, settings, clamped)
