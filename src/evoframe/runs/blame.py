"""Errors of components, with the plugin that offers them and the turn in which they failed."""

from __future__ import annotations

import attrs

from evoframe.contract import RunConfig
from evoframe.errors import ComponentError

__all__ = ["completed"]


def completed(error: ComponentError, config: RunConfig, turn: str) -> ComponentError:
    """Return an error of a component with its name and plugin, and the turn."""
    chosen = dict(config.components()).get(error.component)
    if chosen is None:
        return attrs.evolve(error)
    concerns = ", ".join(part for part in (turn, error.concerns) if part)
    return attrs.evolve(error, offered=f"'{chosen.name}' (plugin {chosen.source})", concerns=concerns)
