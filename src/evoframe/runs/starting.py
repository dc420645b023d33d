"""Start of a run: its components and its directory."""

from __future__ import annotations

import functools
import itertools
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import tomli_w

from evoframe.config import layers_of, load_config
from evoframe.contract import RunConfig
from evoframe.designs import export_all
from evoframe.documents import as_read
from evoframe.errors import InputError, NotEmptyError, OccupiedError
from evoframe.files import LOCK_FILE, Lock, acquire_lock, is_leftover, released_on_error, write_atomically
from evoframe.record import CONFIG_FILE, Run, Store, open_run, provenance_of
from evoframe.registry import Plugins, discover
from evoframe.runs.blame import assembled
from evoframe.runs.execution import Execution
from evoframe.runs.warm_start import starting_genomes

__all__ = ["open_store", "prepare", "run"]


def run(
    config: str | Path | RunConfig = "paper",
    /,
    *,
    seed: int | None = None,
    out: str | Path | None = None,
    workers: int | None = None,
    plugins: Plugins | None = None,
    **settings: Any,
) -> Run:
    """Run a configuration to the end and verify its champion, like the command ``evoframe run``.

    Args:
        config: Name of a preset, path of a TOML file, or a configuration from :func:`load_config`.
        seed: Overrides ``run.seed``.
        out: The run's directory; by default ``runs/<label>-<seed>``, with a counter if that exists.
        workers: Overrides ``executor.workers``.
        plugins: The available plugins, which can observe the run; by default all installed plugins.
        **settings: Further settings by key: ``aggregator="hm"``, ``collaboration={"n": 5}``, or dotted,
            ``**{"collaboration.n": 5}``.

    Returns:
        The finished run.

    Raises:
        ConfigurationError: The configuration is invalid; nothing was run or written.
        InputError: The directory is not empty, or cannot be written.
        RunError: The run cannot continue, or its champion cannot be verified; saved turns are kept.
    """
    plugins = plugins or discover()
    if not isinstance(config, RunConfig):
        overrides = layers_of(settings, {"run.seed": seed, "executor.workers": workers})
        config = load_config(config, overrides=overrides, plugins=plugins)
    elif settings or seed is not None or workers is not None:
        raise TypeError("a RunConfig is complete; pass settings to load_config instead")
    execution = prepare(config, plugins, None if out is None else Path(out))
    finished = execution.play()
    execution.verify(finished)
    return finished


def prepare(config: RunConfig, plugins: Plugins, out: Path | None = None) -> Execution:
    """Start the components of a configuration, and create the directory of its run.

    Args:
        config: The configuration to run.
        plugins: The plugins, which can observe the run unless the configuration blocks them.
        out: The run's directory, missing or empty; by default ``runs/<label>-<seed>``, with a counter if
            that exists.

    Raises:
        ConfigurationError: A component cannot start; no directory was created.
        OccupiedError: The directory contains a run, possibly one just started by another process.
        InputError: The directory is not empty, or cannot be created.
    """
    usable = plugins.without(config.plugins.block)
    coevolution = assembled(config, starting_genomes(config, plugins))
    try:
        directory = _default_directory(config) if out is None else _given_directory(out)
        tables = as_read({**config.recorded(), "provenance": provenance_of(config, usable.observers)})
        return Execution(
            config, usable, directory, tables, coevolution, _new_store(directory, config, tables)
        )
    except BaseException:
        coevolution.close()
        raise


def _new_store(directory: Path, config: RunConfig, tables: Mapping[str, Any]) -> Store:
    lock = acquire_lock(directory)
    with released_on_error(lock):
        _refuse_occupied(directory)  # again, because another process may have been faster
        write_atomically(directory / CONFIG_FILE, tomli_w.dumps(tables).encode())
        store = open_store(directory, config, lock)
        store.begin(list(config.populations), config.deciding())
        return store


def open_store(directory: Path, config: RunConfig, lock: Lock) -> Store:
    """Open the store of a run's directory; its database is created, or keeps its saved turns.

    Raises:
        InputError: The database cannot be written.
    """
    export = functools.partial(export_all, config.simulator.component)
    return Store.open(directory, config.simulation(), lock, export)


def _default_directory(config: RunConfig) -> Path:
    """Create a new directory, so that runs started at the same time get different ones."""
    base = Path("runs") / f"{config.label}-{config.run.seed}"
    counted = (base.with_name(f"{base.name}-{number}") for number in itertools.count(2))
    for directory in itertools.chain([base], counted):
        try:
            directory.mkdir(parents=True)
        except FileExistsError:
            continue
        except OSError as error:
            raise InputError(f"cannot be created: {error.strerror}", source=directory) from error
        return directory
    raise AssertionError  # the counter is infinite


def _given_directory(directory: Path) -> Path:
    try:
        directory.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InputError(f"cannot be used for a run: {error.strerror}", source=directory) from error
    _refuse_occupied(directory)
    return directory


def _refuse_occupied(directory: Path) -> None:
    try:
        names = {path.name for path in directory.iterdir() if not is_leftover(path)} - {LOCK_FILE}
    except OSError as error:
        raise InputError(f"cannot be used for a run: {error.strerror}", source=directory) from error
    if CONFIG_FILE in names:
        with open_run(directory) as there:
            finished = there.begun and there.finished()
        what = "a finished run" if finished else "an unfinished run"
        todo = "" if finished else f", or resume the run: evoframe resume {directory}"
        raise OccupiedError(
            f"directory contains {what}; choose another directory with --out{todo}", source=directory
        )
    if names:
        raise NotEmptyError("directory is not empty; choose another with --out", source=directory)
