"""Displacement of the free end between two samples of its track."""

from __future__ import annotations

import math
from typing import Any, ClassVar

import attrs
import numpy as np
from attrs import validators
from numpy.typing import NDArray

from evoframe import ConfigurationError, Outcome, Record

__all__ = ["FaceYz", "TipDz", "TipYz"]


@attrs.frozen(repr=False)
class _LastIndex:
    """An attrs validator that rejects 0: an index counts from 1 on, or from the end."""

    def __call__(self, _: Any, attribute: attrs.Attribute[int], value: int) -> None:
        if value == 0:
            raise ValueError(f"'{attribute.name}' must be >= 1 or <= -1: {value}")

    def __repr__(self) -> str:
        return "<Validator for x >= 1 or <= -1>"


@attrs.frozen
class _Displacement:
    """Base class of the displacements, each measured between two samples of a track.

    The paper's engine samples after the first step and then at least 0.01 s apart; the paper's displacement
    is measured from sample 0 (t = 0.0032 s) to sample 5 (t = 0.0673 s), however long the simulation is; with
    ``last = -1``, it is measured to the end of the simulation.

    Attributes:
        every: Minimum time between samples, s; 0: a sample after every step.
        first: Index of the sample at which the displacement starts; sample 0 follows the first step.
        last: Index of the sample at which the displacement ends, after the first; a negative index counts
            from the end of the simulation: -1 is the last sample.
    """

    track: ClassVar[str]
    unit: ClassVar[str] = "m"

    every: float = attrs.field(default=0.01, validator=validators.ge(0))
    first: int = attrs.field(default=0, validator=validators.ge(0))
    last: int = attrs.field(default=5, validator=_LastIndex())

    def __attrs_post_init__(self) -> None:
        if 0 <= self.last <= self.first:
            raise ValueError(f"expected first < last, found first = {self.first} and last = {self.last}")

    @property
    def record(self) -> Record:
        """The track at the two samples, or at all samples if the last one is counted from the end."""
        if self.last > 0:
            return Record(tracks=(self.track,), every=self.every, samples=(self.first, self.last))
        return Record(tracks=(self.track,), every=self.every, until=self.every * (self.first - self.last - 1))

    def window(self, times: NDArray[np.float64]) -> tuple[float, float]:
        """Return the times of the two samples.

        Raises:
            ConfigurationError: As for :meth:`score`.
        """
        first, last = self._rows(len(times))
        return float(times[first]), float(times[last])

    def _moved(self, outcome: Outcome) -> NDArray[np.float64]:
        track = outcome.tracks[self.track]
        first, last = self._rows(len(track))
        moved: NDArray[np.float64] = track[last] - track[first]
        return moved

    def _rows(self, count: int) -> tuple[int, int]:
        """Return the rows of the two samples among *count* recorded ones."""
        if self.last > 0:
            return 0, 1
        required = self.first - self.last
        if required > count:
            raise ConfigurationError(
                f"first = {self.first} and last = {self.last} require {required} samples, but the simulation "
                f"has {count}; simulate for longer, or choose other samples"
            )
        return self.first, count + self.last


@attrs.frozen
class TipDz(_Displacement):
    """Rise of the corner voxel of the free end, in meters; down is negative.

    The authors' code maximizes this (docs/experiment.md, "The simulation of a pair").
    """

    track = "tip"

    def score(self, outcome: Outcome) -> float:
        """Return the rise of the corner voxel."""
        return float(self._moved(outcome)[2])


@attrs.frozen
class _DistanceYz(_Displacement):
    """Distance that the track moves in the yz plane, in meters; never negative."""

    def score(self, outcome: Outcome) -> float:
        """Return the distance in the yz plane."""
        return math.hypot(*self._moved(outcome)[1:])


@attrs.frozen
class TipYz(_DistanceYz):
    """Distance that the corner voxel of the free end moves in the yz plane, in meters; never negative.

    This measure is the one that the paper describes, and that the first version of the authors' code used.
    """

    track = "tip"


@attrs.frozen
class FaceYz(_DistanceYz):
    """Distance that the center of the free face moves in the yz plane, in meters; never negative."""

    track = "face"
