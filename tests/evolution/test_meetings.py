"""Tests of the meetings of a turn."""

from __future__ import annotations

import itertools

from hypothesis import given, strategies as st

from evoframe.evolution.meetings import first_meetings, meetings_with

sizes = st.lists(st.integers(1, 6), min_size=1, max_size=4)


@given(sizes)
def test_in_the_initial_turn_each_individual_meets_all_of_each_other_population(counts: list[int]) -> None:
    met = first_meetings(counts)
    for one, other in itertools.combinations(range(len(counts)), 2):
        pairs = {(meeting[one], meeting[other]) for meeting in met}
        assert pairs == set(itertools.product(range(counts[one]), range(counts[other])))


@given(sizes)
def test_no_meeting_is_repeated_and_each_has_a_member_of_each_population(counts: list[int]) -> None:
    met = first_meetings(counts)
    assert len(set(met)) == len(met)
    assert all(0 <= i < n for meeting in met for i, n in zip(meeting, counts, strict=True))


@given(st.integers(1, 9))
def test_a_single_population_meets_nobody(size: int) -> None:
    assert first_meetings([size]) == [(i,) for i in range(size)]


def test_two_populations_meet_completely() -> None:
    assert sorted(first_meetings([2, 3])) == list(itertools.product(range(2), range(3)))


def test_a_member_takes_its_place_in_each_of_its_teams() -> None:
    assert meetings_with(1, [[(7, 8)], [(5, 6), (3, 4)]]) == [(7, 0, 8), (5, 1, 6), (3, 1, 4)]
