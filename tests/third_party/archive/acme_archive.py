"""A third-party strategy with a memory: ``record-holders``."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any

import attrs
import numpy as np
from attrs import validators
from numpy.typing import NDArray

from evoframe import (
    Archived,
    Choice,
    CollaborationRun,
    CollaborationStrategy,
    ConfigurationError,
    Judged,
    Member,
    ScoredMeetings,
    hookimpl,
    structure,
)


@attrs.frozen
class RecordHolders:
    """The *n* latest individuals of the other population that took part in a best score of the run.

    The latest record comes first. An individual can be chosen after it has left its population. While there
    are fewer than *n* record holders, the fittest members complete the choice.

    Attributes:
        n: Number of collaborators.
        capacity: Number of record holders kept, the latest ones.
    """

    n: int = attrs.field(default=2, validator=validators.ge(1))
    capacity: int = attrs.field(default=20, validator=validators.ge(1))

    def size(self, n_members: int) -> int:
        if self.n > n_members:
            raise ConfigurationError(
                f"{self.n} record holders requested, but the population has {n_members} members; "
                f"set collaboration.n to {n_members} or less"
            )
        return self.n

    def select(self, members: Sequence[Member], rng: np.random.Generator) -> NDArray[np.intp]:
        """Return the fittest, as before the first record."""
        return np.array(_fittest_first(members)[: self.size(len(members))], dtype=np.intp)

    def start(self, population: str, other: str) -> CollaborationRun:
        return RecordHoldersRun(self, other)


class RecordHoldersRun:
    """The archive of one population's record holders."""

    def __init__(self, strategy: RecordHolders, other: str) -> None:
        self.strategy = strategy
        self.other = other
        self.record: float | None = None
        self.holders: list[Archived] = []

    def choose(
        self, judged: Sequence[Judged], members: Sequence[Member], rng: np.random.Generator
    ) -> Sequence[Sequence[Choice]]:
        n = self.strategy.size(len(members))
        chosen = list(self._available(members))[:n]
        rest = [index for index in _fittest_first(members) if index not in chosen]
        return [chosen + rest[: n - len(chosen)]] * len(judged)

    def _available(self, members: Sequence[Member]) -> Iterator[Choice]:
        """Yield the record holders, the latest first; those that are members still by their index."""
        places = {member.id: index for index, member in enumerate(members)}
        for holder in reversed(self.holders):
            index = places.get(holder.member.id)
            current = holder.member if index is None else members[index]
            if not current.diverged:
                yield holder if index is None else index

    def observe(self, meetings: ScoredMeetings, genome: Callable[[int], Any]) -> None:
        """Add the individual in the best meeting of the turn if its score is a record."""
        clean = np.flatnonzero(~np.isnan(meetings.scores))
        if not len(clean):
            return
        best = int(clean[np.argmax(meetings.scores[clean])])
        score = float(meetings.scores[best])
        if self.record is not None and score <= self.record:
            return
        self.record = score
        column = meetings.populations.index(self.other)
        place = int(meetings.meetings[best, column])
        self._add(meetings.members[column][place], lambda: genome(place))

    def _add(self, member: Member, genome: Callable[[], Any]) -> None:
        if member.diverged:  # in another meeting
            return
        others = [holder for holder in self.holders if holder.member.id != member.id]
        self.holders = [*others, Archived(member, genome())][-self.strategy.capacity :]

    def state(self) -> Any:
        holders = [{"member": attrs.asdict(one.member), "genome": one.genome} for one in self.holders]
        return {"record": self.record, "holders": holders}

    def restore(self, state: Any) -> None:
        saved = structure(state, SavedHolders, ("state",))
        self.record, self.holders = saved.record, list(saved.holders)


@attrs.frozen
class SavedHolders:
    """The state of an archive."""

    record: float | None
    holders: tuple[Archived, ...] = attrs.field()

    @holders.validator
    def _are_different(self, _: Any, holders: tuple[Archived, ...]) -> None:
        ids = [holder.member.id for holder in holders]
        if len(set(ids)) < len(ids):
            raise ValueError(f"expected different individuals, found the ids {ids}")


def _fittest_first(members: Sequence[Member]) -> list[int]:
    def rank(index: int) -> tuple[bool, float, int]:
        member = members[index]
        return member.diverged, -np.inf if member.fitness is None else -member.fitness, index

    return sorted(range(len(members)), key=rank)


@hookimpl
def evoframe_strategies() -> Mapping[str, type[CollaborationStrategy]]:
    return {"record-holders": RecordHolders}
