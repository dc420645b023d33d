"""Simulation of designs given by the user: their scores, and positions of points after every step."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import attrs

from evoframe.contract import (
    Design,
    Outcome,
    Record,
    RunConfig,
    Score,
    Simulator,
    SupportsDuration,
    blaming,
    whole_of,
)
from evoframe.designs.sources import Job, naming
from evoframe.evolution import evaluator_of

__all__ = ["Overlooked", "overlooked", "simulate_job", "trace_of"]

_ROUNDING = 1e-9  # relative


def simulate_job(job: Job) -> list[Score]:
    """Return the score of each design of a job; without a value if the job has no scores.

    Raises:
        InputError: The simulator cannot simulate a design.
        RunError: The simulator or the objective fails.
    """
    config = job.config
    if job.unscored:
        whole = whole_of(config.simulator.component)
        config = attrs.evolve(
            config,
            simulator=attrs.evolve(config.simulator, component=whole),
            objective=attrs.evolve(config.objective, component=_Divergence(whole.tracks)),
        )
    evaluator = evaluator_of(config)
    try:
        with naming(job.path):
            scores = evaluator.evaluate(job.designs, len(job.designs))
    finally:
        evaluator.close()
    return [Score(None, score.diverged_at) for score in scores] if job.unscored else scores


@attrs.frozen
class _Divergence:
    """An objective for whole simulations without a score; it records one sample, which every one has."""

    tracks: tuple[str, ...]

    @property
    def record(self) -> Record:
        return Record(self.tracks[:1], samples=(0,))

    def score(self, _: Outcome) -> float:
        return 0.0


@attrs.frozen
class Overlooked:
    """The end of a simulation on which its score does not depend.

    Attributes:
        last: Last simulated time on which the score depends, s.
        end: End of the simulation, s.
    """

    last: float
    end: float

    def __str__(self) -> str:
        digits = next(n for n in range(2, 18) if f"{self.last:.{n}g}" != f"{self.end:.{n}g}")
        return f"looks at the first {self.last:.{digits}g} s of {self.end:.{digits}g} s"


def overlooked(config: RunConfig, designs: Sequence[Design], scores: Sequence[Score]) -> Overlooked | None:
    """Return the longest end of the simulations of some designs that their scores overlook.

    An end without another sample at the objective's interval is not overlooked. If the simulator does not
    know the end (:class:`SupportsDuration`), nothing is.

    Args:
        config: The configuration that scored the designs.
        designs: The designs.
        scores: Their scores.

    Returns:
        The longest such end; ``None`` if there is none.
    """
    simulator = config.simulator.component
    if not isinstance(simulator, SupportsDuration):
        return None
    interval = config.objective.component.record.every
    found = []
    for design, score in zip(designs, scores, strict=True):
        if score.window is not None:
            with blaming("simulator"):
                end = simulator.duration_of(design)
            left = end - score.window[1]
            if left >= interval * (1 - _ROUNDING) and left > end * _ROUNDING:
                found.append(Overlooked(score.window[1], end))
    return max(found, key=lambda each: each.end - each.last, default=None)


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
