"""Measures of individuals besides their fitness, for evolvers that want them."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

import attrs
import numpy as np
from numpy.typing import NDArray

from evoframe.contract import Design, Encoder, blaming, measures_of_designs
from evoframe.errors import ComponentError
from evoframe.evolution.population import Population

__all__ = ["Measures"]

_NEIGHBOURS = 15  # of which novelty is the mean distance, as in Lehman and Stanley 2011


@attrs.frozen
class Measures:
    """The measures that do not depend on simulations.

    Attributes:
        encoders: Dotted key of an encoder -> the encoder.
    """

    encoders: Mapping[str, Encoder]

    def of(self, population: Population, name: str, designs: Sequence[Design]) -> list[float] | None:
        """Return a measure of each member; ``None`` if simulations supply it.

        Args:
            population: The population.
            name: Name of the measure.
            designs: For each member, the design of its first meeting in this turn.
        """
        if name == "age":
            return [float(member.age) for member in population.members]
        if name == "genome-size":
            return [float(member.genome_size) for member in population.members]
        if name == "novelty":
            return _novelty([_arrays(design, population.encoder.provides) for design in designs])
        for key, encoder in self.encoders.items():
            if name in measures_of_designs(encoder):
                return [
                    _measured(key, encoder, name, design, population.called(position))
                    for position, design in enumerate(designs)
                ]
        return None


def _measured(key: str, encoder: Any, name: str, design: Design, individual: str) -> float:
    with blaming(key, individual):
        value = float(encoder.measure(design)[name])
    if not math.isfinite(value):
        raise ComponentError(key, f"returned {value} for the measure '{name}'", individual)
    return value


def _arrays(design: Design, roles: Sequence[str]) -> list[NDArray[Any]]:
    return [design.roles[role] for role in roles]


def _novelty(parts: Sequence[Sequence[NDArray[Any]]]) -> list[float]:
    """Return the mean distance of each part to its nearest neighbors in the population.

    The distance of two arrays is the share of different entries if they are discrete, and the mean absolute
    difference otherwise (novelty search, Lehman and Stanley 2011, without an archive).
    """
    if len(parts) == 1:
        return [0.0]
    apart = np.array([[sum(map(_distance, one, other)) for other in parts] for one in parts])
    nearest = np.sort(apart, axis=1)[:, 1 : _NEIGHBOURS + 1]
    return [math.fsum(row) / len(row) for row in nearest.tolist()]


def _distance(one: NDArray[Any], other: NDArray[Any]) -> float:
    if one is other or one.size == 0:
        return 0.0
    if np.issubdtype(one.dtype, np.floating):
        return float(np.abs(one - other).mean())
    return float((one != other).mean())
