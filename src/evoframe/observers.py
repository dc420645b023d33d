"""Observers of a run: each is told on its own, and none can stop the run."""

from __future__ import annotations

import warnings
from typing import Any

import pluggy

from evoframe.errors import PluginWarning

__all__ = ["Observers"]


class Observers:
    """The plugins of a manager that listen to the lifecycle hooks."""

    def __init__(self, manager: pluggy.PluginManager) -> None:
        self._manager = manager
        self._active = list(manager.get_plugins())

    def tell(self, hook: str, **arguments: Any) -> None:
        """Call *hook* of every observer; one that raises is disabled with a warning.

        Warns:
            PluginWarning: An observer raised.
        """
        listeners = {implementation.plugin for implementation in self._implementations(hook)}
        for plugin in [plugin for plugin in self._active if plugin in listeners]:
            others = [other for other in listeners if other is not plugin]
            try:
                self._manager.subset_hook_caller(hook, others)(**arguments)
            except Exception as error:  # noqa: BLE001 - whatever an observer does, the run goes on
                self._active.remove(plugin)
                name = self._manager.get_name(plugin)
                cause = f"{type(error).__name__}: {error}"
                warnings.warn(f"observer '{name}' is disabled: {cause}", PluginWarning, stacklevel=2)

    def _implementations(self, hook: str) -> list[pluggy.HookImpl]:
        return list(getattr(self._manager.hook, hook).get_hookimpls())
