"""Contract tests of ``strangers``, and examples."""

import numpy as np
import pytest
from acme_personal import Strangers

from evoframe import Judged, Member
from evoframe.testing import CollaborationStrategyContract

MEMBERS = [
    Member(10, 9.0, species=1),
    Member(11, 8.0, species=1),
    Member(12, 7.0, species=2),
    Member(13, 6.0, species=2),
]


class TestStrangers(CollaborationStrategyContract):
    component = Strangers()


class TestFourStrangers(CollaborationStrategyContract):
    component = Strangers(n=4, settle=0)


@pytest.mark.parametrize(
    ("age", "met", "expected"),
    [
        (0, (), [0, 2]),  # the fittest of either species
        (1, (11, 13), [1, 3]),  # keeps its collaborators
        (2, (11, 13), [0, 2]),  # meets strangers
        (2, (10, 12), [1, 3]),
        (2, (10, 11, 12), [3, 0]),  # there is only one stranger
    ],
)
def test_choices(age: int, met: tuple[int, ...], expected: list[int]) -> None:
    individual = Judged(Member(1, 0.5, age=age), met, index=0)
    assert Strangers().select_each([individual], MEMBERS, np.random.default_rng()).tolist() == [expected]
