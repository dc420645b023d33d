"""The choice of collaborators for the individuals of one population."""

from __future__ import annotations

import functools
import json
from collections.abc import Iterable, Sequence
from typing import Any, TypeGuard

import attrs
import numpy as np

from evoframe.contract import (
    Archived,
    Choice,
    CollaborationRun,
    CollaborationStrategy,
    Judged,
    Member,
    ScoredMeetings,
    SupportsEach,
    SupportsMemory,
    blaming,
    sizes_of,
    started,
)
from evoframe.documents import structure
from evoframe.errors import ComponentError
from evoframe.evolution.decoding import Meeting
from evoframe.evolution.population import Population
from evoframe.files import json_text

__all__ = ["Collaboration"]


@attrs.define
class Collaboration:
    """The choice of collaborators for the individuals of one population, from all others.

    Attributes:
        key: Dotted key of the strategy in the configuration.
        strategy: Chooses the collaborators.
        own: The population.
        others: The other populations, in the order of decoding.
    """

    key: str
    strategy: CollaborationStrategy
    own: Population
    others: tuple[Population, ...]
    _runs: dict[str, CollaborationRun] = attrs.field(factory=dict, init=False)
    _met: dict[str, dict[int, tuple[int, ...]]] = attrs.field(factory=dict, init=False)

    def __attrs_post_init__(self) -> None:
        with blaming(self.key, self._whose):
            self._runs = {
                other.name: started(self.strategy, self.own.name, other.name) for other in self.others
            }

    @functools.cached_property
    def observes(self) -> bool:
        """True if the strategy has a memory, or can ask for the collaborators that individuals had."""
        return isinstance(self.strategy, SupportsMemory | SupportsEach)

    @property
    def _whose(self) -> str:
        """The population for whose individuals it chooses, in errors: several can share a strategy."""
        return f"population {self.own.name}"

    def teams(self) -> list[Sequence[tuple[int, ...]]]:
        """Return the teams of each individual: one position in each other population.

        Collaborators from several populations are combined by position: the i-th of each. Archived ones are
        admitted to their populations for this turn.

        Raises:
            ComponentError: The strategy failed, or chose invalid collaborators.
        """
        columns = [self._positions(other) for other in self.others]
        if not columns:
            return [[()]] * len(self.own.members)
        rows = list(zip(*columns, strict=True))
        teams = {row: self._combined(row) for row in set(rows)}  # most are equal
        return [teams[row] for row in rows]

    def note_collaborators(self, meetings: Iterable[Meeting], populations: Sequence[Population]) -> None:
        """Remember whom the individuals met in the meetings in which they were evaluated."""
        if not self.observes:
            return
        own = next(column for column, each in enumerate(populations) if each is self.own)
        for column, other in enumerate(populations):
            if column == own:
                continue
            met: dict[int, dict[int, None]] = {}
            for meeting in meetings:
                collaborators = met.setdefault(self.own.members[meeting[own]].id, {})
                collaborators[other.present[meeting[column]].id] = None
            self._met[other.name] = {key: tuple(collaborators) for key, collaborators in met.items()}

    def observe(self, seen: ScoredMeetings) -> None:
        """Show a turn to the strategy."""
        for other in self.others:
            with blaming(self.key, self._whose):
                self._runs[other.name].observe(seen, other.archivable)

    def state(self) -> dict[str, Any] | None:
        """Return everything needed to continue, as JSON values; ``None`` for a strategy without a memory."""
        if not self.observes:
            return None
        with blaming(self.key, self._whose):
            # Values of its own, since they are saved while the strategy already chooses for the next turn.
            runs = json.loads(json_text({name: run.state() for name, run in self._runs.items()}))
        met = {
            name: [[key, list(collaborators)] for key, collaborators in met.items()]
            for name, met in self._met.items()
        }
        return {"runs": runs, "met": met}

    def restore(self, state: Any) -> None:
        """Continue from the result of :meth:`state`.

        Raises:
            StructureError: The state is invalid; names the key.
            ValueError: The strategy rejects its state.
        """
        saved = structure(state, _Saved, ("collaboration", self.own.name))
        for name, run in self._runs.items():
            with blaming(self.key, self._whose):
                run.restore(saved.runs.get(name))
        self._met = {
            name: {int(key): tuple(map(int, ids)) for key, ids in met} for name, met in saved.met.items()
        }

    def _positions(self, other: Population) -> list[tuple[int, ...]]:
        """Return the positions of the collaborators of each individual from another population."""
        members, judged = other.candidates, self._judged(other)
        with blaming(self.key, self._whose):
            sizes = sizes_of(self.strategy, len(members))
        with blaming(self.key, self._whose):
            rows = list(self._runs[other.name].choose(judged, members, self.own.rng))
        if len(rows) != len(judged):
            problem = f"chose for {len(rows)} individuals, expected {len(judged)}"
            raise ComponentError(self.key, problem, self._whose)
        positions = []
        for row in rows:
            self._refuse_invalid(row, sizes, other)
            positions.append(tuple(other.admit(choice) for choice in row))
        return positions

    def _refuse_invalid(self, row: Sequence[Choice], sizes: Sequence[int], other: Population) -> None:
        """Refuse collaborators that do not exist or are repeated, and another number than declared."""
        ids = _ids(row, other.candidates) if isinstance(row, Sequence) else [None]
        if None in ids or len(set(ids)) != len(ids) or len(ids) not in sizes:
            expected = " or ".join(map(str, sizes))
            there = f"the {len(other.candidates)} members of '{other.name}'"
            raise ComponentError(self.key, f"chose {row}, expected {expected} of {there}", self._whose)

    def _judged(self, other: Population) -> list[Judged]:
        met = self._met.get(other.name, {})
        return [
            Judged(member, met.get(member.id, ()), index=index)
            for index, member in enumerate(self.own.members)
        ]

    def _combined(self, columns: Sequence[Sequence[int]]) -> list[tuple[int, ...]]:
        counts = {len(column) for column in columns}
        if len(counts) > 1:
            listed = ", ".join(map(str, sorted(counts)))
            problem = f"chose different numbers from other populations: {listed}"
            raise ComponentError(self.key, problem, self._whose)
        return list(zip(*columns, strict=True))


def _ids(row: Sequence[Choice], members: Sequence[Member]) -> list[int | None]:
    """Return the id of each collaborator; ``None`` if there is no such individual."""
    return [
        choice.member.id
        if isinstance(choice, Archived)
        else members[choice].id
        if _is_index(choice) and 0 <= choice < len(members)
        else None
        for choice in row
    ]


def _is_index(choice: object) -> TypeGuard[int]:
    return isinstance(choice, int | np.integer) and not isinstance(choice, bool)


@attrs.frozen
class _Saved:
    """The document that :meth:`Collaboration.state` returns."""

    runs: dict[str, Any]
    met: dict[str, Any]
