"""What can go wrong, as types; every one of them is meant to be read by a person."""

from __future__ import annotations

from collections.abc import Sequence
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
    """Base of all errors that evoframe raises on purpose; the command line prints only their text.

    The text is ``source: key: problem``, without the parts that are empty.

    Attributes:
        problem: Value found, value expected, and what to do.
        source: File, directory or command-line option that the error is about.
        key: Dotted key, table or element in it, such as ``populations.controller.size``.
    """

    source: str = ""
    key: str = ""

    def __init__(self, problem: str = "", *, source: object = "", key: str = "") -> None:
        super().__init__(problem)
        self.problem = problem
        self.source = str(source)
        self.key = key

    def __str__(self) -> str:
        return ": ".join(part for part in (self.source, self.key, self.problem) if part)


class ConfigurationError(EvoframeError):
    """A configuration, or an option of a component, that is not valid.

    Components raise it from methods such as ``check`` with a problem only; the core adds source and key.

    Args:
        problem: As for :class:`EvoframeError`, as are *source* and *key*.
        faults: The errors that this one reports together; the text lists them.
    """

    def __init__(
        self,
        problem: str = "",
        *,
        source: object = "",
        key: str = "",
        faults: Sequence[ConfigurationError] = (),
    ) -> None:
        super().__init__(problem, source=source, key=key)
        self._faults = tuple(faults)

    @property
    def faults(self) -> tuple[ConfigurationError, ...]:
        """The errors reported together; the error itself if it is the only one."""
        return self._faults or (self,)

    def __str__(self) -> str:
        return "\n  ".join([super().__str__(), *map(str, self._faults)])


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
    """A worker of an executor was lost, together with the item that it was processing.

    Attributes:
        item: The item that it was processing.
    """

    def __init__(self, problem: str, item: Any) -> None:
        super().__init__(problem)
        self.item = item


class PluginWarning(UserWarning):
    """A plugin was skipped, or an observer was disabled; the program goes on without it."""
