"""Observers of a run, each notified separately; none can stop the run."""

from __future__ import annotations

import warnings
from typing import Any

import pluggy

from evoframe.errors import PluginWarning
from evoframe.messages import cause_of

__all__ = ["Observers"]


class Observers:
    """The plugins of a manager that implement lifecycle hooks."""

    def __init__(self, manager: pluggy.PluginManager) -> None:
        self._manager = manager
        self._plugins = [plugin for _, plugin in manager.list_name_plugin() if plugin is not None]
        self._active = list(self._plugins)

    def tell(self, hook: str, **arguments: Any) -> None:
        """Call *hook* of every observer; one that raises is disabled with a warning.

        Warns:
            PluginWarning: An observer raised.
        """
        listening = [implementation.plugin for implementation in self._caller(hook).get_hookimpls()]
        for plugin in [plugin for plugin in self._active if plugin in listening]:
            others = [other for other in self._plugins if other is not plugin]
            try:
                self._manager.subset_hook_caller(hook, others)(**arguments)
            except (Exception, SystemExit) as error:  # noqa: BLE001 - no observer can stop the run
                self._active.remove(plugin)
                name = self._manager.get_name(plugin)
                warnings.warn(
                    f"observer '{name}' is disabled: {cause_of(error)}", PluginWarning, stacklevel=2
                )

    def _caller(self, hook: str) -> pluggy.HookCaller:
        caller: pluggy.HookCaller = getattr(self._manager.hook, hook)
        return caller
