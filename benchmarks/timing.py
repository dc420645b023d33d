"""Timing: medians over rounds, each of which executes all compared actions once."""

from __future__ import annotations

import math
import statistics
import time
from collections.abc import Callable, Mapping
from typing import TypeAlias, TypeVar

import attrs

from benchmarks.pairs import alternated

__all__ = ["FULL", "QUICK", "Action", "Clock", "Effort", "cores_used", "interleaved", "timed"]

K = TypeVar("K")

Action: TypeAlias = Callable[[], object]
Clock: TypeAlias = Callable[[], float]


@attrs.frozen
class Effort:
    """The extent of a measurement.

    Attributes:
        rounds: Number of rounds for each median.
        shortest: Minimum duration of an action in a round, s; shorter actions are repeated.
        designs: Number of random bodies, networks and the like.
        generations: Number of generations of a population that evolves alone.
        run: Settings that make whole runs shorter.
        run_rounds: Number of rounds of whole runs.
        command_rounds: Number of rounds of commands of two commits.
    """

    rounds: int
    shortest: float
    designs: int
    generations: int
    run: tuple[str, ...]
    run_rounds: int
    command_rounds: int


FULL = Effort(rounds=9, shortest=0.02, designs=25, generations=200, run=(), run_rounds=2, command_rounds=5)

QUICK = Effort(
    rounds=3,
    shortest=0.0,
    designs=4,
    generations=10,
    run=("run.generations=2", "populations.morphology.size=10", "populations.controller.size=10"),
    run_rounds=1,
    command_rounds=1,
)


def interleaved(
    actions: Mapping[K, Action], effort: Effort, clock: Clock = time.thread_time
) -> dict[K, float]:
    """Return the median time of each action, s.

    Each action is executed once to warm up, and then once per round (or as often as the minimum duration
    requires). Actions are interleaved, so that a temporary load on the machine affects all of them.

    Args:
        actions: The actions to compare.
        effort: Number of rounds, and minimum duration of each action.
        clock: CPU time of this thread, or wall clock for actions that use several threads.
    """
    measures = {key: timed(action, effort, clock) for key, action in actions.items()}
    taken = alternated(measures, effort.rounds)
    return {key: statistics.median(values) for key, values in taken.items()}


def timed(action: Action, effort: Effort, clock: Clock = time.thread_time) -> Clock:
    """Return a measurement of the mean time of an action, s, which was executed to warm up."""
    times = _repetitions(action, effort.shortest, clock)
    return lambda: _mean(action, times, clock)


def cores_used(action: Action) -> float:
    """Return the ratio of CPU time of this process to wall clock during an action."""
    began, cpu_began = time.perf_counter(), time.process_time()
    action()
    return (time.process_time() - cpu_began) / (time.perf_counter() - began)


def _repetitions(action: Action, shortest: float, clock: Clock) -> int:
    _mean(action, 1, clock)
    once = _mean(action, 1, clock)
    return max(1, math.ceil(shortest / once)) if once > 0.0 else 1


def _mean(action: Action, times: int, clock: Clock) -> float:
    started = clock()
    for _ in range(times):
        action()
    return (clock() - started) / times
