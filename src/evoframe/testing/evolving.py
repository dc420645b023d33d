"""Runs of evolvers, as the laws of evolvers play them."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, ClassVar, TypeAlias

import numpy as np
from numpy.typing import NDArray

from evoframe.contract import Evolver, EvolverRun, wanted_by
from evoframe.testing.components import ComponentContract

__all__ = ["Evolving", "Floats", "dumped_all", "json_text"]

Floats: TypeAlias = NDArray[np.float64]


class Evolving(ComponentContract[Evolver]):
    """Base class of the laws of evolvers; :class:`EvolverContract` documents its attributes."""

    protocol = Evolver
    inputs: ClassVar[int] = 3
    outputs: ClassVar[int] = 2
    size: ClassVar[int] = 12
    turns: ClassVar[int] = 6

    def start(self, seed: int = 0) -> EvolverRun:
        """Start a run with a new generator."""
        rng = np.random.default_rng(seed)
        return self.component.start(self.inputs, self.outputs, self.size, rng)

    def judge(self, run: EvolverRun, genomes: Sequence[Any]) -> tuple[Floats, Mapping[str, Floats]]:
        """Return the fitness of *genomes* and the measures that the evolver wants, from their networks."""
        points = self._points(0, 1.0)
        outputs = [np.arctan(run.express(genome)(points)) for genome in genomes]
        fitness = np.array([output.mean() for output in outputs])
        spread = np.array([output.std() for output in outputs])
        return fitness, dict.fromkeys(wanted_by(self.component), spread)

    def _points(self, seed: int, scale: float) -> Floats:
        return scale * np.random.default_rng(seed).uniform(-1, 1, size=(16, self.inputs))

    def _play(self, run: EvolverRun) -> Iterator[tuple[EvolverRun, Sequence[Any]]]:
        """Evolve for all turns; yield the run and its genomes between ``ask`` and ``tell``."""
        for _ in range(self.turns):
            genomes = run.ask()
            yield run, genomes
            self._tell(run, genomes)

    def _turn(self, run: EvolverRun) -> str:
        return self._tell(run, run.ask())

    def _tell(self, run: EvolverRun, genomes: Sequence[Any]) -> str:
        """Pass the fitness to ``tell``, and return the genomes, members and fitness of the turn as text."""
        fitness, measures = self.judge(run, genomes)
        run.tell(fitness, measures)
        members = [str(member) for member in run.members()]
        return json_text([dumped_all(run, genomes), members, fitness.tolist()])

    def _history(self, run: EvolverRun, turns: int | None = None) -> list[str]:
        return [self._turn(run) for _ in range(self.turns if turns is None else turns)]

    def _read(self, run: EvolverRun, genomes: Sequence[Any]) -> None:
        run.state()
        run.members()
        run.genomes()
        for genome in genomes:
            run.express(genome)
            run.dump(genome)


def dumped_all(run: EvolverRun, genomes: Sequence[Any]) -> list[str]:
    """Return dumped genomes as JSON texts."""
    return [json_text(run.dump(genome)) for genome in genomes]


def json_text(value: Any) -> str:
    """Return *value* as JSON text, which preserves the order of dictionaries."""
    return json.dumps(value, allow_nan=False)
