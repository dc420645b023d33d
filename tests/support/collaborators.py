"""Populations, choices and turns for tests of collaboration strategies."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from hypothesis import strategies as st

from evoframe import Archived, Chosen, Judged, Member, ScoredMeetings, started
from evoframe_strategies import evoframe_strategies
from evoframe_strategies.nesting import built_in

__all__ = [
    "SEEDS",
    "chosen",
    "genome",
    "judged",
    "members_of",
    "new_run",
    "parts",
    "population",
    "rows",
    "turn",
]

SEEDS = st.integers(0, 2**32 - 1)


def population(*fitness: float | None, diverged: tuple[int, ...] = (), first_id: int = 100) -> list[Member]:
    """Return members with these fitness values, whose ids descend."""
    return [Member(id=first_id - i, fitness=f, diverged=i in diverged) for i, f in enumerate(fitness)]


def members_of(*, least: int = 1, most: int = 12, clean: bool = False) -> st.SearchStrategy[list[Member]]:
    """Return populations with ties and, unless *clean*, diverged members."""
    fitness = st.sampled_from([-1.0, 0.0, 0.5]) | st.integers(-9, 9).map(float)
    one = st.tuples(fitness, st.just(value=False) if clean else st.booleans(), st.none() | st.integers(1, 3))
    return st.lists(one, min_size=least, max_size=most).map(
        lambda drawn: [Member(i, f, species=s, diverged=d) for i, (f, d, s) in enumerate(drawn)]
    )


def chosen(strategy: Any, members: Sequence[Member], seed: int = 0) -> list[int]:
    """Return the indices that a strategy selects."""
    indices: list[int] = strategy.select(members, np.random.default_rng(seed)).tolist()
    return indices


def judged(n: int, first: int = 0) -> list[Judged]:
    """Return new individuals with the indices from *first* on."""
    return [Judged(Member(1000 + i, None), index=i) for i in range(first, first + n)]


def parts(*components: Any) -> tuple[Chosen[Any], ...]:
    """Return strategies as parts of others, with their names in the configuration."""
    names = {class_: name for name, class_ in evoframe_strategies().items()}
    return tuple(built_in(names[type(component)], component) for component in components)


def new_run(strategy: Any) -> Any:
    """Return a run that chooses among the members of the second population of :func:`turn`."""
    return started(strategy, "one", "other")


def rows(run: Any, members: Sequence[Member], n: int = 1, seed: int = 0) -> list[list[Any]]:
    """Return the ids of the collaborators of *n* individuals; those of archived ones as strings."""
    made = run.choose(judged(n), members, np.random.default_rng(seed))
    return [[str(c.member.id) if isinstance(c, Archived) else members[c].id for c in row] for row in made]


def genome(id_: int) -> Any:
    """Return the genome of an individual of the other population."""
    return {"genome of": id_}


def turn(
    run: Any,
    others: Sequence[Member],
    payoff: Any = None,
    *,
    archived: Sequence[Member] = (),
    index: int = 0,
) -> None:
    """Let a run observe a turn.

    Args:
        run: The run.
        others: Members of the other population.
        payoff: Scores of its individuals (rows), archived ones included, with those of the choosing one
            (columns); NaN: diverged; ``None``: did not meet.
        archived: Further individuals of the other population.
        index: Index of the turn.
    """
    payoff = [[0.0]] if payoff is None else payoff
    known = [*others, *archived]
    met = [(p, o, value) for o, row in enumerate(payoff) for p, value in enumerate(row) if value is not None]
    ones = tuple(Member(500 + i, 0.0) for i in range(len(payoff[0])))
    run.observe(
        ScoredMeetings(
            index,
            ("one", "other"),
            (ones, tuple(known)),
            (len(ones), len(others)),
            np.array([(p, o) for p, o, _ in met], dtype=np.intp).reshape(len(met), 2),
            np.array([value for _, _, value in met], dtype=np.float64),
        ),
        lambda place: genome(known[place].id),
    )
