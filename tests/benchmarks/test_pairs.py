"""Measurements in turns are compared with their neighbors."""

from __future__ import annotations

import pytest

from benchmarks.pairs import Ratio, alternated, ratio


def test_measurements_are_made_in_turns() -> None:
    made: list[str] = []

    def measure(name: str) -> int:
        made.append(name)
        return len(made)

    taken = alternated({"A": lambda: measure("A"), "B": lambda: measure("B")}, 2)
    assert made == ["A", "B", "A", "B"]
    assert taken == {"A": [1, 3], "B": [2, 4]}


def test_every_measurement_is_compared_with_both_neighbors() -> None:
    assert ratio([1.0, 2.0], [2.0, 6.0]) == Ratio(2.0, 1.5, 2.5)  # of the ratios 2 / 1, 2 / 2, 6 / 2


def test_one_pair_has_one_ratio() -> None:
    assert ratio([2.0], [3.0]) == Ratio(1.5, 1.5, 1.5)


def test_a_machine_that_slows_down_steadily_does_not_change_the_ratio() -> None:
    slowing = [1.01**turn for turn in range(20)]
    first, second = slowing[::2], [3.0 * time for time in slowing[1::2]]
    assert ratio(first, second).median == pytest.approx(3.0, rel=0.02)
    assert (ratio(first, second).lower + ratio(first, second).upper) / 2 == pytest.approx(3.0, rel=1e-3)


def test_both_must_have_the_same_number_of_measurements() -> None:
    with pytest.raises(ValueError, match="shorter"):
        ratio([1.0, 2.0], [1.0])
