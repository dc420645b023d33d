"""Errors of components, with the plugin that offers them and the turn in which they failed."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import attrs

from evoframe.contract import RunConfig
from evoframe.errors import ComponentError
from evoframe.evolution import Coevolution, assemble

__all__ = ["assembled", "completed"]


def assembled(config: RunConfig, genomes: Mapping[str, Sequence[Any]] | None = None) -> Coevolution:
    """Return the loop of a configuration; an error of a component names it and its plugin.

    Args:
        config: The configuration.
        genomes: Genomes with which populations start, as for :func:`evoframe.assemble`.

    Raises:
        ConfigurationError: A component cannot start.
        RunError: A component failed.
    """
    try:
        return assemble(config, genomes or {})
    except ComponentError as error:
        raise completed(error, config, "") from error


def completed(error: ComponentError, config: RunConfig, turn: str) -> ComponentError:
    """Return an error of a component with its name and plugin, and the turn."""
    chosen = dict(config.components()).get(error.component)
    if chosen is None:
        return attrs.evolve(error)
    concerns = ", ".join(part for part in (turn, error.concerns) if part)
    return attrs.evolve(error, offered=f"'{chosen.name}' (plugin {chosen.source})", concerns=concerns)
