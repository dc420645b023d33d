"""Speed of networks compared with those of neat-python."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import neat
import numpy as np
from neat.activations import ActivationFunctionSet
from numpy.typing import NDArray

from benchmarks.report import Row, Section, SectionError, Table
from benchmarks.timing import Action, Effort, interleaved
from evoframe_evolvers import RandomSearch
from evoframe_evolvers.cppn.genomes import NO_SELECTION, GenePool
from evoframe_evolvers.random_search import RandomSearchRun
from evoframe_libcppn import ACTIVATIONS, CppnNetwork

__all__ = ["networks"]

_SEED = 1
_ENDS = {"morphology": (3, 2), "controller": (4, 1)}
_GRID = (12, 6, 6)  # 432 points
_MUTATIONS = (0, 20)
_SHARED = tuple(name for name in ACTIVATIONS if ActivationFunctionSet().is_valid(name))


def networks(effort: Effort) -> Section:
    """Time random genomes of both populations, initial ones and ones with hidden nodes."""
    rows: list[Row] = [
        row for role in _ENDS for mutations in _MUTATIONS for row in [_measured(role, mutations, effort)]
    ]
    table = Table(
        f"Networks at {np.prod(_GRID)} points, us per network",
        ("genomes", "nodes", "compiled once", "evaluated", "neat-python", "times neat-python"),
        rows,
        f"The same {effort.designs} genomes, with activations that both support, and with equal outputs. "
        "neat-python's FeedForwardNetwork evaluates one point at a time, and is created beforehand too; "
        "compiling is the cost of a genome in evoframe before its first point. CPU time.",
    )
    return Section("CPPNs against those of neat-python", (table,))


def _measured(role: str, mutations: int, effort: Effort) -> tuple[str | float, ...]:
    inputs, outputs = _ENDS[role]
    pool = GenePool(
        RandomSearch(activations=_SHARED), NO_SELECTION, inputs, outputs, np.random.default_rng(_SEED)
    )
    genomes = RandomSearchRun(pool, effort.designs, mutations).ask()
    points = _points(inputs)
    compiled = [pool.express(genome) for genome in genomes]
    reference = [neat.nn.FeedForwardNetwork.create(genome, pool.config) for genome in genomes]
    _compare(compiled, reference, points)
    actions: dict[str, Action] = {
        "compiled": lambda: [pool.express(genome) for genome in genomes],
        "evaluated": lambda: [network(points) for network in compiled],
        "neat-python": lambda: [_activated(network, points) for network in reference],
    }
    taken = {name: 1e6 * time / len(genomes) for name, time in interleaved(actions, effort).items()}
    return (
        f"{role}, {f'up to {mutations} mutations' if mutations else 'initial'}",
        float(np.mean([len(genome.nodes) for genome in genomes])),
        taken["compiled"],
        taken["evaluated"],
        taken["neat-python"],
        taken["neat-python"] / taken["evaluated"],
    )


def _points(inputs: int) -> NDArray[np.float64]:
    """Return indices of voxels and, for a controller, the code of their material."""
    grid = np.stack(np.meshgrid(*(np.arange(n, dtype=np.float64) for n in _GRID), indexing="ij"), axis=-1)
    points = grid.reshape(-1, 3)
    return np.hstack([points, np.full((len(points), inputs - 3), 3.0)])


def _activated(network: Any, points: NDArray[np.float64]) -> list[list[float]]:
    return [network.activate(point) for point in points.tolist()]


def _compare(compiled: Sequence[CppnNetwork], reference: Sequence[Any], points: NDArray[np.float64]) -> None:
    for network, other in zip(compiled, reference, strict=True):
        if not np.allclose(network(points), _activated(other, points), rtol=1e-9, atol=1e-9):
            raise SectionError("outputs differ from those of neat-python, so the times are not comparable")
