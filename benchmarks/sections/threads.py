"""Parallel simulation in threads."""

from __future__ import annotations

import time
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor

from benchmarks.machine import cores
from benchmarks.report import Row, Section, Table
from benchmarks.subjects import evaluating, random_designs, vox
from benchmarks.timing import Action, Effort, cores_used, interleaved
from evoframe import Design

__all__ = ["threads"]

_CONTROLLERS = 8
_SIZES = (1, 4, 8)
_THREADS = (1, 2)


def threads(effort: Effort) -> Section:
    """Time the same batches on one thread and on two."""
    bodies = random_designs(effort.designs, _CONTROLLERS)
    count = len(bodies) * _CONTROLLERS
    pools = {number: ThreadPoolExecutor(number) for number in _THREADS}
    actions = {
        (size, number): _spread(pool, _batches(bodies, size))
        for size in _SIZES
        for number, pool in pools.items()
    }
    taken = interleaved(actions, effort, time.perf_counter)
    used = {size: cores_used(actions[size, 2]) for size in _SIZES}
    for pool in pools.values():
        pool.shutdown()
    rows: list[Row] = [
        (
            f"batches of {size}",
            *(count / taken[size, number] for number in _THREADS),
            taken[size, 1] / taken[size, 2],
            used[size],
        )
        for size in _SIZES
    ]
    table = Table(
        f"Evaluations per second: {len(bodies)} random bodies with {_CONTROLLERS} controllers each",
        ("", "1 thread, 1/s", "2 threads, 1/s", "2 threads / 1", "cores used by 2"),
        rows,
        f"Wall clock, on {cores()} cores. The controllers of a batch have the same body. Only simulation and "
        "scoring; goal 1.7. If two threads use much less than two cores, other processes used the rest, and "
        "the ratio is not reliable.",
    )
    return Section("batches on one thread and on two", (table,))


def _batches(bodies: Sequence[Sequence[Design]], size: int) -> list[Sequence[Design]]:
    return [designs[at : at + size] for designs in bodies for at in range(0, len(designs), size)]


def _spread(pool: ThreadPoolExecutor, batches: Sequence[Sequence[Design]]) -> Action:
    actions = [evaluating(vox(), batch) for batch in batches]
    return lambda: list(pool.map(_call, actions))


def _call(action: Action) -> object:
    return action()
