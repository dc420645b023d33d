"""Comparison of evolved bodies with random search and with the all-contractile bar.

The best pairs of many seeds of the presets ``paper`` and ``authors-rates`` are compared with random search
(the same loop with the evolver ``random``) and with the bar whose interior voxels all contract, at its best
common phase offset (docs/experiment.md, "Expect a plateau").

    python -m benchmarks.plateau --seeds 10 --out DIR
"""

from __future__ import annotations

import argparse
import concurrent.futures
import json
import os
import shutil
import statistics
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np

import evoframe

RANDOM = ["populations.morphology.evolver=random", "populations.controller.evolver=random"]
DEEP = ["populations.morphology.evolver.mutations=20", "populations.controller.evolver.mutations=20"]
CONFIGURATIONS: dict[str, tuple[str, list[str]]] = {
    "paper": ("paper", []),
    "authors-rates": ("authors-rates", []),
    "random search": ("paper", RANDOM),
    "random search, up to 20 mutations": ("paper", [*RANDOM, *DEEP]),
}
THRESHOLD = 0.006  # m


def run_one(name: str, seed: int, out: Path) -> Path:
    """Run a configuration in its own process, unless it is finished."""
    preset, settings = CONFIGURATIONS[name]
    directory = out / f"{name.replace(' ', '-').replace(',', '')}-{seed}"
    if not directory.exists():
        unfinished = directory.with_suffix(".unfinished")
        shutil.rmtree(unfinished, ignore_errors=True)
        options = [option for setting in settings for option in ("--set", setting)]
        command = ["-q", "run", preset, "--seed", str(seed), "--workers", "1", "--out", str(unfinished)]
        subprocess.run(
            [sys.executable, "-m", "evoframe", *command, *options], check=True, stdout=subprocess.DEVNULL
        )
        unfinished.rename(directory)
    return directory


def best_within(finished: evoframe.Run, simulations: float) -> float:
    """Return the score of the best pair among the first *simulations* simulations, m."""
    spent, turn = 0, 0
    for row in finished.workload():
        spent += row["simulations"]
        if spent > simulations:
            break
        turn = row["turn"]
    scores: list[float] = [row["score"] for row in finished.table("best_pairs") if row["turn"] <= turn]
    return max(scores)


def all_contractile() -> tuple[float, float]:
    """Return the best common offset of the all-contractile body, in cycles, and its displacement, m."""
    config = evoframe.load_config("paper")
    simulator, objective = config.simulator.component, config.objective.component
    material = np.ones((20, 8, 8), np.uint8)
    material[1:-1, 1:-1, 1:-1] = 3
    offsets = np.linspace(-0.5, 0.5, 201)
    designs = [
        evoframe.Design({"morphology": material, "controller": np.full(material.shape, offset)})
        for offset in offsets
    ]
    scores = [objective.score(outcome) for outcome in simulator.simulate(designs, objective.record)]
    best = int(np.argmax(scores))
    return float(offsets[best]), scores[best]


def describe(name: str, runs: list[evoframe.Run], budget: float) -> dict[str, Any]:
    """Return the figures of one configuration."""
    best = [run.champion().score for run in runs]
    low, median, high = statistics.quantiles(best, n=4, method="inclusive")
    return {
        "configuration": name,
        "runs": len(runs),
        "median": median,
        "quartiles": [low, high],
        "least and greatest": [min(best), max(best)],
        "share above 0.006 m": sum(value > THRESHOLD for value in best) / len(best),
        "median simulations": statistics.median(simulations(run) for run in runs),
        "median of the best within the budget": statistics.median(best_within(run, budget) for run in runs),
        "first turn with 0.005 m, of each run": [first_turn_with(run, 0.005) for run in runs],
        "empty share of the champion's interior, of each run": [empty_share(run) for run in runs],
    }


def first_turn_with(finished: evoframe.Run, score: float) -> int | None:
    """Return the first turn in which a pair reached a score; ``None`` if no pair did."""
    return next((row["turn"] for row in finished.table("best_pairs") if row["score"] >= score), None)


def empty_share(finished: evoframe.Run) -> float:
    """Return the empty share of the interior of the champion's body."""
    interior = finished.champion().design.roles["morphology"][1:-1, 1:-1, 1:-1]
    return round(float((interior == 0).mean()), 3)


def simulations(finished: evoframe.Run) -> int:
    """Return the number of simulations of a run."""
    return sum(row["simulations"] for row in finished.workload())


def main() -> None:
    """Execute the missing runs, then print the table as JSON."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--seeds", type=int, default=10)
    parser.add_argument("--out", type=Path, default=Path("runs/plateau"))
    options = parser.parse_args()
    jobs = [(name, seed) for seed in range(1, options.seeds + 1) for name in CONFIGURATIONS]
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        started = [pool.submit(run_one, name, seed, options.out) for name, seed in jobs]
        directories = [run.result() for run in started]
    runs: dict[str, list[evoframe.Run]] = {name: [] for name in CONFIGURATIONS}
    for (name, _), directory in zip(jobs, directories, strict=True):
        runs[name].append(evoframe.load_run(directory))
    budget = statistics.median(simulations(run) for run in runs["paper"])
    offset, displacement = all_contractile()
    report = {
        "budget": budget,
        "all-contractile body": {"offset (cycles)": offset, "displacement": displacement},
        "configurations": [describe(name, runs[name], budget) for name in CONFIGURATIONS],
    }
    sys.stdout.write(json.dumps(report, indent=2) + "\n")


if __name__ == "__main__":
    main()
