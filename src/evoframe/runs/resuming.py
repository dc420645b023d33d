"""Runs that go on where they were left, bit for bit as if nothing had happened."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from evoframe.config import Layer, layers_in, layers_of, resolve_layers
from evoframe.contract import RunConfig, SupportsVariants
from evoframe.documents import differences
from evoframe.errors import ConfigurationError, InputError
from evoframe.evolution import Coevolution, assemble
from evoframe.files import Lock, acquire_lock, is_leftover, parsed_json, released_on_error, remove
from evoframe.record import (
    CHAINED,
    CONFIG_FILE,
    SINGLE,
    Run,
    Store,
    design_from_json,
    open_run,
    provenance_of,
)
from evoframe.registry import Plugins, discover
from evoframe.runs.execution import Execution, verify_champion
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
    """Go on with a run from its last complete turn, as the command ``evoframe resume`` does.

    Args:
        directory: The run's directory.
        workers: Overrides ``executor.workers``; the result does not depend on it.
        allow_different_versions: Go on although versions or the machine are not those that the run began
            with, and note it in the table ``resumes``.
        plugins: The plugins to choose from; by default those that are installed.

    Returns:
        The finished run; one that was finished already is verified, if it was not.

    Raises:
        ConfigurationError: The configuration, a version or the machine differs; says what.
        InputError: It is no run's directory, it is damaged, or another process writes to it.
        RunError: The run cannot go on; what was saved stays.
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
    """Return whether a run has come to its end, with all its files.

    Raises:
        InputError: The run is damaged.
    """
    return run.begun and run.finished() and run.champion_is_written()


def is_verified(run: Run, config: RunConfig) -> bool:
    """Return whether the champion of a finished run was verified, or cannot be: there are no variants.

    Raises:
        InputError: The verification is damaged, or about another champion.
    """
    return not isinstance(config.simulator.component, SupportsVariants) or run.verification() is not None


def verify_if_missing(run: Run, config: RunConfig) -> None:
    """Verify the champion of a finished run, if nobody has: see :func:`verify_champion`.

    Args:
        run: The run.
        config: Its configuration, from :func:`configuration_of`.

    Raises:
        InputError: The run or its verification is damaged, or another process writes to it.
        RunError: The champion cannot be verified.
    """
    if not is_verified(run, config):
        verify_champion(config, run)


def reopen(
    run: Run, overrides: Sequence[str | Layer], plugins: Plugins, *, allow_different_versions: bool = False
) -> Execution:
    """Return a run ready to go on after its last complete turn.

    Args:
        run: The run; it is open, and closed afterwards.
        overrides: Settings of the executor.
        plugins: The plugins to choose from, which may observe the run.
        allow_different_versions: As for :func:`resume`.

    Raises:
        ConfigurationError: As :func:`resume`.
        InputError: As :func:`resume`.
    """
    lock = acquire_lock(run.directory)
    with released_on_error(lock):
        if not run.outdated():
            return _reopened(run, lock, overrides, plugins, allowed=allow_different_versions)
        run.close()
        with open_run(run.directory) as newer:  # another process was at it, a moment ago
            return _reopened(newer, lock, overrides, plugins, allowed=allow_different_versions)


def _reopened(
    run: Run, lock: Lock, overrides: Sequence[str | Layer], plugins: Plugins, *, allowed: bool
) -> Execution:
    config = configuration_of(run, overrides, plugins)
    changes = _changes(run, config, allowed=allowed)
    if run.begun:
        run.read_all()
    coevolution = assemble(config)
    try:
        if run.begun:
            restore(coevolution, run)
        run.close()  # whoever reads keeps others from writing
        store = open_store(run.directory, config, lock)
        if run.begun:
            _go_on(store, run, changes)
        else:  # killed before its first transaction
            store.begin(list(config.populations), config.deciding())
    except BaseException:
        coevolution.close()
        raise
    usable = plugins.without(config.plugins.block)
    return Execution(config, usable, run.directory, run.config, coevolution, store)


def configuration_of(run: Run, overrides: Sequence[str | Layer], plugins: Plugins) -> RunConfig:
    """Return the configuration of a run, resolved.

    What decides the run must be as it was when it began, in the file as with the overrides.

    Args:
        run: The run.
        overrides: Settings of the executor.
        plugins: The plugins to choose from.

    Raises:
        ConfigurationError: It cannot be accepted, or is not that of the run; says what differs.
        InputError: The run is damaged.
    """
    path = run.directory / CONFIG_FILE
    layers = layers_in(run.config, str(path))
    config = resolve_layers(layers.under(overrides), path.stem, plugins)
    began = run.configuration() if run.begun else resolve_layers(layers, path.stem, plugins).deciding()
    if others := differences(began, config.deciding()):
        raise ConfigurationError(
            _listed(f"{run.directory}: the configuration is not that of the run", others)
        )
    return config


def _changes(run: Run, config: RunConfig, *, allowed: bool) -> list[str]:
    """Return what is not as when the run began, apart from its configuration.

    Raises:
        ConfigurationError: There is something, and that is not allowed.
    """
    changes = differences(run.config.get("provenance", {}), provenance_of(config))
    if changes and not allowed:
        message = f"{run.directory}: not what the run was begun with, so its result may differ"
        todo = "to go on all the same, which is noted: --allow-different-versions"
        raise ConfigurationError(f"{_listed(message, changes)}\n  {todo}")
    return changes


def _listed(message: str, lines: Sequence[str]) -> str:
    return "\n  ".join([f"{message}:", *lines])


def restore(coevolution: Coevolution, saved: Run) -> None:
    """Bring the loop to the end of the last turn.

    Raises:
        InputError: The state is missing, or no state.
    """
    state, last = saved.state(), saved.last_turn()
    if last is None and not state:
        return
    try:
        coevolution.restore(state)
    except Exception as error:
        cause = f"missing {error}" if isinstance(error, KeyError) else str(error)
        raise InputError(f"{saved.directory}: the state cannot be restored: {cause}") from error
    if coevolution.turn != last:
        raise InputError(
            f"{saved.directory}: the state is that after turn {coevolution.turn}, the last one is {last}"
        )


def _go_on(store: Store, saved: Run, changes: Sequence[str]) -> None:
    """Complete or remove what a kill has left half done, and note the resume.

    A run that is finished may lack a file; or another process has finished it a moment ago.
    """
    for path in saved.directory.iterdir():
        if is_leftover(path):
            remove(path)
    store.go_on({table: saved.rows(table) for table in (*CHAINED, *SINGLE)}, changes)
    document = saved.champion_document()
    if document is not None and not saved.champion_is_written():
        champion: Mapping[str, Any] = parsed_json(document)
        store.save_champion(champion, design_from_json(champion["design"]))
