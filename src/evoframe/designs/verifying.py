"""Verification of what a person names: a run's champion, or the designs of a file."""

from __future__ import annotations

import functools
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from evoframe.config import layers_of
from evoframe.contract import (
    Design,
    ExecutorRun,
    Objective,
    RunConfig,
    Score,
    SupportsVariants,
    Variant,
    unit_of,
)
from evoframe.designs.sources import Job, naming, read_job
from evoframe.errors import ConfigurationError
from evoframe.evolution import score_designs
from evoframe.record import UNCHANGED, Finding, Run, Verification, keep_verification
from evoframe.registry import Plugins, discover

__all__ = ["keep_of_job", "verify", "verify_job"]


def verify(
    source: Run | str | Path,
    /,
    *,
    preset: str | None = None,
    workers: int | None = None,
    plugins: Plugins | None = None,
    **settings: Any,
) -> list[Verification]:
    """Simulate designs again with one thing changed at a time, as the command ``evoframe verify`` does.

    Args:
        source: A run or its directory, which stand for its champion; or a file with designs.
        preset: What the file does not say is as in this preset; a champion is simulated as this preset does.
        workers: Overrides ``executor.workers``.
        plugins: The plugins to choose from; by default those that are installed.
        **settings: Further settings by key, as for :func:`evoframe.runs.execution`.

    Returns:
        One verification for each design; that of a run, simulated as it was, is kept in its directory too.

    Raises:
        ConfigurationError: The settings cannot be accepted, or the simulator offers no variants.
        InputError: The file or directory cannot be read, or is something else.
        RunError: The verification cannot be made or kept.
    """
    overrides = layers_of({**settings, "executor.workers": workers})
    named = source if isinstance(source, Run) else Path(source)
    job = read_job(named, preset, overrides, plugins or discover(), runs=True)
    verifications = verify_job(job)
    keep_of_job(job, verifications)
    return verifications


def verify_job(job: Job) -> list[Verification]:
    """Verify the designs of a job.

    Raises:
        ConfigurationError: The simulator offers no variants.
        InputError: The simulator cannot simulate a design.
        RunError: The verification cannot be made.
    """
    with naming(job.path):
        return verify_designs(job.config, job.designs, job.score)


def keep_of_job(job: Job, verifications: Sequence[Verification]) -> None:
    """Keep the verification of a run, simulated as it was, in its directory; of other jobs nothing is kept.

    Raises:
        RunError: It cannot be kept.
    """
    if job.run is not None and job.score is not None:
        [verification] = verifications
        keep_verification(job.run.directory, verification)


def verify_designs(
    config: RunConfig, designs: Sequence[Design], score: float | None = None
) -> list[Verification]:
    """Return what becomes of designs in all variants of a configuration's simulator.

    Args:
        config: How they are simulated and scored, and by how many workers.
        designs: What is verified, each on its own.
        score: What a champion scored in its run.

    Raises:
        ConfigurationError: The simulator offers no variants.
    """
    simulator = config.simulator.component
    if not isinstance(simulator, SupportsVariants):
        raise ConfigurationError(
            f"the simulator '{config.simulator.name}' offers no variants of a simulation, so there is "
            "nothing that a score could be compared with"
        )
    workers = config.executor.component.start()
    try:
        return [
            verify_design(simulator, config.objective.component, design, workers, score) for design in designs
        ]
    finally:
        workers.close()


def verify_design(
    simulator: SupportsVariants,
    objective: Objective,
    design: Design,
    workers: ExecutorRun,
    score: float | None = None,
) -> Verification:
    """Simulate a design as it is, and in all variants of its simulator.

    Args:
        simulator: Simulates it, and offers the variants.
        objective: Scores all of them.
        design: What is verified.
        workers: Simulate at the same time; the result does not depend on them.
        score: What the design scored in its run, if it is a champion.

    Raises:
        RunError: The simulator or the objective did not keep its word.
    """
    variants = list(simulator.variants(design, objective.record))
    unchanged = Variant(UNCHANGED, simulator, design, objective.record)
    first, *others = workers.map(functools.partial(_score, objective), [unchanged, *variants])
    drawn: dict[str, list[Score]] = {}
    for variant, given in zip(variants, others, strict=True):
        drawn.setdefault(variant.name, []).append(given)
    findings = tuple(Finding(name, tuple(scores)) for name, scores in drawn.items())
    return Verification(first, findings, unit_of(objective), score)


def _score(objective: Objective, variant: Variant) -> Score:
    [score] = score_designs(variant.simulator, [variant.design], variant.record, objective)
    return score
