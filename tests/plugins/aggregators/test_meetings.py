import math

import numpy as np
import pytest
from crediting import games, turn
from hypothesis import given, strategies as st

from evoframe import ScoredMeetings
from evoframe_aggregators.meetings import common, groups_of, mean_of_each_group, mean_of_each_member


@given(games((1, 2, 3)), st.sets(st.integers(0, 2)))
def test_meetings_of_a_group_agree_in_its_roles(meetings: ScoredMeetings, wanted: set[int]) -> None:
    roles = sorted(wanted & set(range(len(meetings.populations))))
    group = common(meetings, roles)
    rows = [tuple(row[roles].tolist()) for row in meetings.meetings]
    for i, one in enumerate(rows):
        for j, other in enumerate(rows):
            assert (group[i] == group[j]) == (one == other)


@given(st.lists(st.integers(0, 4)))
def test_groups_list_all_meetings_once(numbers: list[int]) -> None:
    dense = np.unique(numbers, return_inverse=True)[1].astype(np.intp) if numbers else np.zeros(0, np.intp)
    groups = [indices.tolist() for indices in groups_of(dense)]
    assert sorted(index for indices in groups for index in indices) == list(range(len(numbers)))
    for indices in groups:
        assert len({numbers[index] for index in indices}) <= 1


def test_a_group_has_one_mean_without_nan() -> None:
    means = mean_of_each_group(np.array([1, 0, 1, 2, 1]), np.array([1.0, 5.0, math.nan, math.nan, 4.0]))
    assert means.tolist() == pytest.approx([2.5, 5.0, 2.5, math.nan, 2.5], nan_ok=True)


def test_a_member_has_the_mean_of_its_meetings_without_nan() -> None:
    meetings = turn([(0, 0), (1, 0), (0, 1), (2, 1), (0, 2)], [0.0] * 5)
    values = np.array([1.0, 5.0, 3.0, math.nan, math.nan])
    assert mean_of_each_member(meetings, 0, values).tolist() == pytest.approx([2, 5, math.nan], nan_ok=True)
