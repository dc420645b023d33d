"""Options that ``threads`` and ``processes`` share."""

from __future__ import annotations

import os
from collections.abc import Callable
from typing import Any

import attrs
from attrs import validators

__all__ = ["available_cores", "overdue", "time_limit", "worker_count"]


def worker_count() -> Any:
    """Return the field ``workers``: how many work at once; 0 takes one for each core."""
    return attrs.field(default=0, validator=[validators.ge(0), validators.le(1024)])


def time_limit() -> Any:
    """Return the field ``batch_time_limit``: seconds, or ``None``, which is the default."""
    return attrs.field(default=None, validator=validators.optional(validators.gt(0.0)))


def overdue(limit: float | None) -> str:
    """Return how a message says that something took longer than *limit*."""
    return f"took longer than executor.batch_time_limit = {limit} seconds"


def available_cores() -> int:
    """Return the number of cores that this process may use, which a container or a job may have limited."""
    process_cpu_count: Callable[[], int | None] | None = getattr(os, "process_cpu_count", None)
    if process_cpu_count is not None:  # Python 3.13 and later
        return process_cpu_count() or 1
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1
