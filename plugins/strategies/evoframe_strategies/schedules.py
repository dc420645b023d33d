"""The strategy ``scheduled``: another one, with numbers of collaborators that change over turns."""

from __future__ import annotations

import bisect
import itertools
from collections.abc import Sequence
from typing import Any

import attrs
import numpy as np
from attrs import validators

from evoframe import (
    Choice,
    Chosen,
    CollaborationRun,
    CollaborationStrategy,
    ConfigurationError,
    Judged,
    Member,
    ScoredMeetings,
    sizes_of,
    started,
    structure,
)
from evoframe_strategies.fittest import Fittest
from evoframe_strategies.memory import Genome, first_choice
from evoframe_strategies.nesting import Starter, built_in, restored
from evoframe_strategies.ranking import Indices

__all__ = ["Scheduled"]


def _ascend_from_0(_: Any, __: Any, turns: Sequence[int]) -> None:
    if turns[:1] != (0,) or any(later <= earlier for earlier, later in itertools.pairwise(turns)):
        raise ValueError(f"expected ascending numbers of turns, the first of them 0, found {list(turns)}")


def _has_a_number_n(_: Any, __: Any, strategy: Chosen[CollaborationStrategy]) -> None:
    if type(getattr(strategy.component, "n", None)) is not int:
        raise ValueError(
            f"expected a strategy with a whole number as its option 'n', found '{strategy.name}'"
        )


@attrs.frozen
class Scheduled:
    """Another strategy, whose option ``n`` changes over the turns of a run.

    Stage i sets it to ``n[i]``, after the choosing population has had ``since[i]`` turns. Only turns in which
    collaborators are chosen count: the initial turn, in which everybody meets everybody, does not. Turns are
    no share of the run, so that a longer run begins like a shorter one. Each stage has its own memory, which
    sees all turns. Source: Panait and Luke 2005, "Time-dependent collaboration schemes for cooperative
    coevolutionary algorithms", AAAI Fall Symposium (many collaborators at first, later few).

    Attributes:
        strategy: A strategy with an option ``n``, which the schedule sets.
        n: Values of this option, one for each stage.
        since: Number of turns before each stage; the first is 0.
    """

    strategy: Chosen[CollaborationStrategy] = attrs.field(
        default=built_in("fittest", Fittest()), validator=_has_a_number_n
    )
    n: tuple[int, ...] = attrs.field(default=(5, 2), validator=validators.deep_iterable(validators.ge(1)))
    since: tuple[int, ...] = attrs.field(default=(0, 50), validator=_ascend_from_0)

    def __attrs_post_init__(self) -> None:
        if len(self.n) != len(self.since):
            raise ValueError(
                "expected as many values of 'n' as of 'since', "
                f"found n = {list(self.n)} and since = {list(self.since)}"
            )
        self.stages()

    def stages(self) -> list[CollaborationStrategy]:
        """Return the strategy of each stage."""
        component: Any = self.strategy.component
        return [attrs.evolve(component, n=n) for n in self.n]

    def size(self, n_members: int) -> int:
        """Return the number of collaborators in the first stage; require enough members for all stages."""
        self.sizes(n_members)
        return self.stages()[0].size(n_members)

    def sizes(self, n_members: int) -> Sequence[int]:
        """Return the numbers of collaborators of all stages."""
        return [
            size
            for n, stage in zip(self.n, self.stages(), strict=True)
            for size in _sizes(stage, n, n_members)
        ]

    def select(self, members: Sequence[Member], rng: np.random.Generator) -> Indices:
        """Return the indices of *members* that are chosen in the first turn."""
        return first_choice(self.start("", ""), members, rng)

    def start(self, population: str, other: str) -> CollaborationRun:
        """Start in the first stage."""
        return _ScheduledRun(
            self.since, lambda: [started(stage, population, other) for stage in self.stages()]
        )


def _sizes(stage: CollaborationStrategy, n: int, n_members: int) -> tuple[int, ...]:
    try:
        return sizes_of(stage, n_members)
    except ConfigurationError as error:
        raise ConfigurationError(
            f"n = {n} is not possible in a population of {n_members} members; "
            "set smaller numbers in the schedule of collaborators, collaboration.n"
        ) from error


@attrs.frozen
class _SavedSchedule:
    turns: int = attrs.field(validator=validators.ge(0))
    has_chosen: bool
    stages: tuple[Any, ...]


class _ScheduledRun:
    def __init__(self, since: Sequence[int], start: Starter) -> None:
        self._since = since
        self._start = start
        self._runs = start()
        self._turns = 0
        self._has_chosen = False

    def choose(
        self, judged: Sequence[Judged], members: Sequence[Member], rng: np.random.Generator
    ) -> Sequence[Sequence[Choice]]:
        self._has_chosen = True
        return self._runs[bisect.bisect_right(self._since, self._turns) - 1].choose(judged, members, rng)

    def observe(self, meetings: ScoredMeetings, genome: Genome) -> None:
        """Count the turn if collaborators were chosen in it, however often."""
        for run in self._runs:
            run.observe(meetings, genome)
        self._turns += self._has_chosen
        self._has_chosen = False

    def state(self) -> Any:
        stages = [run.state() for run in self._runs]
        return {"turns": self._turns, "has_chosen": self._has_chosen, "stages": stages}

    def restore(self, state: Any) -> None:
        saved = structure(state, _SavedSchedule, ("state",))
        self._runs = restored(self._start, saved.stages)
        self._turns, self._has_chosen = saved.turns, saved.has_chosen
