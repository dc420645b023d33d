"""CPU time of the stages of a program, measured by temporary wrappers around its methods."""

from __future__ import annotations

import contextlib
import functools
import threading
import time
from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator
from typing import Any, TypeAlias
from unittest import mock

import attrs

__all__ = ["Stages", "Watched"]

Watched: TypeAlias = tuple[type, str, str]
"""Class, name of a method, name of the stage to which its calls belong."""


class _Nesting(threading.local):
    """The nested stages of a thread, each with the CPU time of its inner stages, s."""

    def __init__(self) -> None:
        self.left: list[float] = []


@attrs.define
class Stages:
    """CPU time of stages in all threads of a program; the time of a stage excludes its inner stages.

    Attributes:
        cpu: Stage -> CPU time, s.
        calls: Stage -> number of calls.
        spans: Stage -> start and end of each call, s of wall clock.
    """

    cpu: defaultdict[str, float] = attrs.field(factory=lambda: defaultdict(float))
    calls: defaultdict[str, int] = attrs.field(factory=lambda: defaultdict(int))
    spans: dict[str, list[tuple[float, float]]] = attrs.field(factory=dict)
    _nesting: _Nesting = attrs.field(factory=_Nesting)
    _lock: threading.Lock = attrs.field(factory=threading.Lock)

    @contextlib.contextmanager
    def watch(self, methods: Iterable[Watched]) -> Iterator[None]:
        """Measure methods of classes within a ``with`` block."""
        with contextlib.ExitStack() as stack:
            for owner, name, stage in methods:
                wrapped = self._wrapped(getattr(owner, name), stage)
                stack.enter_context(mock.patch.object(owner, name, wrapped))
            yield

    def elapsed(self, stage: str) -> float:
        """Return the time, s of wall clock, during which at least one thread was in a stage."""
        total, reached = 0.0, 0.0
        for begin, end in sorted(self.spans.get(stage, ())):
            total += max(0.0, end - max(begin, reached))
            reached = max(reached, end)
        return total

    def _wrapped(self, function: Callable[..., Any], stage: str) -> Callable[..., Any]:
        @functools.wraps(function)
        def watched(*arguments: Any, **options: Any) -> Any:
            with self._entered(stage):
                return function(*arguments, **options)

        return watched

    @contextlib.contextmanager
    def _entered(self, stage: str) -> Iterator[None]:
        left = self._nesting.left
        left.append(0.0)
        begin, began = time.perf_counter(), time.thread_time()
        try:
            yield
        finally:
            spent, end = time.thread_time() - began, time.perf_counter()
            own = spent - left.pop()
            if left:
                left[-1] += spent
            with self._lock:
                self.cpu[stage] += own
                self.calls[stage] += 1
                self.spans.setdefault(stage, []).append((begin, end))
