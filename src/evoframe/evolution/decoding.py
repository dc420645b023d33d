"""Decoding of meetings into designs, without repeating what they have in common."""

from __future__ import annotations

from collections.abc import Hashable, Iterable, Iterator, Sequence
from typing import TypeAlias

from evoframe.contract import Design
from evoframe.evolution.population import Population
from evoframe.evolution.roles import Roles

__all__ = ["Meeting", "decoded_designs"]

Meeting: TypeAlias = tuple[int, ...]
"""One position in each population: the members of a pair."""


_NONE = Roles()


def decoded_designs(
    populations: Sequence[Population],
    meetings: Iterable[Meeting],
    roles: Roles = _NONE,
    judged: int = 0,
) -> Iterator[Design]:
    """Yield the design of each meeting; equal parts of designs are decoded further only once.

    Networks often encode equal bodies: a third of the designs of a run of the preset ``paper`` repeat the
    body and the controller of another meeting of the same turn. These designs are the same object.

    Args:
        populations: The populations, in the order of decoding.
        meetings: The meetings.
        roles: Roles that no population evolves.
        judged: Index of the population for whose individuals they are drawn.
    """
    decoded: dict[tuple[str, int, Design], Design] = {}
    distinct: dict[Hashable, Design] = {}
    for meeting in meetings:
        individual = populations[judged].called(meeting[judged]) if roles.roles else ""
        design = roles.before(individual)
        for population, position in zip(populations, meeting, strict=True):
            step = population.name, position, design
            if step not in decoded:
                part = population.decode(position, design)
                is_complete = population is populations[-1] and not roles.roles
                decoded[step] = part if is_complete else distinct.setdefault(_contents(part), part)
            design = decoded[step]
        yield roles.after(design, individual)


def _contents(design: Design) -> Hashable:
    """Return a value that is equal for equal designs only."""
    return tuple((role, a.dtype.str, a.shape, a.tobytes()) for role, a in design.roles.items())
