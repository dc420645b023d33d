"""Runs that go on where they were left, bit for bit as if nothing had happened."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from evoframe.record.champion import design_from_json, parsed_json
from evoframe.record.checksums import CHAINED
from evoframe.evolution.coevolution import Coevolution
from evoframe.contract.config import RunConfig
from evoframe.errors import ConfigurationError, InputError
from evoframe.config.layers import Layer, layers_of
from evoframe.record.run import Run, has_begun, load_run, run_tables
from evoframe.files.locks import locked, released_on_error
from evoframe.registry.observers import Observers
from evoframe.registry.registry import Plugins
from evoframe.record.provenance import differences, provenance
from evoframe.config.resolve import load_config
from evoframe.runs.execution import Execution, assemble, opened_store, verify_champion
from evoframe.record.store import CONFIG_FILE, Store, is_leftover, remove
from evoframe.record.verification import can_verify

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
    directory = Path(directory)
    overrides = layers_of({"executor.workers": workers})
    if is_finished(directory):
        verify_if_missing(directory, overrides, plugins)
        return load_run(directory)
    execution = reopen(directory, overrides, plugins, allow_different_versions=allow_different_versions)
    execution.play(Observers(execution.config.discovered.manager))
    execution.verify()
    return load_run(directory)


def is_finished(directory: Path) -> bool:
    """Return whether a run's directory holds a run that has come to its end, with all its files.

    Raises:
        InputError: It is no run's directory, or damaged.
    """
    run_tables(directory)
    if not has_begun(directory):
        return False
    run = load_run(directory)
    return run.finished and run.champion_is_written


def is_verified(finished: Run, config: RunConfig) -> bool:
    """Return whether the champion of a finished run was verified, or cannot be: there are no variants.

    Raises:
        InputError: The verification is damaged, or about another champion.
    """
    return not can_verify(config.simulator.component) or finished.verification is not None


def verify_if_missing(
    directory: Path, overrides: Sequence[str | Layer] = (), plugins: Plugins | None = None
) -> None:
    """Verify the champion of a finished run, if nobody has: see :func:`~evoframe.runs.execution.verify_champion`.

    Args:
        directory: The run's directory.
        overrides: Settings of the executor.
        plugins: The plugins to choose from.

    Raises:
        ConfigurationError: The configuration cannot be accepted, or is not that of the run.
        InputError: The run or its verification is damaged, or another process writes to it.
        RunError: The champion cannot be verified.
    """
    config = configuration_of(directory, overrides, plugins)
    if not is_verified(load_run(directory), config):
        verify_champion(config, directory)


def reopen(
    directory: Path,
    overrides: Sequence[str | Layer] = (),
    plugins: Plugins | None = None,
    *,
    allow_different_versions: bool = False,
) -> Execution:
    """Return a run ready to go on after its last complete turn.

    Args:
        directory: The run's directory.
        overrides: Settings of the executor.
        plugins: The plugins to choose from.
        allow_different_versions: As for :func:`resume`.

    Raises:
        ConfigurationError: As :func:`resume`.
        InputError: As :func:`resume`.
    """
    run_tables(directory)
    lock = locked(directory)
    with released_on_error(lock):
        config = configuration_of(directory, overrides, plugins)
        saved = load_run(directory) if has_begun(directory) else None
        changes = _changes(directory, config, allowed=allow_different_versions)
        coevolution = assemble(config)
        try:
            if saved is not None:
                restore(coevolution, saved)
            store = opened_store(directory, config, lock)
            if saved is None:  # killed before its first transaction
                store.begin(list(config.populations), config.deciding())
            else:
                _go_on(store, saved, changes)
        except BaseException:
            coevolution.close()
            raise
        return Execution(config, directory, coevolution, store)


def configuration_of(directory: Path, overrides: Sequence[str | Layer], plugins: Plugins | None) -> RunConfig:
    """Return the configuration of a run, which is complete: it must not make us read other files.

    What decides the run must be as it was when it began, in the file as with the overrides.

    Args:
        directory: The run's directory.
        overrides: Settings of the executor.
        plugins: The plugins to choose from.

    Raises:
        ConfigurationError: It cannot be accepted, or is not that of the run; says what differs.
        InputError: It is not complete, or the run is damaged.
    """
    run_tables(directory)  # refuses what would make us look elsewhere
    path = directory / CONFIG_FILE
    config = load_config(path, overrides=overrides, plugins=plugins)
    if has_begun(directory):
        began: Mapping[str, Any] = load_run(directory).configuration
    else:
        began = load_config(path, plugins=plugins).deciding()
    others = differences(began, config.deciding())
    if others:
        raise ConfigurationError(_listed(f"{directory}: the configuration is not that of the run", others))
    return config


def _changes(directory: Path, config: RunConfig, *, allowed: bool) -> list[str]:
    """Return what is not as when the run began, apart from its configuration.

    Raises:
        ConfigurationError: There is something, and that is not allowed.
    """
    changes = differences(run_tables(directory).get("provenance", {}), provenance(config))
    if changes and not allowed:
        todo = "to go on all the same, which is noted: --allow-different-versions"
        raise ConfigurationError(
            _listed(f"{directory}: not what the run was begun with, so its result may differ", changes)
            + f"\n  {todo}"
        )
    return changes


def _listed(message: str, lines: Sequence[str]) -> str:
    return "\n  ".join([f"{message}:", *lines])


def restore(coevolution: Coevolution, saved: Run) -> None:
    """Bring the loop to the end of the last turn.

    Raises:
        InputError: The state is missing, or no state.
    """
    state, last = saved.state, saved.last_turn
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
    rows: Mapping[str, Any] = {table: saved.rows(table) for table in CHAINED}
    resume = None if saved.finished else (len(rows["resumes"]), saved.last_turn, json.dumps(changes))
    store.go_on(rows, resume)
    if saved.champion_document is not None and not saved.champion_is_written:
        champion = parsed_json(saved.champion_document)
        store.save_champion(champion, design_from_json(champion["design"]))
