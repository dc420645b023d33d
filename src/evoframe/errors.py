"""Types of errors, each with a text for users."""

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
        problem: Value found, value expected, and the remedy.
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
    """A configuration, or an option of a component, that is invalid.

    Components raise it from methods such as ``check`` with a problem only; the core adds source and key.

    Args:
        problem: As for :class:`EvoframeError`, as are *source* and *key*.
        faults: Errors that this one reports together; the text lists them.
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
        """Errors reported together; the error itself if there is only one."""
        return self._faults or (self,)

    def __str__(self) -> str:
        return "\n  ".join([super().__str__(), *map(str, self._faults)])


class InputError(EvoframeError):
    """A file or directory, given by the user, that cannot be read or is invalid."""


class LockedError(InputError):
    """A run directory that another process is writing to."""


class NotEmptyError(InputError):
    """A directory for a new run that is not empty."""


class OccupiedError(NotEmptyError):
    """A directory for a new run that already contains a run."""


class PluginError(EvoframeError):
    """A plugin that is required but cannot be used."""


class RunError(EvoframeError):
    """A run that cannot continue, or a run directory that cannot be used."""


@attrs.frozen(str=False, eq=False)
class ComponentError(RunError):
    """A component that failed or returned an invalid result.

    Attributes:
        component: Dotted key of the component in the configuration, such as ``aggregator``.
        problem: Description of the failure.
        concerns: Individuals affected, such as ``a 1 with b 2``; may be empty.
        keys: Keys of the designs affected, while the individuals are unknown.
        places: Indices of these designs among all designs that are evaluated together.
        offered: Name of the component and the plugin that offers it, if known.
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
    """The loss of an executor's worker while it was processing an item.

    Attributes:
        item: The item that the worker was processing.
    """

    def __init__(self, problem: str, item: Any) -> None:
        super().__init__(problem)
        self.item = item


class PluginWarning(UserWarning):
    """A skipped plugin or a disabled observer; the program continues without it."""
