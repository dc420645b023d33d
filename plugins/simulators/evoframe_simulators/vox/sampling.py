"""Selection of the steps at which a simulation is sampled."""

from __future__ import annotations

import math
from collections.abc import Sequence

import attrs
import numpy as np
from numpy.typing import NDArray

from evoframe import ConfigurationError, Record
from evoframe_simulators.vox.limits import MOST_STEPS

__all__ = ["Clock", "check_samples"]

_ROUNDING = 1e-12  # relative; tolerance for intervals that are multiples of the time step


@attrs.frozen
class Clock:
    """The time of a body's simulation.

    Samples are counted in nominal steps, each of which consists of ``substeps`` solver steps, so that the
    number of substeps does not change the sampled instants.

    Attributes:
        time_step: Time step of the solver, s.
        total: Number of solver steps, a multiple of ``substeps``.
        substeps: Number of solver steps in a nominal step.
    """

    time_step: float
    total: int
    substeps: int = 1

    @property
    def steps(self) -> int:
        """Number of nominal steps."""
        return self.total // self.substeps

    def nominal(self, record: Record) -> NDArray[np.int64]:
        """Return the nominal steps after which a simulation is sampled (docs/physics.md, section 11).

        Args:
            record: The requested record; all its samples must exist.

        Returns:
            Steps in ascending order, ``int64[samples]``; 0 is the state before the first step.
        """
        stride = self._stride(record.every)
        if record.samples is None:
            kept = np.arange(1, self.steps + 1, stride, dtype=np.int64)
        else:
            kept = 1 + stride * np.array(record.samples, dtype=np.int64)
        return np.insert(kept, 0, 0) if record.initial else kept

    def samples(self, record: Record) -> NDArray[np.int64]:
        """Return the solver steps after which a simulation is sampled, ``int64[samples]``, read-only."""
        steps = self.nominal(record) * self.substeps
        steps.setflags(write=False)  # bodies with the same clock share them
        return steps

    def count(self, every: float) -> int:
        """Return the number of samples, excluding the state before the first step."""
        return 1 + (self.steps - 1) // self._stride(every)

    def last(self, record: Record) -> float:
        """Return the time of a record's last sample, s; 0 without samples."""
        index = self.count(record.every) - 1 if record.samples is None else max(record.samples, default=-1)
        if index < 0:
            return 0.0
        return (1 + self._stride(record.every) * index) * self.substeps * self.time_step

    def _stride(self, every: float) -> int:
        """Return the number of nominal steps between samples: the fewest that take *every* seconds."""
        steps = every / (self.time_step * self.substeps)
        return max(1, math.ceil(min(steps * (1 - _ROUNDING), MOST_STEPS)))


def check_samples(record: Record, clocks: Sequence[Clock], duration: float) -> None:
    """Reject a record with a sample that some body never reaches, or that ends before ``record.until``.

    Args:
        record: The requested record.
        clocks: All clocks that bodies can have.
        duration: Simulated time, s.

    Raises:
        ConfigurationError: The simulation is too short for the record.
    """
    if record.samples:
        last = max(record.samples)
        taken, steps = min((clock.count(record.every), clock.steps) for clock in clocks)
        if last >= taken:
            raise ConfigurationError(
                f"sample {last} (one every {record.every} s) does not exist: simulator.duration = {duration} "
                f"s has {steps} steps, with samples 0 to {taken - 1}; increase simulator.duration, or select "
                "earlier or more frequent samples"
            )
    reached = min(clock.last(record) for clock in clocks)
    if reached < record.until * (1 - _ROUNDING):
        raise ConfigurationError(
            f"the last sample is at {reached:.6g} s, expected at least {record.until} s; "
            f"increase simulator.duration = {duration} s, or select later samples"
        )
