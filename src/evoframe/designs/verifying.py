"""Verification of what a person names: a run's champion, or the designs of a file."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from evoframe.config.layers import layers_of
from evoframe.designs.sources import Job, naming, read_job
from evoframe.record.run import Run
from evoframe.record.verification import Verification
from evoframe.registry.discovery import discover
from evoframe.registry.registry import Plugins
from evoframe.runs.execution import keep_verification, verified

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
    path = source.directory if isinstance(source, Run) else Path(source)
    overrides = layers_of({**settings, "executor.workers": workers})
    job = read_job(path, preset, overrides, plugins or discover(), runs=True)
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
        return verified(job.config, job.designs, job.score)


def keep_of_job(job: Job, verifications: Sequence[Verification]) -> None:
    """Keep the verification of a run, simulated as it was, in its directory; of other jobs nothing is kept.

    Raises:
        RunError: It cannot be kept.
    """
    if job.run is not None and job.score is not None:
        [verification] = verifications
        keep_verification(job.run.directory, verification)
