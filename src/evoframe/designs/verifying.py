"""Verification of designs given by the user: the champion of a run, or the designs of a file."""

from __future__ import annotations

import functools
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import attrs

from evoframe.config import layers_of, read_layers
from evoframe.contract import (
    Design,
    ExecutorRun,
    FileOptions,
    Objective,
    RunConfig,
    Score,
    SupportsVariants,
    Variant,
    unit_of,
    whole_of,
)
from evoframe.designs.sources import Job, naming, read_job
from evoframe.errors import ConfigurationError
from evoframe.evolution import score_designs
from evoframe.record import UNCHANGED, WITHIN_REACH, Finding, Run, Verification, keep_verification
from evoframe.registry import Plugins, discover

__all__ = ["keep_of_job", "verify", "verify_job"]


def verify(
    source: Run | str | Path,
    /,
    *,
    preset: str | None = None,
    workers: int | None = None,
    plugins: Plugins | None = None,
    options: FileOptions | None = None,
    **settings: Any,
) -> list[Verification]:
    """Simulate designs again with one thing changed at a time, like the command ``evoframe verify``.

    Args:
        source: A run or its directory, for its champion; or a file with designs.
        preset: The preset for settings that the file lacks, and for the objective, which otherwise depends on
            what a file with settings contains; for a champion, it replaces the run's settings.
        workers: Overrides ``executor.workers``.
        plugins: The available plugins; by default all installed plugins.
        options: Choices for reading a file, such as its dialect.
        **settings: Further settings by key, as for :func:`evoframe.runs.execution`.

    Returns:
        One verification per design. That of a run with unchanged settings is also written to its directory.

    Raises:
        ConfigurationError: The settings are invalid, or the simulator offers no variants.
        InputError: The file or directory cannot be read, or has an unexpected content.
        RunError: The verification fails or cannot be written.
    """
    overrides = layers_of(settings, {"executor.workers": workers})
    named = source if isinstance(source, Run) else Path(source)
    base = None if preset is None else read_layers(preset)
    job = read_job(named, base, overrides, plugins or discover(), options=options)
    verifications = verify_job(job)
    keep_of_job(job, verifications)
    return verifications


def verify_job(job: Job) -> list[Verification]:
    """Verify the designs of a job.

    Raises:
        ConfigurationError: The simulator offers no variants.
        InputError: The simulator cannot simulate a design.
        RunError: The verification fails.
    """
    with naming(job.path):
        return verify_designs(job.config, job.designs, job.score)


def keep_of_job(job: Job, verifications: Sequence[Verification]) -> None:
    """Write the verification of a run to its directory, unless its settings were changed.

    Raises:
        RunError: The file cannot be written.
    """
    if job.run is not None and job.score is not None:
        [verification] = verifications
        keep_verification(job.run.directory, verification)


def verify_designs(
    config: RunConfig, designs: Sequence[Design], score: float | None = None
) -> list[Verification]:
    """Simulate designs in all variants of a configuration's simulator.

    Args:
        config: The configuration with simulator, objective and executor.
        designs: The designs, verified independently.
        score: The score of a champion in its run.

    Raises:
        ConfigurationError: The simulator offers no variants.
    """
    simulator = config.simulator.component
    if not isinstance(simulator, SupportsVariants):
        problem = f"'{config.simulator.name}' offers no variants, so its scores cannot be verified"
        raise ConfigurationError(problem, key="simulator")
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
    """Simulate a design unchanged and in all variants of its simulator.

    Whole designs are simulated. If the unchanged one diverges, it is also simulated as in a run, whose score
    may not see the divergence.

    Args:
        simulator: The simulator, which offers the variants.
        objective: Scores all simulations.
        design: The design to verify.
        workers: Started workers; the result does not depend on their number.
        score: Its score in the run, if the design is a champion.

    Raises:
        RunError: The simulator or the objective failed, or returned an invalid result.
    """
    whole, score_of = whole_of(simulator), functools.partial(_score, objective)
    variants = list(whole.variants(design, objective.record))
    unchanged = Variant(UNCHANGED, whole, design, objective.record)
    first, *others = workers.map(score_of, [unchanged, *variants])
    drawn: dict[str, list[Score]] = {}
    if first.value is None and whole is not simulator:
        [seen] = workers.map(score_of, [attrs.evolve(unchanged, simulator=simulator)])
        if seen.value is not None:
            drawn[WITHIN_REACH] = [seen]
    for variant, given in zip(variants, others, strict=True):
        drawn.setdefault(variant.name, []).append(given)
    findings = tuple(Finding(name, tuple(scores)) for name, scores in drawn.items())
    return Verification(first, findings, unit_of(objective), score)


def _score(objective: Objective, variant: Variant) -> Score:
    [score] = score_designs(variant.simulator, [variant.design], variant.record, objective)
    return score
