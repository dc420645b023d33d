"""Decoding of a vector of genes, one for each output of a network: the encoder ``vector``."""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar

import attrs
import numpy as np
from attrs import validators

from evoframe import ArrayType, Design, Network

__all__ = ["Vector"]

_POINT = np.empty((1, 0))
_POINT.setflags(write=False)  # so that the core evaluates a network only once for all designs


@attrs.frozen
class Vector:
    """A vector of numbers from 0 to 1: the outputs of a network at a single point without coordinates.

    A network has no inputs, and an output for each number. Outputs are clipped, not squashed: with the
    evolver ``genetic``, each number is a gene (a direct encoding), and 0 and 1 can be reached.

    Attributes:
        role: Role of the vector in a design.
        length: Number of numbers.
    """

    inputs: ClassVar[int] = 0
    requires: ClassVar[tuple[str, ...]] = ()
    input_names: ClassVar[tuple[str, ...]] = ()

    role: str = attrs.field(validator=validators.min_len(1))
    length: int = attrs.field(default=1, validator=validators.ge(1))

    @property
    def outputs(self) -> int:
        """One output for each number."""
        return self.length

    @property
    def provides(self) -> tuple[str, ...]:
        """The vector, ``float64[length]``."""
        return (self.role,)

    @property
    def array_types(self) -> Mapping[str, ArrayType]:
        """Type and shape of the vector."""
        return {self.role: ArrayType("float64", (self.length,))}

    @property
    def output_names(self) -> tuple[str, ...]:
        """The role, with the index of the number if there are several."""
        return (self.role,) if self.length == 1 else tuple(f"{self.role} {n}" for n in range(self.length))

    def decode(self, network: Network, design: Design) -> Design:
        """Return *design* with the vector that *network* gives."""
        [genes] = network(_POINT)
        return design.with_role(self.role, genes.clip(0.0, 1.0))
