"""Designs in, scores out: what was simulated before is not simulated again."""

from __future__ import annotations

import math
import numbers
from collections.abc import Sequence

import attrs

from evoframe.errors import RunError
from evoframe.protocols import ExecutorRun, Objective, Simulator
from evoframe.values import Design, Record

__all__ = ["Evaluator", "Score", "simulated"]

_BATCHES_PER_WORKER = 4  # small enough to balance bodies of different cost


@attrs.frozen
class Score:
    """What a design scored.

    Attributes:
        value: In the objective's unit; ``None`` if the simulation diverged.
        diverged_at: The step at which it diverged, or ``None``.
    """

    value: float | None
    diverged_at: int | None = None


@attrs.define
class Evaluator:
    """Scores designs with a simulator and an objective.

    Attributes:
        simulator: Simulates what is new.
        objective: Says what to record, and scores it.
        workers: Work on batches at the same time.
        simulations: How many designs were simulated so far.
    """

    simulator: Simulator
    objective: Objective
    workers: ExecutorRun
    simulations: int = 0
    _cache: dict[bytes, Score] = attrs.field(factory=dict, init=False, repr=False)

    def evaluate(self, designs: Sequence[Design]) -> list[Score]:
        """Return the score of each design; equal designs, now or earlier, are simulated once.

        Raises:
            RunError: The objective gave a score that is not finite for a simulation that did not diverge.
        """
        record = self.objective.record
        keys = [self.simulator.key(design, record) for design in designs]
        new = {key: design for key, design in zip(keys, designs, strict=True) if key not in self._cache}
        scores = self.workers.map(self._simulate, self._batches(list(new.values())))
        self._cache.update(zip(new, (score for batch in scores for score in batch), strict=True))
        self.simulations += len(new)
        return [self._cache[key] for key in keys]

    def close(self) -> None:
        """Let the workers go."""
        self.workers.close()

    def _batches(self, designs: list[Design]) -> list[list[Design]]:
        size = max(1, math.ceil(len(designs) / (_BATCHES_PER_WORKER * self.workers.workers)))
        return [designs[start : start + size] for start in range(0, len(designs), size)]

    def _simulate(self, designs: list[Design]) -> list[Score]:
        return simulated(self.simulator, designs, self.objective.record, self.objective)


def simulated(
    simulator: Simulator, designs: Sequence[Design], record: Record, objective: Objective
) -> list[Score]:
    """Simulate *designs* and return what *objective* gives for each, without looking for repeats.

    Raises:
        RunError: A design has no outcome, or a score that is not finite though it did not diverge.
    """
    outcomes = simulator.simulate(designs, record)
    if len(outcomes) != len(designs):
        raise RunError(f"the simulator returned {len(outcomes)} outcomes for {len(designs)} designs")
    return [
        Score(None, outcome.diverged_at)
        if outcome.diverged_at is not None
        else Score(_finite(objective.score(outcome)))
        for outcome in outcomes
    ]


def _finite(score: float) -> float:
    if not isinstance(score, numbers.Real) or not math.isfinite(score):
        raise RunError(f"the objective gave the score {score!r} for a simulation that did not diverge")
    return float(score)
