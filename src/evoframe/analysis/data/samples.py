"""Samples of the champion's trace that the objective compares."""

from __future__ import annotations

import attrs
import numpy as np

from evoframe.contract import Design, Objective, Simulator

__all__ = ["Sample", "samples_of"]


@attrs.frozen
class Sample:
    """A sample of a track.

    Attributes:
        name: Label, such as ``sample 5``.
        time: Simulated time, s.
        position: Position of the track, m.
    """

    name: str
    time: float
    position: tuple[float, float, float]


def samples_of(simulator: Simulator, objective: Objective, design: Design, track: str) -> tuple[Sample, ...]:
    """Return the samples of *track* that the objective selects; none if its record keeps all samples."""
    record = objective.record
    if record.samples is None:
        return ()
    [outcome] = simulator.simulate([design], record)
    names = [*["start"] * record.initial, *(f"sample {index}" for index in record.samples)]
    found = zip(names, outcome.times.tolist(), outcome.tracks[track], strict=False)  # fewer if it diverged
    return tuple(
        Sample(name, time, (float(at[0]), float(at[1]), float(at[2])))
        for name, time, at in found
        if np.isfinite(at).all()
    )
