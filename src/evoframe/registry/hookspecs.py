"""The hooks that plugins implement.

A plugin is a module with functions of these names, marked with :data:`evoframe.hookimpl`, and an entry point
in the group ``evoframe``.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

import pluggy

from evoframe.contract import (
    Aggregator,
    CollaborationStrategy,
    Credit,
    Encoder,
    Evolver,
    Executor,
    Objective,
    RoleProvider,
    Simulator,
    Turn,
)

if TYPE_CHECKING:
    import click

    from evoframe.contract import RunConfig

__all__ = ["hookimpl", "hookspec"]

hookspec = pluggy.HookspecMarker("evoframe")
hookimpl = pluggy.HookimplMarker("evoframe")
"""Marks a function of a plugin as the implementation of a hook."""


@hookspec
def evoframe_simulators() -> Mapping[str, type[Simulator]]:  # type: ignore[empty-body]
    """Offer simulators of designs.

    Returns:
        Name in configuration files -> frozen attrs class, whose fields are the options.

    .. versionadded:: 0.1
    """


@hookspec
def evoframe_encoders() -> Mapping[str, type[Encoder]]:  # type: ignore[empty-body]
    """Offer encoders, which decode networks into parts of a design.

    Returns:
        Name in configuration files -> frozen attrs class, whose fields are the options.

    .. versionadded:: 0.1
    """


@hookspec
def evoframe_strategies() -> Mapping[str, type[CollaborationStrategy]]:  # type: ignore[empty-body]
    """Offer collaboration strategies, which choose collaborators.

    Returns:
        Name in configuration files -> frozen attrs class, whose fields are the options.

    .. versionadded:: 0.1
    """


@hookspec
def evoframe_aggregators() -> Mapping[str, type[Aggregator | Credit]]:  # type: ignore[empty-body]
    """Offer fitness aggregators: of the scores of an individual, or of all meetings of a turn.

    Returns:
        Name in configuration files -> frozen attrs class, whose fields are the options.

    .. versionadded:: 0.1
    """


@hookspec
def evoframe_evolvers() -> Mapping[str, type[Evolver]]:  # type: ignore[empty-body]
    """Offer evolutionary algorithms.

    Returns:
        Name in configuration files -> frozen attrs class, whose fields are the options.

    .. versionadded:: 0.1
    """


@hookspec
def evoframe_objectives() -> Mapping[str, type[Objective]]:  # type: ignore[empty-body]
    """Offer objectives, which score outcomes.

    Returns:
        Name in configuration files -> frozen attrs class, whose fields are the options.

    .. versionadded:: 0.1
    """


@hookspec
def evoframe_executors() -> Mapping[str, type[Executor]]:  # type: ignore[empty-body]
    """Offer executors, which distribute simulations over workers.

    Returns:
        Name in configuration files -> frozen attrs class, whose fields are the options.

    .. versionadded:: 0.1
    """


@hookspec
def evoframe_roles() -> Mapping[str, type[RoleProvider]]:  # type: ignore[empty-body]
    """Offer providers of roles that no population evolves.

    Returns:
        Name in configuration files -> frozen attrs class, whose fields are the options.

    .. versionadded:: 0.1
    """


@hookspec
def evoframe_run_started(config: RunConfig, directory: Path) -> None:
    """Observe the start or resumption of a run.

    Args:
        config: The resolved configuration.
        directory: The run's directory.

    .. versionadded:: 0.1
    """


@hookspec
def evoframe_turn_finished(turn: Turn) -> None:
    """Observe a turn that is already saved.

    An observer that raises is disabled with a warning; the run and the other observers continue.

    .. versionadded:: 0.1
    """


@hookspec
def evoframe_run_finished(directory: Path, completed: bool) -> None:
    """Observe the end of a run.

    Args:
        directory: The run's directory.
        completed: False if the run was interrupted.

    .. versionadded:: 0.1
    """


@hookspec
def evoframe_commands(cli: click.Group) -> None:
    """Add commands to the command line.

    Args:
        cli: The click group ``evoframe``.

    .. versionadded:: 0.1
    """
