"""Number of cores that are available to this process."""

from __future__ import annotations

import os
from collections.abc import Callable

__all__ = ["available_cores"]


def available_cores() -> int:
    """Return the number of cores that this process may use, within the limits of a container or job."""
    process_cpu_count: Callable[[], int | None] | None = getattr(os, "process_cpu_count", None)
    if process_cpu_count is not None:  # Python 3.13 and later
        return process_cpu_count() or 1
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1
