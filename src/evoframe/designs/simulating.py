"""Simulation of designs given by the user: their scores, and positions of points after every step."""

from __future__ import annotations

from collections.abc import Iterator

from evoframe.contract import Design, Record, Score, Simulator
from evoframe.designs.sources import Job, naming
from evoframe.evolution import evaluator_of

__all__ = ["simulate_job", "trace_of"]


def simulate_job(job: Job) -> list[Score]:
    """Return the score of each design of a job.

    Raises:
        InputError: The simulator cannot simulate a design.
        RunError: The simulator or the objective fails.
    """
    evaluator = evaluator_of(job.config)
    try:
        with naming(job.path):
            return evaluator.evaluate(job.designs, len(job.designs))
    finally:
        evaluator.close()


def trace_of(simulator: Simulator, design: Design) -> Iterator[list[str]]:
    """Yield the positions of a design's points: a header, a row for the initial state, a row per step.

    Columns are ``step``, ``time`` (s) and ``NAME_x``, ``NAME_y``, ``NAME_z`` (m) for each point that the
    simulator tracks; numbers are exact to the last bit.
    """
    record = Record(tracks=simulator.tracks, initial=True)
    [outcome] = simulator.simulate([design], record)
    steps, times = outcome.steps.tolist(), outcome.times.tolist()
    points = [name for name in record.tracks if outcome.tracks[name].shape == (len(steps), 3)]
    yield ["step", "time", *(f"{name}_{axis}" for name in points for axis in "xyz")]
    for row, (step, time) in enumerate(zip(steps, times, strict=True)):
        positions = [value for name in points for value in outcome.tracks[name][row].tolist()]
        yield [str(step), repr(time), *map(repr, positions)]
