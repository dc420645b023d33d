"""Strategies as options of other strategies, and the states of their runs."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from evoframe import Chosen, CollaborationRun, CollaborationStrategy, Source, __version__

__all__ = ["Starter", "built_in", "restored"]

_SOURCE = Source("evoframe", __version__, "strategies")

Starter = Callable[[], list[CollaborationRun]]
"""Starts new runs of all nested strategies."""


def built_in(name: str, component: CollaborationStrategy) -> Chosen[CollaborationStrategy]:
    """Return a strategy of this plugin as a configuration chooses it, for defaults."""
    return Chosen(name, component, _SOURCE)


def restored(start: Starter, states: Sequence[Any]) -> list[CollaborationRun]:
    """Return new runs that continue from *states*.

    Raises:
        ValueError: There is not one state for each run, or one is invalid.
    """
    runs = start()
    if len(states) != len(runs):
        raise ValueError(f"expected the states of {len(runs)} strategies, found {len(states)}")
    for run, state in zip(runs, states, strict=True):
        run.restore(state)
    return runs
