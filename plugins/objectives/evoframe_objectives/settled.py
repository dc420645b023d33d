"""Motion over a whole simulation, measured once it has settled."""

from __future__ import annotations

import math
from typing import ClassVar, Literal

import attrs
import numpy as np
from attrs import validators

from evoframe import ConfigurationError, Outcome, Record

__all__ = ["FacePeak", "Travel"]

_ROUNDING = 1e-12  # relative; a sample that is meant to fall on a time is met, not missed


@attrs.frozen
class _Settled:
    """What objectives over a whole simulation share: how often it is sampled, and from when on.

    Attributes:
        every: Seconds between samples; 0 samples after every step.
        after: Seconds that the motion is given to settle: samples before this do not count.
    """

    unit: ClassVar[str] = "m"

    every: float = attrs.field(default=0.0, validator=validators.ge(0))
    after: float = attrs.field(default=0.0, validator=validators.ge(0))

    def _settled(self, outcome: Outcome) -> int:
        """Return the index of the first sample that counts.

        Raises:
            ConfigurationError: There is none, because the simulator does not heed ``Record.until``.
        """
        first = int(np.searchsorted(outcome.times * (1 + _ROUNDING), self.after))
        if first == len(outcome.times):
            raise ConfigurationError(
                f"no sample is taken at objective.after = {self.after} s or later: the last is at "
                f"{outcome.times[-1]} s; set a smaller objective.after, or simulate for longer"
            )
        return first


@attrs.frozen
class Travel(_Settled):
    """How far the centre of mass travels from the first sample that counts to the last, in metres.

    With ``along = "xy"``, *every* = 0 and *after* the time at which the actuation starts, this is the measure
    of evosoro's locomotion (physics.md, section 11), in metres instead of voxels and without the height.

    Attributes:
        along: ``xy`` is the horizontal distance, never negative; in a direction, what goes the other way is
            negative.
    """

    along: Literal["xy", "x", "-x", "y", "-y"] = "xy"

    @property
    def record(self) -> Record:
        """The centre of mass, to the end."""
        return Record(tracks=("body",), every=self.every, until=self.after)

    def score(self, outcome: Outcome) -> float:
        """Return the distance.

        Raises:
            ConfigurationError: The simulation ends before *after*.
        """
        body = outcome.tracks["body"]
        x, y, _ = map(float, body[-1] - body[self._settled(outcome)])
        return {"xy": math.hypot(x, y), "x": x, "-x": -x, "y": y, "-y": -y}[self.along]


@attrs.frozen
class FacePeak(_Settled):
    """How far the centre of the free face gets in the yz plane from where it is at rest, in metres.

    It is the largest distance over all samples that count, so never negative (paper.md, the preset
    ``bending``).
    """

    @property
    def record(self) -> Record:
        """The free face from before the first step to the end."""
        return Record(tracks=("face",), every=self.every, initial=True, until=self.after)

    def score(self, outcome: Outcome) -> float:
        """Return the largest distance.

        Raises:
            ConfigurationError: The simulation ends before *after*.
        """
        face = outcome.tracks["face"]
        _, y, z = (face[self._settled(outcome) :] - face[0]).T
        return float(np.hypot(y, z).max())
