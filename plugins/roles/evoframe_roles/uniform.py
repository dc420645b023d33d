"""Roles with the same value everywhere: the provider ``uniform``."""

from __future__ import annotations

from typing import Any, Literal

import attrs
import numpy as np

from evoframe import CONTROLLER, Design, Simulator

__all__ = ["Uniform"]


def _at_least_one(_instance: Any, attribute: attrs.Attribute[Any], shape: tuple[int, ...]) -> None:
    for length in shape:
        if length < 1:
            raise ValueError(f"'{attribute.name}' must have lengths of at least 1: {shape}")


@attrs.frozen
class Uniform:
    """An array with the same value everywhere, such as a controller that contracts all voxels in phase.

    Attributes:
        role: The role.
        value: The value, in the role's unit.
        dtype: Type of the array: float64 for controllers, uint8 for morphologies.
        shape: Lengths of its axes; without any, those of the role *like*.
        like: The role of the design whose shape it has, if *shape* is empty.
    """

    role: str = CONTROLLER
    value: float = 0.0
    dtype: Literal["float64", "uint8"] = "float64"
    shape: tuple[int, ...] = attrs.field(default=(), validator=_at_least_one)
    like: str = "morphology"

    def __attrs_post_init__(self) -> None:
        if self.dtype == "uint8" and self.value not in range(256):
            raise ValueError(f"'value' must be a whole number from 0 to 255 with dtype uint8: {self.value}")

    @property
    def requires(self) -> tuple[str, ...]:
        """The role that determines the shape, if the options do not."""
        return () if self.shape else (self.like,)

    @property
    def provides(self) -> tuple[str, ...]:
        """The role."""
        return (self.role,)

    def start(self, simulator: Simulator) -> Uniform:  # noqa: ARG002
        """Return the provider itself, which has no state."""
        return self

    def fill(self, design: Design, rng: np.random.Generator) -> Design:  # noqa: ARG002
        """Return *design* with the role; *rng* is not used."""
        shape = self.shape or design.roles[self.like].shape
        return design.with_role(self.role, np.full(shape, self.value, dtype=self.dtype))

    def state(self) -> None:
        """Return nothing: the options are the state."""

    def restore(self, state: Any) -> None:
        """Accept the empty state."""
        if state is not None:
            raise ValueError(f"expected no state, found {state!r}")
