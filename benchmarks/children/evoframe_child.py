"""Program that simulates and runs with one version of evoframe, for ``python -m benchmarks --against``.

It works with old and new commits, so it uses only what all of them have: :func:`evoframe.load_config`, the
components of a configuration, :class:`evoframe.Design`, tables of runs, and the command.
"""

from __future__ import annotations

import hashlib
import importlib
import itertools
import resource
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

import evoframe
from evoframe import CONTROLLER, MORPHOLOGY, Design
from serving import serve

_PACKAGES = ("evoframe", "evoframe_libvox", "evoframe_libcppn", "evoframe_simulators", "evoframe_evolvers")

_simulations: dict[str, Callable[[], list[Any]]] = {}


def origins() -> dict[str, str | None]:
    """Return the files from which the packages of evoframe are loaded."""
    return {name: importlib.import_module(name).__file__ for name in _PACKAGES}


def load(name: str, preset: str, file: str) -> None:
    """Load batches of designs, to be simulated with the settings of a preset."""
    config = evoframe.load_config(preset)
    simulator, record = config.simulator.component, config.objective.component.record
    with np.load(file) as arrays:
        numbered = [
            (int(number), Design({MORPHOLOGY: body, CONTROLLER: phases}))
            for number, body, phases in zip(arrays["batch"], arrays["body"], arrays["phases"], strict=True)
        ]
    batches = [
        [design for _, design in group] for _, group in itertools.groupby(numbered, lambda pair: pair[0])
    ]
    score = config.objective.component.score

    def simulate() -> list[Any]:
        outcomes = (outcome for batch in batches for outcome in simulator.simulate(batch, record))
        return [(None if o.diverged_at is not None else score(o), o) for o in outcomes]

    _simulations[name] = simulate


def measure(name: str, times: int) -> float:
    """Return the CPU time of the simulation and scoring of loaded batches, s."""
    simulate = _simulations[name]
    began = time.process_time()
    for _ in range(times):
        simulate()
    return (time.process_time() - began) / times


def results(name: str) -> list[Any]:
    """Return score, digest of the tracks, and number of steps of each loaded design."""
    return [
        [score, _digest(outcome.tracks), int(max(outcome.steps, default=0))]
        for score, outcome in _simulations[name]()
    ]


def _digest(tracks: Any) -> str:
    digest = hashlib.sha256()
    for name in sorted(tracks):
        digest.update(np.ascontiguousarray(tracks[name]).tobytes())
    return digest.hexdigest()


def run(preset: str, settings: list[str], seeds: list[int]) -> dict[str, Any]:
    """Execute ``evoframe run`` with each seed; return times, s, simulations, and the score of each pair."""
    runs = [_run(preset, [*settings, f"run.seed={seed}"]) for seed in seeds]
    total: dict[str, Any] = {key: sum(run[key] for run in runs) for key in ("wall", "cpu", "simulations")}
    return {**total, "results": [result for run in runs for result in run["results"]]}


def _run(preset: str, settings: list[str]) -> dict[str, Any]:
    with tempfile.TemporaryDirectory() as parent:
        directory = str(Path(parent) / "run")
        options = [option for setting in settings for option in ("--set", setting)]
        command = [sys.executable, "-m", "evoframe", "-q", "run", preset, *options, "--out", directory]
        began, cpu_began = time.perf_counter(), _cpu_of_children()
        ended = subprocess.run(command, cwd=parent, capture_output=True, text=True, check=False)
        wall, cpu = time.perf_counter() - began, _cpu_of_children() - cpu_began
        if ended.returncode:
            raise RuntimeError(ended.stderr.strip())
        record = evoframe.load_run(directory)
        simulations = sum(row["simulations"] for row in record.table("workload"))
        results = [[row["score"], "", 0] for row in record.table("pairs")]
    return {"wall": wall, "cpu": cpu, "simulations": simulations, "results": results}


def _cpu_of_children() -> float:
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


if __name__ == "__main__":
    serve({"origins": origins, "load": load, "measure": measure, "results": results, "run": run})
