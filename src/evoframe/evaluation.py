"""Designs in, scores out: what was simulated before is not simulated again."""

from __future__ import annotations

import math
import numbers
from collections.abc import Iterable, Iterator, Mapping, Sequence

import attrs

from evoframe.errors import RunError
from evoframe.protocols import ExecutorRun, Objective, Simulator
from evoframe.values import Design, Record

__all__ = ["Evaluator", "Score", "simulated"]

_LARGEST_BATCH = 4  # as many share the cost of a call, and what the solver prepares for their common body
_BATCHES_PER_WORKER = 2  # of what is left: the last ones are small, so that all workers end together


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

    def evaluate(self, designs: Iterable[Design], count: int) -> list[Score]:
        """Return the score of each design; equal designs, now or earlier, are simulated once.

        Args:
            designs: Are asked for one after the other, while those before are simulated.
            count: How many there are.

        Raises:
            RunError: The objective gave a score that is not finite for a simulation that did not diverge.
        """
        keys: list[bytes] = []
        for scores in self.workers.map(self._simulate, self._batches(designs, count, keys)):
            self._cache |= scores
            self.simulations += len(scores)
        return [self._cache[key] for key in keys]

    def close(self) -> None:
        """Let the workers go."""
        self.workers.close()

    def _batches(
        self, designs: Iterable[Design], count: int, keys: list[bytes]
    ) -> Iterator[dict[bytes, Design]]:
        """Yield what has to be simulated, in batches, and note the key of every design in *keys*."""
        record = self.objective.record
        known: set[bytes] = set()
        batch: dict[bytes, Design] = {}
        for design in designs:
            keys.append(key := self.simulator.key(design, record))
            if key not in known and key not in self._cache:
                known.add(key)
                batch[key] = design
            if len(batch) >= self._batch_size(count - len(keys)):
                yield batch
                batch = {}
        if batch:
            yield batch

    def _batch_size(self, left: int) -> int:
        return min(max(1, left // (_BATCHES_PER_WORKER * self.workers.workers)), _LARGEST_BATCH)

    def _simulate(self, batch: Mapping[bytes, Design]) -> dict[bytes, Score]:
        designs = list(batch.values())
        scores = simulated(self.simulator, designs, self.objective.record, self.objective)
        return dict(zip(batch, scores, strict=True))


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
