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
    """No parallelism: the calling thread simulates one batch after another."""

    def start(self) -> ExecutorRun:
        """Return the single worker."""
        return InThisThread()


class InThisThread:
    """The worker of ``serial``: the calling thread."""

    workers: ClassVar[int] = 1

    def map(self, function: Callable[[T], R], items: Iterable[T]) -> list[R]:
        """Process the items one by one."""
        return [function(item) for item in items]

    def close(self) -> None:
        """Do nothing: there are no workers to shut down."""
