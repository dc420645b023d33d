"""Time of a whole run by stage, and its memory and disk space."""

from __future__ import annotations

import contextlib
import functools
import statistics
import sys
import tempfile
import time
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

import attrs
import neat
import numpy as np

import evoframe
from benchmarks.memory import peak_memory
from benchmarks.recording import Batch, recording
from benchmarks.report import Row, Section, SectionError, Table
from benchmarks.stages import Stages, Watched
from benchmarks.timing import Action, Effort, cores_used, interleaved
from evoframe import Coevolution, ExecutorRun, RunConfig
from evoframe.record.store import Store
from evoframe.registry.registry import Plugins
from evoframe.runs.starting import prepare
from evoframe_libcppn import CppnNetwork

__all__ = ["runs"]

_SIMULATION = "simulation"
_SAVING = ("saving", "state for the record")
_EVERY = 4  # the interval of the batches that are simulated again
_WORKERS = (1, 2)


@attrs.frozen
class _Played:
    """Figures of a run.

    Attributes:
        wall: Wall clock of the loop and its record, s.
        verifying: Wall clock of the champion's verification, s.
        cpu: Stage -> CPU time of all threads, s; includes the rest.
        simulating: Time during which at least one thread simulated, s.
        saving: Time during which the run was being saved, s.
        size: Size of the run's directory, MB.
        pairs: Number of pairs scored, and of pairs simulated.
    """

    wall: float
    verifying: float
    cpu: Mapping[str, float]
    simulating: float
    saving: float
    size: float
    pairs: tuple[int, int]


def runs(effort: Effort) -> Section:
    """Run the preset ``paper`` with one worker and with two, and with more collaborators."""
    configs = {workers: _config(effort, 2, workers) for workers in _WORKERS}
    batches: list[Batch] = []
    played: dict[int, list[_Played]] = {workers: [] for workers in _WORKERS}
    for _ in range(effort.run_rounds):
        for workers, config in configs.items():
            first = workers == 1 and not played[workers]
            with recording(config, batches, _EVERY) if first else contextlib.nullcontext():
                played[workers].append(_play(config))
    more = _play(_config(effort, 10, 2))
    replayed, used = _replayed(effort, configs, batches)
    return Section(
        "the preset paper as a whole, by stage",
        (
            _stages(played),
            _whole(played, more),
            _simulation(played, replayed, used),
            _saving(played),
            _memory(effort),
        ),
    )


# ---- running


def _config(effort: Effort, collaborators: int, workers: int) -> RunConfig:
    return evoframe.load_config("paper", overrides=_settings(effort, collaborators, workers))


def _settings(effort: Effort, collaborators: int, workers: int) -> list[str]:
    return [*effort.run, f"collaboration.n={collaborators}", f"executor.workers={workers}"]


def _play(config: RunConfig) -> _Played:
    stages = Stages()
    with tempfile.TemporaryDirectory() as directory:
        with stages.watch(_watched(config)):
            execution = prepare(config, Plugins(), Path(directory) / "run")
            began, cpu_began = time.perf_counter(), time.process_time()
            finished = execution.play()
            wall, cpu = time.perf_counter() - began, time.process_time() - cpu_began
        _check_reached(stages, config)
        began = time.perf_counter()
        execution.verify(finished)
        verifying = time.perf_counter() - began
        work = finished.workload()
        size = sum(path.stat().st_size for path in execution.directory.iterdir()) / 1e6
    pairs, simulated = (sum(row[key] for row in work) for key in ("pairs", "simulations"))
    rest = {"the rest": cpu - sum(stages.cpu.values())}
    return _Played(
        wall,
        verifying,
        {**stages.cpu, **rest},
        stages.elapsed(_SIMULATION),
        sum(stages.elapsed(stage) for stage in _SAVING),
        size,
        (pairs, simulated),
    )


def _watched(config: RunConfig) -> list[Watched]:
    """Return the methods that are stages, by the protocols of the components."""
    return [
        *_watched_populations(config),
        (CppnNetwork, "__call__", "evaluating networks"),
        (type(config.simulator.component), "key", "keys of designs"),
        (type(config.simulator.component), "simulate", _SIMULATION),
        (type(config.objective.component), "score", "scoring"),
        (type(config.aggregator.component), "aggregate", "fitness"),
        (Coevolution, "state", _SAVING[1]),
        (Store, "save", _SAVING[0]),
    ]


def _watched_populations(config: RunConfig) -> Iterator[Watched]:
    yield neat.DefaultSpeciesSet, "speciate", "speciation"
    evolvers, encoders = set(), set()
    for population in config.populations.values():
        encoder = population.encoder.component
        started = population.evolver.component.start(
            encoder.inputs, encoder.outputs, population.size, np.random.default_rng()
        )
        evolvers.add(type(started))
        encoders.add(type(encoder))
    for evolver in evolvers:
        yield evolver, "ask", "reproduction"
        yield evolver, "express", "compiling networks"
    for encoder_type in encoders:
        yield encoder_type, "decode", "decoding"


def _check_reached(stages: Stages, config: RunConfig) -> None:
    for _, method, stage in _watched(config):
        if not stages.calls[stage]:
            raise SectionError(f"the stage '{stage}' was never reached; a run no longer calls {method}()")


def _replayed(
    effort: Effort, configs: Mapping[int, RunConfig], batches: Sequence[Batch]
) -> tuple[dict[int, float], float]:
    """Return the time of the batches for each number of workers, s, and the cores that two workers use."""
    started = {workers: config.executor.component.start() for workers, config in configs.items()}
    simulate, record = configs[1].simulator.component.simulate, configs[1].objective.component.record

    def replay(workers: ExecutorRun) -> list[object]:
        return list(workers.map(lambda batch: simulate(batch, record), batches))

    try:
        actions: dict[int, Action] = {
            number: functools.partial(replay, workers) for number, workers in started.items()
        }
        taken = interleaved(actions, attrs.evolve(effort, shortest=0.0), time.perf_counter)
        return taken, cores_used(actions[2])
    finally:
        for workers in started.values():
            workers.close()


# ---- tables


def _stages(played: Mapping[int, Sequence[_Played]]) -> Table:
    cpu = {
        workers: {stage: statistics.median(run.cpu[stage] for run in rounds) for stage in rounds[0].cpu}
        for workers, rounds in played.items()
    }
    whole = {workers: sum(stages.values()) for workers, stages in cpu.items()}
    ordered = sorted(cpu[1], key=cpu[1].__getitem__, reverse=True)
    rows: list[Row] = [
        (stage, *(cell for n in _WORKERS for cell in (cpu[n][stage], cpu[n][stage] / whole[n])))
        for stage in ordered
    ]
    rows.append(("sum", *(cell for n in _WORKERS for cell in (whole[n], 1.0))))
    rows.append(("wall clock of the run", *(cell for n in _WORKERS for cell in _clock(played[n], whole[n]))))
    return Table(
        "CPU time by stage, collaboration.n = 2",
        ("stage", "1 worker, s", "share", "2 workers, s", "share with 2"),
        rows,
        "CPU time of all threads; each stage excludes its inner stages (decoding excludes the networks, "
        "reproduction excludes speciation). The rest is the loop, the executor and the interpreter. With two "
        "workers, one thread may decode and reproduce while the other simulates, so the wall clock is less "
        "than the sum. The median of each stage over interleaved runs.",
    )


def _clock(rounds: Sequence[_Played], whole: float) -> tuple[float, float]:
    wall = statistics.median(run.wall for run in rounds)
    return wall, wall / whole


def _whole(played: Mapping[int, Sequence[_Played]], more: _Played) -> Table:
    rows: list[Row] = [
        (f"n = 2, {workers} worker{'s' if workers > 1 else ''}", *_figures(rounds))
        for workers, rounds in played.items()
    ]
    rows.append(("n = 10, 2 workers", *_figures([more])))
    return Table(
        "Whole runs, without and with the verification of the champion",
        ("run", "wall clock, s", "cores used", "with verification, s", "pairs", "simulated", "pairs per s"),
        tuple(rows),
        "Wall clock; the median of interleaved runs; n = 10 once. Repeated pairs are not simulated again.",
    )


def _figures(rounds: Sequence[_Played]) -> tuple[float, ...]:
    wall = statistics.median(run.wall for run in rounds)
    verifying = statistics.median(run.verifying for run in rounds)
    pairs, simulated = rounds[0].pairs
    used = statistics.median(sum(run.cpu.values()) / run.wall for run in rounds)
    return wall, used, wall + verifying, pairs, simulated, pairs / wall


def _simulation(played: Mapping[int, Sequence[_Played]], replayed: Mapping[int, float], used: float) -> Table:
    def ratio(of: Mapping[int, float]) -> tuple[float, ...]:
        return of[1], of[2], of[1] / of[2]

    walls = {n: statistics.median(run.wall for run in rounds) for n, rounds in played.items()}
    simulating = {n: statistics.median(run.simulating for run in rounds) for n, rounds in played.items()}
    return Table(
        "One worker against two, wall clock",
        ("", "1 worker, s", "2 workers, s", "1 worker / 2"),
        (
            ("simulation stage, replayed", *ratio(replayed)),
            ("at least one thread simulates", *ratio(simulating)),
            ("whole run", *ratio(walls)),
        ),
        f"Replayed: every {_EVERY}th batch of the run, simulated alone by the run's executor; goal 1.7. Two "
        f"workers used {used:.2f} cores for it: if that is much less than 2, other processes used the rest. "
        "In the run itself, one of two workers may decode and reproduce while the other simulates, so "
        "simulation takes more than half the time of one worker, but the whole run is shorter.",
    )


def _saving(played: Mapping[int, Sequence[_Played]]) -> Table:
    rows: list[Row] = [
        (
            f"n = 2, {workers} worker{'s' if workers > 1 else ''}",
            statistics.median(run.saving for run in rounds),
            statistics.median(run.saving / run.wall for run in rounds),
            statistics.median(run.size for run in rounds),
        )
        for workers, rounds in played.items()
    ]
    return Table(
        "Saving, wall clock",
        ("run", "saving, s", "of the wall clock", "directory, MB"),
        rows,
        "The state after each turn, its rows, and the champion's files; two workers simulate meanwhile.",
    )


def _memory(effort: Effort) -> Table:
    with tempfile.TemporaryDirectory() as directory:
        options = [option for setting in _settings(effort, 2, 2) for option in ("--set", setting)]
        out = ["--out", str(Path(directory) / "run")]
        size, seconds = peak_memory([sys.executable, "-m", "evoframe", "-q", "run", "paper", *options, *out])
    return Table(
        "The command evoframe -q run",
        ("", "peak memory, MB", "wall clock, s"),
        (("n = 2, 2 workers", size, seconds),),
        "Peak resident size; goal below 250 MB. Includes the start of Python, verification and all files.",
    )
