"""The strategy ``sum``: several strategies side by side, whose choices are added."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from typing import Any

import attrs
import numpy as np
from attrs import validators

from evoframe import (
    Archived,
    Choice,
    Chosen,
    CollaborationRun,
    CollaborationStrategy,
    ConfigurationError,
    Judged,
    Member,
    ScoredMeetings,
    SupportsMemory,
    sizes_of,
    started,
    structure,
)
from evoframe_strategies.archives import HallOfFame
from evoframe_strategies.chance import Random
from evoframe_strategies.fittest import Fittest
from evoframe_strategies.memory import Genome, first_choice
from evoframe_strategies.nesting import Starter, built_in, restored
from evoframe_strategies.ranking import Indices, best_first

__all__ = ["Sum"]

_DEFAULT_PARTS = (
    built_in("fittest", Fittest(n=1)),
    built_in("random", Random(n=1)),
    built_in("hall-of-fame", HallOfFame(n=1)),
)


@attrs.frozen
class Sum:
    """The collaborators of several strategies, all different: such as 2 fittest, 1 random, 1 from an archive.

    Each part chooses among the members that earlier parts left. It is asked once for all individuals for
    which earlier parts chose the same collaborators. An archived individual that an earlier part has chosen,
    as a member or archived, is replaced by the fittest member left. ECJ combines its kinds of collaborators
    in this way (Luke et al., ``ec.coevolve.MultiPopCoevolutionaryEvaluator``), and Rosin and Belew 1997, "New
    methods for competitive coevolution", current members with those of a hall of fame.

    Attributes:
        parts: The strategies, each with its own options, in the order in which they choose.
    """

    parts: tuple[Chosen[CollaborationStrategy], ...] = attrs.field(
        default=_DEFAULT_PARTS, validator=validators.min_len(1)
    )

    def size(self, n_members: int) -> int:
        """Return the number of collaborators while no part has archived individuals."""
        self.sizes(n_members)
        left = n_members
        for part in self.parts:
            left -= part.component.size(left)
        return n_members - left

    def sizes(self, n_members: int) -> Sequence[int]:
        """Return all sums of the numbers of collaborators that the parts may choose."""
        reached = {(0, n_members)}
        for index in range(len(self.parts)):
            reached = {
                after for chosen, left in reached for after in self._after(index, chosen, left, n_members)
            }
        return sorted({chosen for chosen, _ in reached})

    def _after(self, index: int, chosen: int, left: int, n_members: int) -> Iterator[tuple[int, int]]:
        """Yield the possible numbers of chosen individuals and of members left after a part has chosen."""
        part = self.parts[index].component
        try:
            sizes = sizes_of(part, left)
        except ConfigurationError as error:
            raise ConfigurationError(
                f"parts[{index}], '{self.parts[index].name}', cannot choose among the {left} of {n_members} "
                "members that earlier parts may leave; set smaller numbers in collaboration.parts"
            ) from error
        for size in sizes:
            # Archived individuals leave members that a part without a memory would have chosen.
            most_left = left if isinstance(part, SupportsMemory) else left - size
            yield from ((chosen + size, still) for still in range(max(left - size, 0), most_left + 1))

    def select(self, members: Sequence[Member], rng: np.random.Generator) -> Indices:
        """Return the indices of *members* that are chosen in the first turn."""
        return first_choice(self.start("", ""), members, rng)

    def start(self, population: str, other: str) -> CollaborationRun:
        """Start all parts."""
        return _SumRun(lambda: [started(part.component, population, other) for part in self.parts])


@attrs.frozen
class _SavedSum:
    parts: tuple[Any, ...]


class _SumRun:
    def __init__(self, start: Starter) -> None:
        self._start = start
        self._runs = start()

    def choose(
        self, judged: Sequence[Judged], members: Sequence[Member], rng: np.random.Generator
    ) -> Sequence[Sequence[Choice]]:
        rows: list[list[Choice]] = [[] for _ in judged]
        for run in self._runs:
            for taken, group in _grouped(rows, members):
                added = _added(run, [judged[place] for place in group], members, taken, rng)
                for place, choices in zip(group, added, strict=True):
                    rows[place] += choices
        return rows

    def observe(self, meetings: ScoredMeetings, genome: Genome) -> None:
        for run in self._runs:
            run.observe(meetings, genome)

    def state(self) -> Any:
        return {"parts": [run.state() for run in self._runs]}

    def restore(self, state: Any) -> None:
        self._runs = restored(self._start, structure(state, _SavedSum, ("state",)).parts)


def _grouped(
    rows: Sequence[Sequence[Choice]], members: Sequence[Member]
) -> list[tuple[frozenset[int], list[int]]]:
    """Return the different sets of ids in *rows* of choices, each with the places of its rows."""
    groups: dict[frozenset[int], list[int]] = {}
    for place, row in enumerate(rows):
        groups.setdefault(frozenset(_ids(row, members)), []).append(place)
    return [*groups.items()]


def _added(
    run: CollaborationRun,
    judged: Sequence[Judged],
    members: Sequence[Member],
    taken: frozenset[int],
    rng: np.random.Generator,
) -> Iterator[list[Choice]]:
    """Yield what a part chooses for each of *judged* among the *members* whose ids are not *taken*."""
    left = [index for index, member in enumerate(members) if member.id not in taken]
    for row in run.choose(judged, [members[index] for index in left], rng):
        choices = [choice if isinstance(choice, Archived) else left[choice] for choice in row]
        yield _without_taken(choices, members, taken)


def _without_taken(row: list[Choice], members: Sequence[Member], taken: frozenset[int]) -> list[Choice]:
    """Return *row* with the fittest other *members* in place of individuals whose ids are *taken*."""
    kept = [choice for choice, id_ in zip(row, _ids(row, members), strict=True) if id_ not in taken]
    if len(kept) < len(row):
        known = taken.union(_ids(kept, members))
        others = [index for index in best_first(members) if members[index].id not in known]
        kept += others[: len(row) - len(kept)]
    return kept


def _ids(row: Iterable[Choice], members: Sequence[Member]) -> list[int]:
    return [choice.member.id if isinstance(choice, Archived) else members[choice].id for choice in row]
