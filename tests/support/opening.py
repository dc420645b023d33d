"""Queries of runs by their directories, which are opened and closed for each query."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from evoframe.contract.config import RunConfig
from evoframe.record.run import open_run
from evoframe.registry.registry import Plugins
from evoframe.runs import restoring, resuming
from evoframe.runs.execution import Execution

__all__ = ["configuration_of", "has_begun", "is_finished", "reopened"]


def has_begun(directory: Path) -> bool:
    with open_run(directory) as run:
        return run.begun


def is_finished(directory: Path) -> bool:
    with open_run(directory) as run:
        return resuming.is_finished(run)


def reopened(directory: Path, plugins: Plugins, overrides: Sequence[str] = ()) -> Execution:
    with open_run(directory) as run:
        return resuming.reopen(run, overrides, plugins)


def configuration_of(directory: Path, overrides: Sequence[str], plugins: Plugins) -> RunConfig:
    with open_run(directory) as run:
        return restoring.configuration_of(run, overrides, plugins)
