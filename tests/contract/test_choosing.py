"""Tests of the runs of strategies without a memory, and of their numbers of collaborators."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import toys
from hypothesis import given, strategies as st
from toy_capabilities import Alternating, Archiving, ArchivingRun, Loyal

from evoframe import CollaborationRun, ConfigurationError, Judged, Member, ScoredMeetings, started
from evoframe.contract.choosing import sizes_of

fitness = st.lists(st.floats(-1e3, 1e3), min_size=2, max_size=10)
seeds = st.integers(0, 2**32 - 1)


def members_of(values: list[float]) -> list[Member]:
    return [Member(id=10 + i, fitness=value) for i, value in enumerate(values)]


def judged(count: int) -> list[Judged]:
    return [Judged(Member(id=i, fitness=None), index=i) for i in range(count)]


@given(values=fitness, count=st.integers(0, 5), seed=seeds)
def test_one_choice_serves_all_individuals(values: list[float], count: int, seed: int) -> None:
    members = members_of(values)
    rows = started(toys.Drawn(), "a", "b").choose(judged(count), members, np.random.default_rng(seed))
    expected = toys.Drawn().select(members, np.random.default_rng(seed)).tolist()
    assert list(rows) == [expected] * count
    assert all(type(index) is int for row in rows for index in row)


@given(values=fitness, count=st.integers(1, 5), seed=seeds)
def test_a_choice_for_each_individual_has_a_row_for_each(values: list[float], count: int, seed: int) -> None:
    members, who = members_of(values), judged(count)
    rows = started(Loyal(), "a", "b").choose(who, members, np.random.default_rng(seed))
    assert list(rows) == Loyal().select_each(who, members, np.random.default_rng(seed)).tolist()
    assert all(type(index) is int for row in rows for index in row)


@pytest.mark.parametrize("strategy", [toys.First(), Loyal()])
def test_strategies_without_a_memory_have_an_empty_state(strategy: Any) -> None:
    run = started(strategy, "a", "b")
    assert isinstance(run, CollaborationRun)
    empty = np.empty((0, 2), dtype=np.intp)
    run.observe(ScoredMeetings(0, ("a", "b"), ((), ()), (0, 0), empty, np.empty(0)), lambda _: None)
    assert run.state() is None
    run.restore(None)
    with pytest.raises(ValueError, match=r"expected no state, found \{'seen': 1\}"):
        run.restore({"seen": 1})


def test_strategies_with_a_memory_are_started_for_both_populations() -> None:
    run = started(Archiving(capacity=5), "a", "b")
    assert isinstance(run, ArchivingRun)
    assert (run.capacity, run.population, run.other) == (5, "a", "b")
    assert started(Archiving(), "a", "b") is not run


def test_numbers_of_collaborators_are_all_that_a_strategy_may_choose() -> None:
    assert sizes_of(toys.First(n=3), 5) == (3,)
    assert sizes_of(Alternating(), 5) == (1, 2)
    assert sizes_of(Alternating(), 1) == (1,)


def test_numbers_are_sorted_and_unique(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Alternating, "sizes", lambda *_: [3, 1, 3, 2])
    assert sizes_of(Alternating(), 5) == (1, 2, 3)


def test_a_population_that_is_too_small_is_refused() -> None:
    with pytest.raises(ConfigurationError, match="3 collaborators of 2 members"):
        sizes_of(toys.First(n=3), 2)
