"""A third-party experiment without voxels: thrown balls, each a design with two numbers."""

import hashlib
import math
from collections.abc import Mapping, Sequence
from typing import ClassVar

import attrs
import numpy as np
from attrs import validators
from numpy.typing import NDArray

from evoframe import (
    ArrayType,
    ConfigurationError,
    Design,
    Encoder,
    InputError,
    Network,
    Objective,
    Outcome,
    Record,
    Simulator,
    hookimpl,
)

THROW, BALL = "throw", "ball"
GRAVITY = 9.81  # m/s^2


@attrs.frozen
class Throw:
    """A throw from two outputs of a network without inputs: shares of a right angle, and of the top speed.

    Outputs from 0 to 1 are taken as they are, others are clipped.
    """

    inputs: ClassVar[int] = 0
    outputs: ClassVar[int] = 2
    requires: ClassVar[tuple[str, ...]] = ()
    provides: ClassVar[tuple[str, ...]] = (THROW,)
    output_names: ClassVar[tuple[str, ...]] = ("angle", "speed")
    array_types: ClassVar[Mapping[str, ArrayType]] = {THROW: ArrayType("float64", (2,))}

    def decode(self, network: Network, design: Design) -> Design:
        [outputs] = network(np.empty((1, 0)))
        return design.with_role(THROW, outputs.clip(0.0, 1.0))


@attrs.frozen
class Ballistics:
    """The flight of a ball with air drag in the plane y = 0, from the origin until it lies on the ground.

    The design has the role ``throw``, ``float64[2]`` from 0 to 1: elevation in right angles, and speed in
    units of *speed*. The drag is *drag* times the square of the speed (explicit Euler steps). A simulation
    whose steps are so long that drag reverses the ball has diverged.

    Attributes:
        speed: Largest speed, m/s.
        drag: Deceleration by drag, divided by the square of the speed, 1/m.
        time_step: Time step, s.
        steps: Number of steps.
    """

    tracks: ClassVar[tuple[str, ...]] = (BALL,)
    requires: ClassVar[tuple[str, ...]] = (THROW,)

    speed: float = attrs.field(default=30.0, validator=validators.gt(0.0))
    drag: float = attrs.field(default=0.01, validator=validators.ge(0.0))
    time_step: float = attrs.field(default=0.02, validator=validators.gt(0.0))
    steps: int = attrs.field(default=250, validator=validators.ge(1))

    def check(self, record: Record) -> None:
        for track in record.tracks:
            if track != BALL:
                raise ConfigurationError(f"unknown track '{track}'; ballistics has only the track '{BALL}'")
        count, end = len(self._sampled(record.every)), self.steps * self.time_step
        if record.samples and record.samples[-1] >= count:
            raise ConfigurationError(f"sample {record.samples[-1]} does not exist; there are {count} samples")
        if record.until > end:
            raise ConfigurationError(f"ends at {end:g} s, expected {record.until:g} s; increase the steps")

    def simulate(self, designs: Sequence[Design], record: Record) -> list[Outcome]:
        sampled = self._sampled(record.every)
        steps = sampled if record.samples is None else [sampled[index] for index in record.samples]
        chosen = np.array([0, *steps] if record.initial else steps, dtype=np.int64)
        return [self._outcome(design, chosen, record.tracks) for design in designs]

    def _outcome(self, design: Design, steps: NDArray[np.int64], tracks: Sequence[str]) -> Outcome:
        flight, diverged_at = self._flight(_throw(design))
        times = steps.astype(np.float64) * self.time_step
        return Outcome(steps, times, dict.fromkeys(tracks, flight[steps]), diverged_at)

    def _flight(self, throw: NDArray[np.float64]) -> tuple[NDArray[np.float64], int | None]:
        """Return the positions after each step, NaN from a divergence on, and the step of the divergence."""
        angle, speed = float(throw[0]) * math.pi / 2, float(throw[1]) * self.speed
        x, z, vx, vz = 0.0, 0.0, speed * math.cos(angle), speed * math.sin(angle)
        flight = np.full((self.steps + 1, 3), np.nan)
        flight[0] = 0.0
        for step in range(1, self.steps + 1):
            kept = 1.0 - self.drag * math.hypot(vx, vz) * self.time_step
            if not kept >= 0.0:  # also if a number of the design is NaN
                return flight, step
            vx, vz = kept * vx, kept * vz - GRAVITY * self.time_step
            x, z = x + vx * self.time_step, z + vz * self.time_step
            if z <= 0.0:
                flight[step:] = x, 0.0, 0.0
                break
            flight[step] = x, 0.0, z
        return flight, None

    def _sampled(self, every: float) -> list[int]:
        """Return the steps of all samples: the first one, and each that ends *every* seconds later."""
        sampled = [1]
        for step in range(2, self.steps + 1):
            if (step - sampled[-1]) * self.time_step >= every:
                sampled.append(step)
        return sampled

    def key(self, design: Design, record: Record) -> bytes:
        throw = _throw(design) + 0.0  # -0.0 is the same throw as 0.0
        return hashlib.sha256(repr(record).encode() + throw.tobytes()).digest()


def _throw(design: Design) -> NDArray[np.float64]:
    throw = design.roles[THROW]
    if throw.dtype != np.float64 or throw.shape != (2,):
        raise InputError(f"role '{THROW}': expected float64[2], found {throw.dtype}{list(throw.shape)}")
    return throw


@attrs.frozen
class Nearness:
    """Distance of the last position of the ball from a target on the ground, with a minus sign.

    Attributes:
        target: Distance of the target from the origin, m.
        after: Time after which the position counts, s.
    """

    unit: ClassVar[str] = "m"

    target: float = attrs.field(default=35.0, validator=validators.ge(0.0))
    after: float = attrs.field(default=4.0, validator=validators.ge(0.0))

    @property
    def record(self) -> Record:
        return Record((BALL,), until=self.after)

    def score(self, outcome: Outcome) -> float:
        x, _, z = outcome.tracks[BALL][-1].tolist()
        return -math.hypot(x - self.target, z)

    def window(self, times: NDArray[np.float64]) -> tuple[float, float]:
        return float(times[-1]), float(times[-1])


@hookimpl
def evoframe_encoders() -> Mapping[str, type[Encoder]]:
    return {"throw": Throw}


@hookimpl
def evoframe_simulators() -> Mapping[str, type[Simulator]]:
    return {"ballistics": Ballistics}


@hookimpl
def evoframe_objectives() -> Mapping[str, type[Objective]]:
    return {"nearness": Nearness}
