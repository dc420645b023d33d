"""Cases of ``python -m benchmarks --against REV``: simulations of the same designs, and commands."""

from __future__ import annotations

import itertools
import statistics
from collections.abc import Callable, Mapping, Sequence

import attrs
import numpy as np

import evoframe
from benchmarks.against.comparison import SIDES, Command, Comparison, Measured
from benchmarks.against.results import difference
from benchmarks.bending import bimorph
from benchmarks.pairs import ratio
from benchmarks.recording import Batch, recording
from benchmarks.report import Cell, Row, Section, SectionError, Table
from benchmarks.subjects import bonds_of, published as published_designs, traveler
from benchmarks.timing import Effort
from evoframe import CONTROLLER, MORPHOLOGY, Design

__all__ = ["CASES"]

_SEEDS = (1, 2)
_RUN_SEEDS = (1, 2, 3)  # several, since runs differ in their simulations after a change of bits
_BATCHES = 2  # recorded batches of each seed, per unit of effort.designs
_WORKERS = 2
_RATIO = ("times as fast", "lower quartile", "upper quartile")
_NEIGHBORS = "Times as fast: median and quartiles over all neighbors of a session this, other, this, other."


# ---- simulations


def _evolved(comparison: Comparison, effort: Effort) -> Section:
    batches = [batch for seed in _SEEDS for batch in _recorded(seed, effort)]
    measured = comparison.simulate("evolved", "paper", batches, effort)
    return _simulations(
        "designs that evolve in runs of the preset paper",
        {f"{len(batches)} batches": (batches, measured)},
        f"A spread sample of the batches that runs with seeds {_SEEDS} and {_WORKERS} workers simulate.",
    )


def _recorded(seed: int, effort: Effort) -> Sequence[Batch]:
    """Return batches that a run simulates, evenly spread over its turns."""
    settings = [*effort.run, f"run.seed={seed}", f"executor.workers={_WORKERS}"]
    config = evoframe.load_config("paper", overrides=settings)
    batches: list[Batch] = []
    with recording(config, batches), evoframe.assemble(config) as coevolution:
        for _ in coevolution:
            pass
    return batches[:: max(1, len(batches) // (_BATCHES * effort.designs))]


def _published(comparison: Comparison, effort: Effort) -> Section:
    cases = {name: [batch] for name, batch in _controlled().items()}
    cases["all three"] = list(_controlled().values())
    measured = {
        name: (batches, comparison.simulate(f"published-{number}", "paper", batches, effort))
        for number, (name, batches) in enumerate(cases.items())
    }
    return _simulations(
        "published bodies in batches of 4 controllers",
        measured,
        "The controllers are the three published ones (zero, uniform and sin offsets) and a wave along x.",
    )


def _hyperneat(comparison: Comparison, effort: Effort) -> Section:
    batches = [[design] for design in _controlled()["HyperNEAT"]]
    measured = comparison.simulate("hyperneat", "paper", batches, effort)
    return _simulations(
        "the published HyperNEAT body, one controller at a time", {"HyperNEAT alone": (batches, measured)}
    )


def _controlled() -> dict[str, Batch]:
    """Return the published bodies, each with four controllers."""
    named = itertools.groupby(published_designs().items(), lambda item: item[0].partition(",")[0])
    groups = {name: [design for _, design in items] for name, items in named}
    return {name: [*designs, _waving(designs[0])] for name, designs in groups.items()}


def _waving(design: Design) -> Design:
    """Return a design whose offsets increase by one along x."""
    shape = design.roles[MORPHOLOGY].shape
    wave = np.linspace(0.0, 1.0, shape[0])[:, None, None]
    return design.with_role(CONTROLLER, np.broadcast_to(wave, shape).copy())


def _simulations(
    title: str, cases: Mapping[str, tuple[Sequence[Batch], Measured]], note: str = ""
) -> Section:
    rows: list[Row] = []
    for name, (batches, measured) in cases.items():
        count = sum(map(len, batches))
        rates = (count / statistics.median(measured.times[side]["cpu"]) for side in SIDES)
        rows.append((name, count, *rates, *_ratios(measured, "cpu"), _difference(measured)))
    return Section(
        title,
        (
            Table(
                "Simulation and scoring, CPU time",
                ("case", "designs", "this, 1/s", "other, 1/s", *_RATIO, "results"),
                rows,
                f"{note} {_NEIGHBORS}".strip(),
            ),
        ),
    )


# ---- commands


def _run(comparison: Comparison, effort: Effort) -> Section:
    rows = [
        row
        for n in (2, 10)
        for row in _command(
            comparison, effort, f"n = {n}", _with_workers("paper", *effort.run, f"collaboration.n={n}")
        )
    ]
    note = f"Sums of runs with the seeds {_RUN_SEEDS}."
    return Section("the command evoframe run paper", (_commands(rows, note),))


def _with_workers(preset: str, *settings: str, seeds: Sequence[int] = _RUN_SEEDS) -> Command:
    return Command(preset, [*settings, f"executor.workers={_WORKERS}"], seeds)


def _command(comparison: Comparison, effort: Effort, name: str, command: Command) -> list[Row]:
    measured = comparison.run(command, effort)
    rows: list[Row] = []
    for clock, words in (("wall", "wall clock"), ("cpu", "CPU time")):
        seconds = (statistics.median(measured.times[side][clock]) for side in SIDES)
        simulations = (measured.simulations[side] for side in SIDES)
        rows.append(
            (f"{name}, {words}", *seconds, *_ratios(measured, clock), *simulations, _difference(measured))
        )
    return rows


def _commands(rows: Sequence[Row], note: str = "") -> Table:
    return Table(
        f"The command with {_WORKERS} workers, with the start of Python, verification and files",
        ("case", "this, s", "other, s", *_RATIO, "this, simulations", "other, simulations", "results"),
        rows,
        f"{note} {_NEIGHBORS} Results are the scores of all pairs.".strip(),
    )


# ---- presets with many steps


@attrs.frozen
class _LongPreset:
    """A case for a preset with thousands of steps per simulation, which is run with small populations.

    Attributes:
        preset: Its name.
        design: Creates a design for its canvas, to be simulated alone.
        generations: Number of generations of a run.
        size: Size of both populations, at most.
    """

    preset: str
    design: Callable[[Sequence[int]], Design]
    generations: int
    size: int

    def __call__(self, comparison: Comparison, effort: Effort) -> Section:
        canvas = evoframe.load_config(self.preset).populations[MORPHOLOGY].encoder.component.canvas  # type: ignore[attr-defined]  # of cppn-morphology
        design = self.design(canvas)
        measured = comparison.simulate(self.preset, self.preset, [[design]], effort)
        size = min(self.size, effort.designs)
        sizes = [f"populations.{role}.size={size}" for role in (MORPHOLOGY, CONTROLLER)]
        settings = [f"run.generations={self.generations}", *sizes]
        rows = _command(comparison, effort, "short run", _with_workers(self.preset, *settings, seeds=[1]))
        return Section(
            f"the preset {self.preset}",
            (_per_bond_step(design, measured), _commands(rows, f"Settings: {', '.join(settings)}.")),
        )


def _per_bond_step(design: Design, measured: Measured) -> Table:
    steps, bonds = measured.results["this"][0].steps, bonds_of(design)
    if not steps:
        raise SectionError("the simulation has no steps")
    ns = (1e9 * statistics.median(measured.times[side]["cpu"]) / (bonds * steps) for side in SIDES)
    case = f"{bonds:,} bonds, {steps:,} steps to the last sample"
    row: Row = (case, *ns, *_ratios(measured, "cpu"), _difference(measured))
    return Table(
        "Simulation of one design, CPU time per bond-step",
        ("case", "this, ns", "other, ns", *_RATIO, "results"),
        (row,),
        _NEIGHBORS,
    )


def _ratios(measured: Measured, clock: str) -> tuple[Cell, ...]:
    found = ratio(measured.times["this"][clock], measured.times["other"][clock])
    return found.median, found.lower, found.upper


def _difference(measured: Measured) -> str:
    return difference(measured.results["this"], measured.results["other"])


CASES: dict[str, Callable[[Comparison, Effort], Section]] = {
    "evolved": _evolved,
    "published": _published,
    "hyperneat": _hyperneat,
    "run": _run,
    "locomotion": _LongPreset("locomotion", traveler, generations=2, size=10),
    "bending": _LongPreset("bending", bimorph, generations=2, size=8),
}
"""Name -> measurement of a case."""
