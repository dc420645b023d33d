"""The choices of any collaboration strategy during a run, whatever it offers."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import attrs
import numpy as np

from evoframe.contract.optional import SupportsEach, SupportsMemory, SupportsSizes
from evoframe.contract.protocols import CollaborationRun, CollaborationStrategy
from evoframe.contract.values import Choice, Judged, Member, ScoredMeetings

__all__ = ["sizes_of", "started"]


def started(strategy: CollaborationStrategy, population: str, other: str) -> CollaborationRun:
    """Return the choices of a *strategy* for the individuals of *population* among those of *other*.

    Strategies that combine others start them with it.
    """
    if isinstance(strategy, SupportsMemory):
        return strategy.start(population, other)
    return _EachRun(strategy) if isinstance(strategy, SupportsEach) else _CommonRun(strategy)


def sizes_of(strategy: CollaborationStrategy, n_members: int) -> tuple[int, ...]:
    """Return all numbers of collaborators that a strategy may choose, ascending.

    Raises:
        ConfigurationError: The population is too small.
    """
    if isinstance(strategy, SupportsSizes):
        return tuple(sorted(set(strategy.sizes(n_members))))
    return (strategy.size(n_members),)


class _Stateless:
    """Base of the runs of strategies without a memory."""

    def observe(self, meetings: ScoredMeetings, genome: Callable[[int], Any]) -> None:
        """See a turn, which changes nothing."""

    def state(self) -> None:
        """Return the state, which is empty."""

    def restore(self, state: Any) -> None:
        """Accept the empty state."""
        if state is not None:
            raise ValueError(f"expected no state, found {state!r}")


@attrs.frozen
class _CommonRun(_Stateless):
    """One choice for all individuals."""

    strategy: CollaborationStrategy

    def choose(
        self, judged: Sequence[Judged], members: Sequence[Member], rng: np.random.Generator
    ) -> Sequence[Sequence[Choice]]:
        chosen = np.asarray(self.strategy.select(members, rng)).tolist()
        return [chosen] * len(judged)


@attrs.frozen
class _EachRun(_Stateless):
    """A choice for each individual."""

    strategy: SupportsEach

    def choose(
        self, judged: Sequence[Judged], members: Sequence[Member], rng: np.random.Generator
    ) -> Sequence[Sequence[Choice]]:
        rows: list[list[int]] = np.asarray(self.strategy.select_each(judged, members, rng)).tolist()
        return rows
