"""Scored meetings, grouped by those who met: the common ground of all credit."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from evoframe import ScoredMeetings

__all__ = ["common", "groups_of", "mean_of_each_group", "mean_of_each_member"]


def common(meetings: ScoredMeetings, roles: Sequence[int]) -> NDArray[np.intp]:
    """Return the number of the group of each meeting, ``intp[n]``.

    Meetings with the same individuals in all *roles* (indices of populations) are a group; without roles, all
    meetings are one.
    """
    if not roles:
        return np.zeros(len(meetings.meetings), np.intp)
    _, group = np.unique(meetings.meetings[:, list(roles)], axis=0, return_inverse=True)
    return group.reshape(-1).astype(np.intp)


def groups_of(group: NDArray[np.intp]) -> list[NDArray[np.intp]]:
    """Return the indices of the meetings of each group, from numbers of groups 0, 1, ... without a gap."""
    order = np.argsort(group, kind="stable").astype(np.intp)
    return np.split(order, np.flatnonzero(np.diff(group[order])) + 1)


def mean_of_each_group(group: NDArray[np.intp], scores: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return for each meeting the mean score of its group, ``float64[n]``; NaN scores are left out.

    Sums are rounded once, so that the order of the meetings is irrelevant.
    """
    means = np.empty(len(scores))
    for indices in groups_of(group):
        means[indices] = _mean(scores[indices])
    return means


def mean_of_each_member(
    meetings: ScoredMeetings, population: int, values: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Return the mean of the values of each member's meetings, ``float64[present]``; NaN if it has none.

    Args:
        meetings: All meetings of the turn.
        population: Index of the population of the members.
        values: One value for each meeting; those that are NaN are left out.
    """
    return np.array([_mean(values[own]) for own in meetings.of(population)], dtype=np.float64)


def _mean(values: NDArray[np.float64]) -> float:
    known: list[float] = values[~np.isnan(values)].tolist()
    return math.fsum(known) / len(known) if known else math.nan
