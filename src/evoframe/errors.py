"""What can go wrong, as types; every one of them is meant to be read by a person."""

from __future__ import annotations

from typing import Any

import attrs

__all__ = [
    "ComponentError",
    "ConfigurationError",
    "EvoframeError",
    "InputError",
    "LockedError",
    "NotEmptyError",
    "OccupiedError",
    "PluginError",
    "PluginWarning",
    "RunError",
    "WorkerError",
]


class EvoframeError(Exception):
    """Base of all errors that evoframe raises on purpose; the command line shows only their text."""


class ConfigurationError(EvoframeError):
    """A configuration, or an option of a component, that cannot be accepted.

    A component raises it from ``check``-like methods with a message in the user's words; the core adds the
    file and the key.
    """


class InputError(EvoframeError):
    """A file given by the user that cannot be read, or that is not what it should be."""


class LockedError(InputError):
    """A run's directory that another process is writing to."""


class NotEmptyError(InputError):
    """A directory for a new run that has something in it."""


class OccupiedError(NotEmptyError):
    """A directory for a new run that holds a run already."""


class PluginError(EvoframeError):
    """A plugin that the configuration asks for cannot be used."""


class RunError(EvoframeError):
    """A run that cannot go on, or a run directory that cannot be used."""


@attrs.frozen(str=False, eq=False)
class ComponentError(RunError):
    """A component failed, or returned what it must not.

    Attributes:
        component: Its dotted key in a configuration, such as ``aggregator``.
        problem: What it did.
        concerns: Which individuals it was about; may be empty.
        keys: The keys of the designs that it was about, if only they are known.
        places: Their places among all designs that are evaluated together.
        offered: Its name, and the plugin that offers it, where that is known.
    """

    component: str
    problem: str
    concerns: str = ""
    keys: tuple[bytes, ...] = ()
    places: tuple[int, ...] = ()
    offered: str = ""

    def __str__(self) -> str:
        offered = f"{self.offered}: " if self.offered else ""
        about = f" ({self.concerns})" if self.concerns else ""
        return f"{self.component}: {offered}{self.problem}{about}"


class WorkerError(RunError):
    """A worker of an executor was lost with what it was doing.

    Attributes:
        problem: What happened, as the end of a sentence about what it was doing.
        item: What it was doing.
    """

    def __init__(self, problem: str, item: Any) -> None:
        super().__init__(problem)
        self.problem = problem
        self.item = item


class PluginWarning(UserWarning):
    """A plugin was skipped, or an observer was disabled; the program goes on without it."""
