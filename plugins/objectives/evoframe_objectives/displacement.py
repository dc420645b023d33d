"""Displacement of the free end between two samples of its track."""

from __future__ import annotations

import math
from typing import ClassVar

import attrs
import numpy as np
from attrs import validators
from numpy.typing import NDArray

from evoframe import Outcome, Record

__all__ = ["FaceYz", "TipDz", "TipYz"]


@attrs.frozen
class _Displacement:
    """Base class of the displacements, each measured between two samples of a track.

    The paper's engine samples after the first step and then at least 0.01 s apart; the paper's displacement
    is measured from sample 0 (t = 0.0032 s) to sample 5 (t = 0.0673 s).

    Attributes:
        every: Minimum time between samples, s; 0: a sample after every step.
        first: Index of the sample at which the displacement starts; sample 0 follows the first step.
        last: Index of the sample at which the displacement ends.
    """

    track: ClassVar[str]
    unit: ClassVar[str] = "m"

    every: float = attrs.field(default=0.01, validator=validators.ge(0))
    first: int = attrs.field(default=0, validator=validators.ge(0))
    last: int = attrs.field(default=5, validator=validators.ge(1))

    def __attrs_post_init__(self) -> None:
        if self.first >= self.last:
            raise ValueError(f"expected first < last, found first = {self.first} and last = {self.last}")

    @property
    def record(self) -> Record:
        """The track at the two samples."""
        return Record(tracks=(self.track,), every=self.every, samples=(self.first, self.last))

    def _moved(self, outcome: Outcome) -> NDArray[np.float64]:
        first, last = outcome.tracks[self.track]
        moved: NDArray[np.float64] = last - first
        return moved


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
