"""The executor ``serial``."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import ClassVar, TypeVar

import attrs

from evoframe import ExecutorRun

__all__ = ["InThisThread", "Serial"]

T = TypeVar("T")
R = TypeVar("R")


@attrs.frozen
class Serial:
    """One item after the other, in the thread that asks."""

    def start(self) -> ExecutorRun:
        """Return the one worker."""
        return InThisThread()


class InThisThread:
    """The worker of ``serial``."""

    workers: ClassVar[int] = 1

    def map(self, function: Callable[[T], R], items: Iterable[T]) -> list[R]:
        """Work on the items one by one."""
        return [function(item) for item in items]

    def close(self) -> None:
        """Do nothing: there is nobody to let go."""
