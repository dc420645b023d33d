"""Resuming of runs: the result equals that of an uninterrupted run bit for bit."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from evoframe.config import Layer, layers_of
from evoframe.contract import RunConfig, SupportsVariants
from evoframe.errors import ConfigurationError
from evoframe.files import Lock, acquire_lock, is_leftover, parsed_json, released_on_error, remove
from evoframe.record import (
    CHAINED,
    SINGLE,
    Run,
    Store,
    changed_provenance,
    open_run,
)
from evoframe.registry import Plugins, discover
from evoframe.runs.blame import assembled
from evoframe.runs.execution import Execution, verify_champion
from evoframe.runs.restoring import configuration_of, listed, restore
from evoframe.runs.starting import open_store
from evoframe.runs.warm_start import starting_genomes

__all__ = [
    "is_finished",
    "is_verified",
    "reopen",
    "resume",
    "verify_if_missing",
]


def resume(
    directory: str | Path,
    /,
    *,
    workers: int | None = None,
    allow_different_versions: bool = False,
    plugins: Plugins | None = None,
) -> Run:
    """Resume a run after its last complete turn, like the command ``evoframe resume``.

    Args:
        directory: The run's directory.
        workers: Overrides ``executor.workers``; the result does not depend on it.
        allow_different_versions: Resume even if versions, bit generations or the machine changed since the
            start of the run, and record the changes in the table ``resumes``.
        plugins: The available plugins; by default all installed plugins.

    Returns:
        The finished run. A run that was already finished is only verified, if it was not.

    Raises:
        ConfigurationError: The configuration, a version or the machine differs; the text lists the changes.
        InputError: It is not a run's directory, is damaged, or another process is writing to it.
        RunError: The run cannot continue; saved turns are kept.
    """
    overrides, plugins = layers_of({"executor.workers": workers}), plugins or discover()
    with open_run(directory) as run:
        if is_finished(run):
            run.read_all()
            verify_if_missing(run, configuration_of(run, overrides, plugins))
            return run
        execution = reopen(run, overrides, plugins, allow_different_versions=allow_different_versions)
    finished = execution.play()
    execution.verify(finished)
    return finished


def is_finished(run: Run) -> bool:
    """Return ``True`` if a run is finished and its champion's files are up to date.

    Raises:
        InputError: The run is damaged.
    """
    return run.begun and run.finished() and run.champion_is_written()


def is_verified(run: Run, config: RunConfig) -> bool:
    """Return ``True`` if the champion of a finished run is verified, or its simulator has no variants.

    Raises:
        InputError: The verification is damaged, or verifies a different champion.
    """
    return not isinstance(config.simulator.component, SupportsVariants) or run.verification() is not None


def verify_if_missing(run: Run, config: RunConfig) -> None:
    """Verify the champion of a finished run unless it is verified: see :func:`verify_champion`.

    Args:
        run: The run.
        config: Its configuration, from :func:`configuration_of`.

    Raises:
        InputError: The run or its verification is damaged, or another process is writing to it.
        RunError: The champion cannot be verified.
    """
    if not is_verified(run, config):
        verify_champion(config, run)


def reopen(
    run: Run, overrides: Sequence[str | Layer], plugins: Plugins, *, allow_different_versions: bool = False
) -> Execution:
    """Prepare a run to continue after its last complete turn.

    Args:
        run: The open run, which is closed here.
        overrides: Settings of the executor.
        plugins: The available plugins, which can observe the run.
        allow_different_versions: As for :func:`resume`.

    Raises:
        ConfigurationError: As :func:`resume`.
        InputError: As :func:`resume`.
    """
    lock = acquire_lock(run.directory)
    with released_on_error(lock):
        if not run.outdated():
            return _reopen(run, lock, overrides, plugins, allowed=allow_different_versions)
        run.close()
        with open_run(run.directory) as newer:  # another process has just written to it
            return _reopen(newer, lock, overrides, plugins, allowed=allow_different_versions)


def _reopen(
    run: Run, lock: Lock, overrides: Sequence[str | Layer], plugins: Plugins, *, allowed: bool
) -> Execution:
    config = configuration_of(run, overrides, plugins)
    changes = _changes(run, config, allowed=allowed)
    if run.begun:
        run.read_all()
    started = run.begun and run.last_turn() is not None
    genomes = {} if started else starting_genomes(config, plugins)
    coevolution = assembled(config, genomes)
    try:
        if run.begun:
            restore(coevolution, run, config)
        run.close()  # a reader would block writing
        store = open_store(run.directory, config, lock)
        if run.begun:
            _resume(store, run, changes)
        else:  # killed before its first transaction
            store.begin(list(config.populations), config.deciding())
    except BaseException:
        coevolution.close()
        raise
    usable = plugins.without(config.plugins.block)
    return Execution(config, usable, run.directory, run.config, coevolution, store)


def _changes(run: Run, config: RunConfig, *, allowed: bool) -> list[str]:
    """Return the changes of versions, bit generations, local plugins and machine since the start of a run.

    Raises:
        ConfigurationError: There are changes, and they are not allowed.
    """
    changes = changed_provenance(run, config)
    if changes and not allowed:
        problem = (
            "versions, bit generations, local plugins or machine differ from those with which the run "
            "started, so its result may differ"
        )
        command = f"evoframe resume {run.directory} --allow-different-versions"
        todo = f"to continue anyway (this is recorded): {command}"
        raise ConfigurationError(f"{listed(problem, changes)}\n  {todo}", source=run.directory)
    return changes


def _resume(store: Store, saved: Run, changes: Sequence[str]) -> None:
    """Complete or remove files that a kill left incomplete, and record the resume.

    The run can already be finished: a file was missing, or another process has just finished it.
    """
    for path in saved.directory.iterdir():
        if is_leftover(path):
            remove(path)
    store.resume({table: saved.rows(table) for table in (*CHAINED, *SINGLE)}, changes)
    document = saved.champion_document()
    if document is not None and not saved.champion_is_written():
        design = saved.champion().design  # refuses a damaged document
        store.save_champion(parsed_json(document), design)
