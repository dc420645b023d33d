"""Motion over a whole simulation, measured after an initial time in which the body settles."""

from __future__ import annotations

import math
from typing import ClassVar, Literal

import attrs
import numpy as np
from attrs import validators
from numpy.typing import NDArray

from evoframe import ConfigurationError, Outcome, Record

__all__ = ["FacePeak", "Travel"]

_ROUNDING = 1e-12  # relative; so that a sample taken at objective.after counts despite rounding errors


@attrs.frozen
class _Settled:
    """Base class of the objectives over a whole simulation.

    Attributes:
        every: Minimum time between samples, s; 0: a sample after every step.
        after: Time for the body to settle, s; samples before this time do not count.
    """

    unit: ClassVar[str] = "m"

    every: float = attrs.field(default=0.0, validator=validators.ge(0))
    after: float = attrs.field(default=0.0, validator=validators.ge(0))

    def _settled(self, times: NDArray[np.float64]) -> int:
        """Return the index of the first sample that counts.

        Raises:
            ConfigurationError: No sample counts, because the simulator ignores ``Record.until``.
        """
        first = int(np.searchsorted(times * (1 + _ROUNDING), self.after))
        if first == len(times):
            raise ConfigurationError(
                f"expected a sample at objective.after = {self.after} s or later, but the last sample is at "
                f"{times[-1]} s; decrease objective.after or simulate for longer"
            )
        return first


@attrs.frozen
class Travel(_Settled):
    """Distance that the center of mass travels from the first sample that counts to the last, in meters.

    With ``along = "xy"``, *every* = 0, and *after* at the start of the actuation, this is evosoro's measure
    of locomotion (docs/physics.md, section 11), in meters instead of voxels and without the height.

    Attributes:
        along: ``xy`` is the horizontal distance, never negative; ``x``, ``-x``, ``y`` and ``-y`` are
            directions, and travel in the opposite direction is negative.
    """

    along: Literal["xy", "x", "-x", "y", "-y"] = "xy"

    @property
    def record(self) -> Record:
        """The center of mass until the end of the simulation."""
        return Record(tracks=("body",), every=self.every, until=self.after)

    def window(self, times: NDArray[np.float64]) -> tuple[float, float]:
        """Return the times of the first sample that counts and of the last one.

        Raises:
            ConfigurationError: As for :meth:`score`.
        """
        return float(times[self._settled(times)]), float(times[-1])

    def score(self, outcome: Outcome) -> float:
        """Return the distance.

        Raises:
            ConfigurationError: The simulation ends before *after*.
        """
        body = outcome.tracks["body"]
        x, y, _ = map(float, body[-1] - body[self._settled(outcome.times)])
        return {"xy": math.hypot(x, y), "x": x, "-x": -x, "y": y, "-y": -y}[self.along]


@attrs.frozen
class FacePeak(_Settled):
    """Largest distance of the center of the free face from its rest position in the yz plane, in meters.

    The score is the maximum over all samples that count, and never negative; the preset ``bending`` uses it
    (docs/experiment.md).
    """

    @property
    def record(self) -> Record:
        """The free face, from before the first step until the end of the simulation."""
        return Record(tracks=("face",), every=self.every, initial=True, until=self.after)

    def score(self, outcome: Outcome) -> float:
        """Return the largest distance.

        Raises:
            ConfigurationError: The simulation ends before *after*.
        """
        face = outcome.tracks["face"]
        _, y, z = (face[self._settled(outcome.times) :] - face[0]).T
        return float(np.hypot(y, z).max())
