"""Meetings of a turn: one individual of each population."""

from __future__ import annotations

from collections.abc import Sequence

from evoframe.evolution.decoding import Meeting

__all__ = ["first_meetings", "meetings_with"]


def first_meetings(sizes: Sequence[int]) -> list[Meeting]:
    """Return the meetings of the initial turn, without repeats.

    Each individual meets every individual of each other population. With three and more populations, the
    others are combined by position, and those of smaller populations recur, so that the number of meetings
    grows with the square of the sizes only.

    Args:
        sizes: Sizes of the populations, in the order of turns.
    """
    met: dict[Meeting, None] = {}
    for index, size in enumerate(sizes):
        met.update(dict.fromkeys(meetings_with(index, [_teams_of_others(index, sizes)] * size)))
    return list(met)


def _teams_of_others(index: int, sizes: Sequence[int]) -> list[Meeting]:
    """Return teams that cover all members of the other populations; those of smaller ones recur."""
    others = [size for i, size in enumerate(sizes) if i != index]
    return [tuple(position % size for size in others) for position in range(max(others, default=1))]


def meetings_with(index: int, teams: Sequence[Sequence[tuple[int, ...]]]) -> list[Meeting]:
    """Return the meetings of each member of a population with each of its teams from the others."""
    return [(*team[:index], member, *team[index:]) for member, own in enumerate(teams) for team in own]
