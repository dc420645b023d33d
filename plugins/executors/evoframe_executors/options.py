"""Options that ``threads`` and ``processes`` share."""

from __future__ import annotations

from typing import Any

import attrs
from attrs import validators

__all__ = ["overdue", "time_limit", "worker_count"]


def worker_count() -> Any:
    """Return the field ``workers``: number of parallel workers; 0 uses one per core."""
    return attrs.field(default=0, validator=[validators.ge(0), validators.le(1024)])


def time_limit() -> Any:
    """Return the field ``batch_time_limit``: seconds, or ``None`` (the default) for no limit."""
    return attrs.field(default=None, validator=validators.optional(validators.gt(0.0)))


def overdue(limit: float | None) -> str:
    """Return the message for work that took longer than *limit*."""
    return f"took longer than executor.batch_time_limit = {limit} seconds"
