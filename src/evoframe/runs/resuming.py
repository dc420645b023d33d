"""Resuming of runs: the result equals that of an uninterrupted run bit for bit."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from evoframe.config import Layer, layers_in, layers_of, resolve_layers
from evoframe.contract import RunConfig, SupportsVariants
from evoframe.documents import differences
from evoframe.errors import ComponentError, ConfigurationError, InputError
from evoframe.evolution import Coevolution
from evoframe.files import Lock, acquire_lock, is_leftover, parsed_json, released_on_error, remove
from evoframe.record import (
    CHAINED,
    CONFIG_FILE,
    SINGLE,
    Run,
    Store,
    changed_provenance,
    open_run,
)
from evoframe.registry import Plugins, discover
from evoframe.runs.execution import Execution, assembled, completed, verify_champion
from evoframe.runs.starting import open_store

__all__ = [
    "configuration_of",
    "is_finished",
    "is_verified",
    "reopen",
    "restore",
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
    coevolution = assembled(config)
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


def configuration_of(run: Run, overrides: Sequence[str | Layer], plugins: Plugins) -> RunConfig:
    """Return the resolved configuration of a run.

    Settings that determine the result must be unchanged since the start, with and without the overrides.

    Args:
        run: The run.
        overrides: Settings of the executor.
        plugins: The available plugins.

    Raises:
        ConfigurationError: The configuration is invalid, or changed since the start; the text lists changes.
        InputError: The run is damaged.
    """
    path = run.directory / CONFIG_FILE
    layers = layers_in(run.config, str(path))
    config = resolve_layers(layers.under(overrides), path.stem, plugins)
    began = run.configuration() if run.begun else resolve_layers(layers, path.stem, plugins).deciding()
    if others := differences(began, config.deciding()):
        problem = "the configuration differs from that with which the run started"
        todo = f"undo these changes, or start a new run: evoframe run {path}"
        raise ConfigurationError(f"{_listed(problem, others)}\n  {todo}", source=run.directory)
    return config


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
        raise ConfigurationError(f"{_listed(problem, changes)}\n  {todo}", source=run.directory)
    return changes


def _listed(problem: str, lines: Sequence[str]) -> str:
    return "\n  ".join([f"{problem}:", *lines])


def restore(coevolution: Coevolution, saved: Run, config: RunConfig) -> None:
    """Restore the loop to the end of the last turn.

    Raises:
        InputError: The state is missing or invalid.
    """
    state, last = saved.state(), saved.last_turn()
    if last is None and not state:
        return
    try:
        coevolution.restore(state)
    except Exception as error:
        cause = f"missing {error}" if isinstance(error, KeyError) else str(error)
        if isinstance(error, ComponentError):
            cause = str(completed(error, config, f"state after turn {last}"))
        raise InputError(f"cannot be restored: {cause}", source=saved.directory, key="state") from error
    if coevolution.turn != last:
        problem = f"expected the state after turn {last}, found that after turn {coevolution.turn}"
        raise InputError(problem, source=saved.directory, key="state")


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
