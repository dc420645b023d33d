"""Which steps are sampled."""

from __future__ import annotations

import math
from collections.abc import Sequence

import attrs
import numpy as np
from numpy.typing import NDArray

from evoframe import ConfigurationError, Record
from evoframe_simulators.vox.limits import MOST_STEPS

__all__ = ["Clock", "check_samples"]

_ROUNDING = 1e-12  # relative; an interval that is a multiple of the time step is met, not missed


@attrs.frozen
class Clock:
    """The time of a body's simulation.

    Samples are counted in nominal steps, which the solver makes in ``substeps`` steps each, so that they fall
    at the same instants however many there are.

    Attributes:
        time_step: Of the solver, s.
        total: How many steps the solver makes, a multiple of ``substeps``.
        substeps: Steps of the solver in a nominal one.
    """

    time_step: float
    total: int
    substeps: int = 1

    @property
    def steps(self) -> int:
        """How many nominal steps there are."""
        return self.total // self.substeps

    def nominal(self, record: Record) -> NDArray[np.int64]:
        """Return the nominal steps after which a simulation is sampled (physics.md, section 11).

        Args:
            record: What is asked for; its samples must be among those that are taken.

        Returns:
            Ascending, ``int64[samples]``; 0 is the state before the first step.
        """
        stride = self._stride(record.every)
        if record.samples is None:
            kept = np.arange(1, self.steps + 1, stride, dtype=np.int64)
        else:
            kept = 1 + stride * np.array(record.samples, dtype=np.int64)
        return np.insert(kept, 0, 0) if record.initial else kept

    def samples(self, record: Record) -> NDArray[np.int64]:
        """Return the solver's steps after which a simulation is sampled, ``int64[samples]``, read-only."""
        steps = self.nominal(record) * self.substeps
        steps.setflags(write=False)  # bodies with the same clock share them
        return steps

    def count(self, every: float) -> int:
        """Return how many samples are taken, that of the state before the first step not counted."""
        return 1 + (self.steps - 1) // self._stride(every)

    def last(self, record: Record) -> float:
        """Return the time of a record's last sample, s; 0 without one."""
        index = self.count(record.every) - 1 if record.samples is None else max(record.samples, default=-1)
        if index < 0:
            return 0.0
        return (1 + self._stride(record.every) * index) * self.substeps * self.time_step

    def _stride(self, every: float) -> int:
        """Return the nominal steps from a sample to the next, the first that ends *every* seconds later."""
        steps = every / (self.time_step * self.substeps)
        return max(1, math.ceil(min(steps * (1 - _ROUNDING), MOST_STEPS)))


def check_samples(record: Record, clocks: Sequence[Clock], duration: float) -> None:
    """Refuse a record with a sample that some body never has, or that ends before it may.

    Args:
        record: What is asked for.
        clocks: All that bodies can have.
        duration: Simulated time, s.

    Raises:
        ConfigurationError: Says what there is.
    """
    if record.samples:
        last = max(record.samples)
        taken, steps = min((clock.count(record.every), clock.steps) for clock in clocks)
        if last >= taken:
            raise ConfigurationError(
                f"sample {last} of one every {record.every} s is never taken: vox makes "
                f"{steps} steps in simulator.duration = {duration} s, samples 0 to {taken - 1}; simulate "
                "longer, or set an objective that looks earlier or more often"
            )
    reached = min(clock.last(record) for clock in clocks)
    if reached < record.until * (1 - _ROUNDING):
        raise ConfigurationError(
            f"the last sample is taken at {reached:.6g} s, but {record.until} s must be reached: "
            f"simulator.duration = {duration} s, and the samples of the objective, must go on as long"
        )
