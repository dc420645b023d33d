"""CPU time of NEAT itself."""

from __future__ import annotations

import time

import neat
import numpy as np

import evoframe
from benchmarks.report import Section, Table
from benchmarks.stages import Stages, Watched
from benchmarks.timing import Effort
from evoframe import EvolverRun

__all__ = ["evolution"]

_SEED = 1


def evolution(effort: Effort) -> Section:
    """Time the evolution of both populations of the preset ``paper`` with random fitness."""
    rows = tuple(row for role in ("morphology", "controller") for row in _measured(role, effort.generations))
    table = Table(
        f"ms per generation of 25 genomes, mean of {effort.generations}",
        ("stage", "ms", "share"),
        rows,
        "The fitness is random, the setting that of paper. CPU time; for its share of a run, see the section "
        "runs.",
    )
    return Section("reproduction and speciation of a single population", (table,))


def _measured(role: str, generations: int) -> list[tuple[str, float, float]]:
    config = evoframe.load_config("paper").populations[role]
    encoder, rng = config.encoder.component, np.random.default_rng(_SEED)
    evolver = config.evolver.component.start(encoder.inputs, encoder.outputs, config.size, rng)
    stages = Stages()
    methods: list[Watched] = [
        (type(evolver), "ask", "reproduction"),
        (neat.DefaultSpeciesSet, "speciate", "speciation"),
        (type(evolver), "express", "compiling networks"),
        (type(evolver), "state", "state for the record"),
    ]
    began = time.thread_time()
    with stages.watch(methods):
        for _ in range(generations + 1):
            _generation(evolver, rng)
    whole = time.thread_time() - began
    return [(f"{role}: {stage}", 1e3 * cpu / generations, cpu / whole) for stage, cpu in stages.cpu.items()]


def _generation(evolver: EvolverRun, rng: np.random.Generator) -> None:
    genomes = evolver.ask()
    for genome in genomes:
        evolver.express(genome)
    evolver.tell(rng.random(len(genomes)), {})
    evolver.state()
