"""Evaluation of designs: simulation, scoring, and a cache of scores."""

from __future__ import annotations

import contextlib
import math
import numbers
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from itertools import islice
from typing import TypeVar

import attrs
import numpy as np

from evoframe.contract import (
    Design,
    ExecutorRun,
    Objective,
    Outcome,
    Record,
    Score,
    Simulator,
    SupportsOutcomeMeasures,
    batch_size_of,
    blaming,
    window_of,
)
from evoframe.errors import ComponentError, WorkerError

__all__ = ["Evaluator", "score_designs"]

T = TypeVar("T")

_BATCH = 4  # designs, unless the simulator says otherwise; they share the overhead of a call
_BATCHES_PER_WORKER = 2  # can be taken before the first result: the current one, and the next


@attrs.define
class Evaluator:
    """Scores designs with a simulator and an objective.

    Attributes:
        simulator: Simulates new designs.
        objective: Defines the samples to record, and scores outcomes.
        workers: Started workers, which process batches in parallel.
        measures: Names of the measures by simulator and objective that scores contain.
        simulations: Number of designs simulated so far.
    """

    simulator: Simulator
    objective: Objective
    workers: ExecutorRun
    measures: tuple[str, ...] = ()
    simulations: int = 0
    _cache: dict[bytes, Score] = attrs.field(factory=dict, init=False, repr=False)

    def evaluate(
        self, designs: Iterable[Design], count: int, on_simulating: Callable[[], None] = lambda: None
    ) -> list[Score]:
        """Return the score of each design; equal designs are simulated once, across all calls.

        Args:
            designs: The designs, consumed one by one while earlier ones are simulated.
            count: Number of designs.
            on_simulating: Called once in this thread, when the workers have enough to simulate. If it
                raises, no further designs are simulated, and the exception propagates.

        Raises:
            ComponentError: A component failed or returned an invalid result.
        """
        keys: list[bytes] = []
        interlude = _Interlude(on_simulating)
        with blaming("executor"), _locating_designs(keys):
            simulation = _Simulation(self.simulator, self.objective, self.measures)
            batches = interlude.inserted(self._batches(designs, count, keys), self._batches_ahead)
            for scores in self.workers.map(simulation, batches):
                self._cache |= scores
                self.simulations += len(scores)
        interlude.check()
        if any(key not in self._cache for key in keys):
            raise ComponentError("executor", "did not return the results of all batches")
        return [self._cache[key] for key in keys]

    def close(self) -> None:
        """Shut down the workers."""
        self.workers.close()

    def _batches(
        self, designs: Iterable[Design], count: int, keys: list[bytes]
    ) -> Iterator[dict[bytes, Design]]:
        """Yield batches of the designs to simulate; append the key of every design to *keys*."""
        record = self.objective.record
        key_of: dict[Design, bytes] = {}  # designs are compared by identity
        known: set[bytes] = set()
        batch: dict[bytes, Design] = {}
        with blaming("simulator"):
            largest = batch_size_of(self.simulator, _BATCH)
        for design in designs:
            if design not in key_of:
                key_of[design] = self._key(design, record)
            keys.append(key := key_of[design])
            if key not in known and key not in self._cache:
                known.add(key)
                batch[key] = design
            if batch and len(batch) >= self._batch_size(count - len(keys), largest):
                yield batch
                batch = {}
        if batch:
            yield batch

    @property
    def _batches_ahead(self) -> int:
        """Number of batches that keep the other workers busy, and for which no executor waits for results."""
        workers = self.workers.workers
        return _BATCHES_PER_WORKER * workers - 1 if workers > 1 else 0

    def _batch_size(self, left: int, largest: int) -> int:
        """Return the size of the next batch: they shrink, so that all workers finish together."""
        return min(max(1, left // self.workers.workers), largest)

    def _key(self, design: Design, record: Record) -> bytes:
        with blaming("simulator"):
            key = self.simulator.key(design, record)
        if not isinstance(key, bytes):
            raise ComponentError("simulator", f"returned a key of type {type(key).__name__}, expected bytes")
        return key


@attrs.define
class _Interlude:
    """An action of the calling thread while the workers simulate; its exceptions are not the executor's."""

    _action: Callable[[], None]
    _error: BaseException | None = None

    def inserted(self, batches: Iterator[T], ahead: int) -> Iterator[T]:
        """Yield *batches*; act when *ahead* of them, or all, were taken."""
        yield from islice(batches, ahead)
        try:
            self._action()
        except (Exception, SystemExit) as error:  # noqa: BLE001 - raised by check()
            self._error = error
        else:
            yield from batches

    def check(self) -> None:
        """Raise the exception of the action, if any."""
        if self._error is not None:
            raise self._error


@contextlib.contextmanager
def _locating_designs(keys: Sequence[bytes]) -> Iterator[None]:
    """Add to an error the indices in *keys* of the designs of the failed batch."""
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
    """The processing of a batch in a worker; small, since it may be sent to another process."""

    simulator: Simulator
    objective: Objective
    measures: tuple[str, ...]

    def __call__(self, batch: Mapping[bytes, Design]) -> dict[bytes, Score]:
        try:
            scores = score_designs(
                self.simulator, list(batch.values()), self.objective.record, self.objective, self.measures
            )
        except ComponentError as error:
            raise attrs.evolve(error, keys=tuple(batch)) from error
        return dict(zip(batch, scores, strict=True))


def score_designs(
    simulator: Simulator,
    designs: Sequence[Design],
    record: Record,
    objective: Objective,
    measures: Collection[str] = (),
) -> list[Score]:
    """Simulate *designs* and return the score of each; repeated designs are simulated repeatedly.

    Args:
        simulator: Simulates the designs.
        designs: The designs.
        record: Samples to record.
        objective: Scores the outcomes.
        measures: Names of further measures by simulator and objective that the scores shall contain.

    Raises:
        ComponentError: Simulator or objective failed or returned an invalid result.
    """
    with blaming("simulator"):
        outcomes = list(simulator.simulate(designs, record))
    if len(outcomes) != len(designs):
        raise ComponentError("simulator", f"returned {len(outcomes)} outcomes for {len(designs)} designs")
    return [_score(outcome, record, objective, measures) for outcome in outcomes]


def _score(outcome: Outcome, record: Record, objective: Objective, measures: Collection[str]) -> Score:
    if not isinstance(outcome, Outcome):
        raise ComponentError("simulator", f"returned {type(outcome).__name__}, expected Outcome")
    if outcome.diverged_at is not None:
        if not isinstance(outcome.diverged_at, numbers.Integral):
            raise ComponentError(
                "simulator", f"returned diverged_at={outcome.diverged_at!r}, expected an integer or None"
            )
        return Score(None, int(outcome.diverged_at))
    _refuse_tracks(outcome, record)
    with blaming("objective"):
        score = objective.score(outcome)
        window = window_of(objective, outcome.times)
    if not isinstance(score, numbers.Real) or not math.isfinite(score):
        problem = f"returned the score {score!r}, expected a finite number"
        raise ComponentError("objective", problem)
    return Score(float(score), window=window, measures=_measures(outcome, objective, measures))


def _measures(outcome: Outcome, objective: Objective, names: Collection[str]) -> dict[str, float]:
    """Return the measures of an outcome with these names, each from the component that declares it."""
    if not names:
        return {}
    by_objective: Mapping[str, float] = {}
    declared: Collection[str] = ()
    if isinstance(objective, SupportsOutcomeMeasures):
        with blaming("objective"):
            by_objective, declared = objective.measure(outcome), objective.measures
    found: dict[str, float] = {}
    for name in names:
        key, supplied = ("objective", by_objective) if name in declared else ("simulator", outcome.measures)
        value = supplied.get(name)
        if not isinstance(value, numbers.Real) or not math.isfinite(value):
            problem = f"returned {value!r} for the measure '{name}', expected a finite number"
            raise ComponentError(key, problem)
        found[name] = float(value)
    return found


def _refuse_tracks(outcome: Outcome, record: Record) -> None:
    """Refuse tracks that do not match the record."""
    for name in record.tracks:
        track = outcome.tracks.get(name)
        if not isinstance(track, np.ndarray):
            raise ComponentError(
                "simulator", f"returned {type(track).__name__} for the track '{name}', expected an array"
            )
        if len(track) != len(outcome.steps):
            problem = f"returned {len(track)} samples of the track '{name}', expected {len(outcome.steps)}"
            raise ComponentError("simulator", problem)
        if not np.isfinite(track).all():
            problem = f"returned values that are not finite in the track '{name}', without a divergence"
            raise ComponentError("simulator", problem)
