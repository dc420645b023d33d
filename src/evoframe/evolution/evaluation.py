"""Designs in, scores out: what was simulated before is not simulated again."""

from __future__ import annotations

import contextlib
import math
import numbers
from collections.abc import Iterable, Iterator, Mapping, Sequence

import attrs
import numpy as np

from evoframe.contract import Design, ExecutorRun, Objective, Outcome, Record, Score, Simulator, blaming
from evoframe.errors import ComponentError, WorkerError

__all__ = ["Evaluator", "score_designs"]

_LARGEST_BATCH = 4  # as many share the cost of a call, and what the solver prepares for their common body
_BATCHES_PER_WORKER = 2  # of what is left: the last ones are small, so that all workers end together


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
            ComponentError: A component failed, or returned what it must not.
        """
        keys: list[bytes] = []
        with blaming("executor"), _finding_places(keys):
            simulation = _Simulation(self.simulator, self.objective)
            for scores in self.workers.map(simulation, self._batches(designs, count, keys)):
                self._cache |= scores
                self.simulations += len(scores)
        if any(key not in self._cache for key in keys):
            raise ComponentError("executor", "did not return the results of all batches")
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
            keys.append(key := self._key(design, record))
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

    def _key(self, design: Design, record: Record) -> bytes:
        with blaming("simulator"):
            key = self.simulator.key(design, record)
        if not isinstance(key, bytes):
            raise ComponentError("simulator", f"gave a key that is no bytes, but {type(key).__name__}")
        return key


@contextlib.contextmanager
def _finding_places(keys: Sequence[bytes]) -> Iterator[None]:
    """Say where the designs of a failed batch stand among all whose *keys* are given."""
    try:
        yield
    except WorkerError as lost:
        raise ComponentError("simulator", lost.problem, places=_places(lost.item, keys)) from lost
    except ComponentError as error:
        raise attrs.evolve(error, places=_places(error.keys, keys)) from error


def _places(batch: Iterable[bytes], keys: Sequence[bytes]) -> tuple[int, ...]:
    return tuple(keys.index(key) for key in batch if key in keys)


@attrs.frozen
class _Simulation:
    """What a worker does with a batch, and no more, since it may travel to another process."""

    simulator: Simulator
    objective: Objective

    def __call__(self, batch: Mapping[bytes, Design]) -> dict[bytes, Score]:
        try:
            scores = score_designs(
                self.simulator, list(batch.values()), self.objective.record, self.objective
            )
        except ComponentError as error:
            raise attrs.evolve(error, keys=tuple(batch)) from error
        return dict(zip(batch, scores, strict=True))


def score_designs(
    simulator: Simulator, designs: Sequence[Design], record: Record, objective: Objective
) -> list[Score]:
    """Simulate *designs* and return what *objective* gives for each, without looking for repeats.

    Raises:
        ComponentError: Simulator or objective failed, or returned what they must not.
    """
    with blaming("simulator"):
        outcomes = list(simulator.simulate(designs, record))
    if len(outcomes) != len(designs):
        raise ComponentError("simulator", f"returned {len(outcomes)} outcomes for {len(designs)} designs")
    return [_score(outcome, record, objective) for outcome in outcomes]


def _score(outcome: Outcome, record: Record, objective: Objective) -> Score:
    if not isinstance(outcome, Outcome):
        raise ComponentError("simulator", f"returned no Outcome, but {type(outcome).__name__}")
    if outcome.diverged_at is not None:
        if not isinstance(outcome.diverged_at, numbers.Integral):
            raise ComponentError("simulator", f"says that it diverged at step {outcome.diverged_at!r}")
        return Score(None, int(outcome.diverged_at))
    _refuse_tracks(outcome, record)
    with blaming("objective"):
        score = objective.score(outcome)
    if not isinstance(score, numbers.Real) or not math.isfinite(score):
        problem = f"gave the score {score!r} for a simulation that did not diverge"
        raise ComponentError("objective", problem)
    return Score(float(score))


def _refuse_tracks(outcome: Outcome, record: Record) -> None:
    """Refuse tracks that are not what was asked for."""
    for name in record.tracks:
        track = outcome.tracks.get(name)
        if not isinstance(track, np.ndarray):
            raise ComponentError("simulator", f"returned no array for the track '{name}'")
        if len(track) != len(outcome.steps):
            counts = f"{len(track)} samples of the track '{name}' for {len(outcome.steps)} steps"
            raise ComponentError("simulator", f"returned {counts}")
        if not np.isfinite(track).all():
            problem = f"returned numbers that are not finite in the track '{name}', but had not diverged"
            raise ComponentError("simulator", problem)
