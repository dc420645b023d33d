import math

import attrs
import numpy as np
import pytest
from collaborators import members_of, population
from hypothesis import given, strategies as st

from evoframe import Archived, Member
from evoframe_strategies import Fittest
from evoframe_strategies.memory import CommonRun, completed, found_in, unique_ids


def archived(id_: int, *, diverged: bool = False) -> Archived:
    return Archived(Member(id_, 0.5, diverged=diverged), {"genome": id_})


def test_archived_individuals_that_are_members_are_chosen_by_index() -> None:
    members = population(0.1, 0.2, 0.3)  # with the ids 100, 99, 98
    gone = archived(7)
    assert found_in([archived(98), gone, archived(100)], members) == [2, gone, 0]


def test_diverged_individuals_are_not_found() -> None:
    members = population(0.1, 0.2, 0.3, diverged=(2,))
    assert found_in([archived(98), archived(7, diverged=True)], members) == []


def test_an_individual_that_diverged_earlier_is_judged_by_its_present_state() -> None:
    assert found_in([archived(100, diverged=True)], population(0.1)) == [0]


@given(members_of(), st.data())
def test_a_choice_is_completed_by_the_fittest_others(members: list[Member], data: st.DataObject) -> None:
    n = data.draw(st.integers(1, len(members)))
    preferred = data.draw(st.lists(st.integers(0, len(members) - 1), unique=True))
    choice = completed(preferred, members, n)
    fittest = Fittest(n=len(members)).select(members, np.random.default_rng(0)).tolist()
    assert choice == [*preferred, *(index for index in fittest if index not in preferred)][:n]


def test_a_complete_choice_needs_no_fitness() -> None:
    assert completed([1], population(None, math.nan), 1) == [1]


def test_archives_with_an_individual_twice_are_refused() -> None:
    unique_ids(None, None, [archived(1), archived(2)])
    with pytest.raises(ValueError, match=r"\[1\]"):
        unique_ids(None, None, [archived(1), archived(2), attrs.evolve(archived(1), genome=None)])


def test_a_common_run_requires_a_choice() -> None:
    with pytest.raises(NotImplementedError):
        CommonRun("other").choose([], [], np.random.default_rng(0))
