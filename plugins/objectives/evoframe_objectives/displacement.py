"""Displacement of the free end between two samples of its trace."""

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
    """What all displacements share: a track, and the two samples between which it is measured.

    The paper's engine samples after the first step and then every 0.01 s at the earliest; the displacement of
    the paper is that of sample 5 (t = 0.0673 s) from sample 0 (t = 0.0032 s).

    Attributes:
        every: Seconds between samples; 0 samples after every step.
        first: Index of the sample that is measured from.
        last: Index of the sample that is measured to.
    """

    track: ClassVar[str]
    unit: ClassVar[str] = "m"

    every: float = attrs.field(default=0.01, validator=validators.ge(0))
    first: int = attrs.field(default=0, validator=validators.ge(0))
    last: int = attrs.field(default=5, validator=validators.ge(1))

    def __attrs_post_init__(self) -> None:
        if self.first >= self.last:
            raise ValueError(
                f"first must come before last, found first = {self.first} and last = {self.last}"
            )

    @property
    def record(self) -> Record:
        """The two samples of the track."""
        return Record(tracks=(self.track,), every=self.every, samples=(self.first, self.last))

    def _moved(self, outcome: Outcome) -> NDArray[np.float64]:
        first, last = outcome.tracks[self.track]
        moved: NDArray[np.float64] = last - first
        return moved


@attrs.frozen
class TipDz(_Displacement):
    """How far the corner voxel of the free end rises, in metres; down is negative.

    This is what the authors' coevolution maximises (paper.md, "The simulation of one pair").
    """

    track = "tip"

    def score(self, outcome: Outcome) -> float:
        """Return the rise of the corner voxel."""
        return float(self._moved(outcome)[2])


@attrs.frozen
class _DistanceYz(_Displacement):
    """How far the track moves in the yz plane, in metres; never negative."""

    def score(self, outcome: Outcome) -> float:
        """Return the distance in the yz plane."""
        return math.hypot(*self._moved(outcome)[1:])


@attrs.frozen
class TipYz(_DistanceYz):
    """How far the corner voxel of the free end moves in the yz plane, in metres; never negative.

    This is the paper's wording, and the authors' first version.
    """

    track = "tip"


@attrs.frozen
class FaceYz(_DistanceYz):
    """How far the centre of the free face moves in the yz plane, in metres; never negative."""

    track = "face"
