"""Scores and turns for the tests of aggregators and credit."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterable, Sequence
from typing import Any

import attrs
import numpy as np
from hypothesis import strategies as st
from numpy.typing import NDArray

from evoframe import Credit, Member, ScoredMeetings

__all__ = ["ANY", "POSITIVE", "aggregate", "credited", "crossed", "games", "scores_of", "shuffled", "turn"]

POSITIVE = st.floats(1e-5, 1e100)
ANY = st.floats(-1e100, 1e100)


def scores_of(score: st.SearchStrategy[float], counts: Iterable[int] = range(1, 31)) -> Any:
    """Return lists of scores of these lengths."""
    return st.sampled_from(list(counts)).flatmap(lambda n: st.lists(score, min_size=n, max_size=n))


def aggregate(component: Any, scores: Any) -> float:
    """Return the fitness that an aggregator gives for these scores."""
    fitness: float = component.aggregate(np.array(scores, dtype=np.float64))
    return fitness


def turn(
    meetings: Sequence[Sequence[int]], scores: Sequence[float], *, sizes: Sequence[int] = (), index: int = 0
) -> ScoredMeetings:
    """Return a turn; without *sizes*, populations have as many members as met."""
    rows = np.array(meetings, dtype=np.intp)
    present = tuple(sizes or (rows.max(axis=0) + 1).tolist())
    return ScoredMeetings(
        index,
        tuple(f"role {role}" for role in range(rows.shape[1])),
        tuple(tuple(Member(id_, None) for id_ in range(size)) for size in present),
        present,
        rows,
        np.array(scores, dtype=np.float64),
    )


def crossed(scores: Any, *, index: int = 0) -> ScoredMeetings:
    """Return a turn in which everyone meets everyone; *scores* have one axis for each population."""
    table = np.array(scores, dtype=np.float64)
    rows = list(itertools.product(*map(range, table.shape)))
    return turn(rows, table.ravel().tolist(), sizes=table.shape, index=index)


def credited(component: Credit, meetings: ScoredMeetings, population: int = 0) -> list[float]:
    """Return the fitness that a credit gives to the members of a population."""
    fitness: NDArray[np.float64] = component.credit(meetings, population)
    return [float(value) for value in fitness]


def shuffled(meetings: ScoredMeetings, seed: int) -> ScoredMeetings:
    """Return the same turn with its meetings in another order."""
    order = np.random.default_rng(seed).permutation(len(meetings.scores))
    return attrs.evolve(meetings, meetings=meetings.meetings[order], scores=meetings.scores[order])


@st.composite
def games(draw: st.DrawFn, roles: Iterable[int] = (2, 3), *, diverged: bool = False) -> ScoredMeetings:
    """Return small turns in which every member has a meeting; scores are small whole numbers."""
    n_roles = draw(st.sampled_from(list(roles)))
    sizes = draw(st.lists(st.integers(1, 3), min_size=n_roles, max_size=n_roles))
    everything = list(itertools.product(*map(range, sizes)))
    some = draw(st.lists(st.sampled_from(everything), unique=True))
    # Member i of each population meets the others' members i, counted around.
    diagonal = [tuple(i % size for size in sizes) for i in range(math.lcm(*sizes))]
    rows = sorted({*some, *diagonal})
    score = st.integers(-9, 9).map(float)
    score = score | st.just(math.nan) if diverged else score
    scores = draw(st.lists(score, min_size=len(rows), max_size=len(rows)))
    return turn(rows, scores, sizes=sizes, index=draw(st.integers(0, 9)))
