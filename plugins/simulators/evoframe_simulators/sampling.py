"""Which steps are sampled."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from evoframe import Record

__all__ = ["sample_steps"]


def sample_steps(time_step: float, steps: int, record: Record) -> NDArray[np.int64]:
    """Return the steps after which a simulation is sampled (physics.md, section 11).

    Args:
        time_step: s.
        steps: How many steps the simulation makes.
        record: What is asked for.

    Returns:
        Ascending step numbers, ``int64[samples]``; 0 is the state before the first step.
    """
    taken: list[int] = []
    time, due = 0.0, 0.0
    for step in range(1, steps + 1):
        time += time_step
        if not taken or time - due >= record.every:
            taken.append(step)
            due = time
    kept = taken if record.samples is None else [taken[index] for index in record.samples]
    return np.array([0, *kept] if record.initial else kept, dtype=np.int64)
