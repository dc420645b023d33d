"""The simulator ``functions``: one step, in which a benchmark function is evaluated."""

from __future__ import annotations

import hashlib
from collections.abc import Sequence
from typing import Any, ClassVar, Literal

import attrs
import numpy as np
from attrs import validators
from numpy.typing import NDArray

from evoframe import ConfigurationError, Design, InputError, Outcome, Record
from evoframe_simulators.functions.formulas import (
    Booth,
    Function,
    Griewangk,
    MaximumOfQuadratics,
    OneRidge,
    Rastrigin,
    Rosenbrock,
)

__all__ = ["Functions"]

VALUE = "value"
END = 1.0


def _are_different(_instance: Any, attribute: attrs.Attribute[Any], names: tuple[str, ...]) -> None:
    if len(set(names)) < len(names):
        raise ValueError(f"'{attribute.name}' must be different names: {list(names)}")


@attrs.frozen(kw_only=True)
class Functions:
    """Benchmark functions, with which cooperative coevolution can be studied without physics.

    Each role of a design is a part of the function's point: ``float64[dimension]`` from 0 to 1. The parts are
    joined in the order of *roles*, and scaled to the domain of the function (:mod:`.formulas` has formulas
    and sources). Functions are maximized; those of minimization problems are negated.

    A simulation has one step, which ends at 1 s, and never diverges. There are no points to track; the track
    ``value``, ``float64[samples, 1]``, is the value of the function, which has no unit.

    Attributes:
        function: Name of the function.
        roles: Roles whose arrays are joined to a point, at least two.
        dimension: Number of variables in each role.
        mtq: Parameters of the function ``mtq``.
        griewangk: Parameters of the function ``griewangk``.
        booth: Parameters of the function ``booth``.
        rosenbrock: Parameters of the function ``rosenbrock``.
        rastrigin: Parameters of the function ``rastrigin``.
    """

    tracks: ClassVar[tuple[str, ...]] = ()

    function: Literal["mtq", "one-ridge", "griewangk", "booth", "rosenbrock", "rastrigin"] = "mtq"
    roles: tuple[str, ...] = attrs.field(
        default=("x", "y"), validator=[validators.min_len(2), _are_different]
    )
    dimension: int = attrs.field(default=1, validator=validators.ge(1))
    mtq: MaximumOfQuadratics = attrs.field(factory=MaximumOfQuadratics)
    griewangk: Griewangk = attrs.field(factory=Griewangk)
    booth: Booth = attrs.field(factory=Booth)
    rosenbrock: Rosenbrock = attrs.field(factory=Rosenbrock)
    rastrigin: Rastrigin = attrs.field(factory=Rastrigin)

    def __attrs_post_init__(self) -> None:
        self.formula.check(len(self.roles) * self.dimension)

    @property
    def formula(self) -> Function:
        """The function with its parameters."""
        formulas: dict[str, Function] = {
            "mtq": self.mtq,
            "one-ridge": OneRidge(),
            "griewangk": self.griewangk,
            "booth": self.booth,
            "rosenbrock": self.rosenbrock,
            "rastrigin": self.rastrigin,
        }
        return formulas[self.function]

    @property
    def requires(self) -> tuple[str, ...]:
        """The parts of the point."""
        return self.roles

    def check(self, record: Record) -> None:
        """Refuse a record of another track, or of more than the only step.

        Raises:
            ConfigurationError: The record cannot be produced; names the track, or the only sample.
        """
        for track in record.tracks:
            if track != VALUE:
                raise ConfigurationError(f"unknown track '{track}'; functions has only the track '{VALUE}'")
        last = max(record.samples or (0,))
        if last > 0:
            raise ConfigurationError(f"sample {last} does not exist: functions has only sample 0")
        if record.until > END:
            raise ConfigurationError(
                f"the only sample is at {END} s, expected at least {record.until} s; set an earlier time"
            )

    def key(self, design: Design, record: Record) -> bytes:
        """Return a digest of the point and the record.

        Raises:
            InputError: The design is not a point of the function.
        """
        unsigned = self._point(design) + 0.0  # -0 becomes 0, at which every function has the same value
        return hashlib.blake2b(repr(record).encode() + unsigned.tobytes(), digest_size=20).digest()

    def simulate(self, designs: Sequence[Design], record: Record) -> list[Outcome]:
        """Return the value of the function at each design, in order.

        Raises:
            InputError: A design is not a point of the function.
        """
        steps = _steps(record)
        return [
            Outcome(
                steps=steps,
                times=steps.astype(np.float64) * END,
                tracks={name: np.full((len(steps), 1), self.value(design)) for name in record.tracks},
            )
            for design in designs
        ]

    def value(self, design: Design) -> float:
        """Return the value of the function at a design.

        Raises:
            InputError: The design is not a point of the function.
        """
        low, high = self.formula.domain
        return self.formula.value((low + (high - low) * self._point(design)).tolist())

    def _point(self, design: Design) -> NDArray[np.float64]:
        """Return all variables, from 0 to 1."""
        for role in self.roles:
            _check_part(role, design.roles.get(role), self.dimension)
        return np.concatenate([design.roles[role] for role in self.roles])


def _check_part(role: str, part: NDArray[Any] | None, dimension: int) -> None:
    if part is None:
        raise InputError(f"the design has no role '{role}'")
    if part.dtype != np.float64 or part.shape != (dimension,):
        raise InputError(
            f"role '{role}': expected float64[{dimension}], found {part.dtype}{list(part.shape)}; "
            "simulator.dimension must be the length of the encoder's vector"
        )
    if not (part.min() >= 0.0 and part.max() <= 1.0):  # also if one is NaN
        raise InputError(f"role '{role}': expected numbers from 0 to 1, found {part.tolist()}")


def _steps(record: Record) -> NDArray[np.int64]:
    """Return the steps of the samples: 1 is the only step, 0 the state before it."""
    kept = [1] if record.samples is None else [1 for _ in record.samples]
    return np.array([0, *kept] if record.initial else kept, dtype=np.int64)
