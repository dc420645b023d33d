"""Executors that use the cores of this computer: ``serial``, ``threads`` and ``processes``."""

from __future__ import annotations

from collections.abc import Mapping

from evoframe import Executor, hookimpl
from evoframe_executors.processes import Processes
from evoframe_executors.serial import Serial
from evoframe_executors.threads import Threads

__all__ = ["Processes", "Serial", "Threads"]


@hookimpl
def evoframe_executors() -> Mapping[str, type[Executor]]:
    """Register the executors that use this computer only."""
    return {"processes": Processes, "serial": Serial, "threads": Threads}
