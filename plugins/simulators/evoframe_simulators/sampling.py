"""Which steps are sampled."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from evoframe import Record

__all__ = ["count_samples", "sample_steps"]

_ROUNDING = 1e-12  # relative; an interval that is a multiple of the time step is met, not missed
_MOST_STEPS = 2**53  # of any simulation


def sample_steps(time_step: float, steps: int, record: Record) -> NDArray[np.int64]:
    """Return the steps after which a simulation is sampled (physics.md, section 11).

    Args:
        time_step: s.
        steps: How many steps the simulation makes.
        record: What is asked for; its samples must be among those that are taken.

    Returns:
        Ascending step numbers, ``int64[samples]``; 0 is the state before the first step.
    """
    stride = _stride(time_step, record.every)
    if record.samples is None:
        kept = np.arange(1, steps + 1, stride, dtype=np.int64)
    else:
        kept = 1 + stride * np.array(record.samples, dtype=np.int64)
    return np.insert(kept, 0, 0) if record.initial else kept


def count_samples(time_step: float, steps: int, every: float) -> int:
    """Return how many samples are taken, that of the state before the first step not counted."""
    return 1 + (steps - 1) // _stride(time_step, every)


def _stride(time_step: float, every: float) -> int:
    """Return the steps from a sample to the next, the first that ends at least *every* seconds later."""
    return max(1, math.ceil(min(every / time_step * (1 - _ROUNDING), _MOST_STEPS)))
