"""Tests of written conclusions of a measurement: their numbers and names are those of the findings."""

from __future__ import annotations

import re

import attrs
import numpy as np
import pytest
from measuring import measure

from evoframe import Robustness
from evoframe.analysis.robustness import conclusions, find


def lifted(measured: Robustness, step: float) -> Robustness:
    """Return a measurement in which each body scores a *step* more than the one before it."""
    return attrs.evolve(measured, scores=measured.scores + step * np.arange(measured.scores.shape[1]))


def p_values(words: str) -> list[str]:
    return re.findall(r"\bp [<=] [\d.]+", words)


class TestWords:
    def test_of_single_bodies_exclude_the_methods(self) -> None:
        words = conclusions(find(measure([1.0, 2.0, 3.0], 50, unit="m")))
        first, *_, last = words.split("\n\n")
        assert all(data in first for data in ("3 bodies", "50 random controllers", "seed 1"))
        assert "single body" in last
        assert "champions of many runs" in last
        assert p_values(words)
        for absent in ("diverged", "identical", "median of its bodies", "50 are enough"):
            assert absent not in words

    def test_of_many_controllers_warn_of_small_differences(self) -> None:
        assert "and 400 are enough" in conclusions(find(measure([1.0, 2.0, 3.0], 400)))

    def test_of_several_bodies_compare_their_medians(self) -> None:
        words = conclusions(find(measure([1.0, 2.0, 3.0], 50, groups="XXY")))
        first, *_, last = words.split("\n\n")
        assert "median of its bodies" in first
        assert "Y, X" in last  # too few bodies for signs
        assert "1 body in" in last
        assert "at least 5 bodies" in last
        assert not p_values(last)
        assert "Y is a single body" in last
        assert "Each group is a single body" not in words

    def test_of_enough_bodies_have_the_test_of_their_medians(self) -> None:
        words = conclusions(find(measure([1.0, 5.0] * 6, 50, groups="XY" * 6)))
        *_, last = words.split("\n\n")
        assert "Y > X" in last
        assert p_values(last)

    def test_have_the_smallest_difference(self) -> None:
        words = conclusions(find(lifted(measure([1.0, 1.0], 50, unit="m"), 0.002)))
        assert "B exceeds A (with 100.0% of the controllers, p < 0.001)" in words
        assert re.search(r"\b2 mm\b.* B and A\b", words)

    def test_count_divergences_and_excluded_controllers(self) -> None:
        measured = measure([1.0, 2.0], 50, most=1.5)
        words = conclusions(find(measured))
        lost, out = len(measured.diverged), 50 - len(measured.common)
        assert f"{lost} simulations diverged" in words
        assert f"{lost} of B." in words
        assert f"{out} controllers" in words
        assert f"{50 - out} controllers remain" in words

    def test_of_divergences_only_have_no_tests(self) -> None:
        words = conclusions(find(measure([1.0, 2.0], 3, most=-9.0)))
        assert "6 simulations diverged" in words
        assert "no tests" in words
        assert "Friedman" not in words
        assert not p_values(words)

    def test_of_one_body_have_no_tests(self) -> None:
        words = conclusions(find(measure([1.0], 1)))
        first, second = words.split("\n\n")
        assert all(data in first for data in ("1 body", "1 random controller ", "seed 1"))
        assert "no tests" in second

    @pytest.mark.parametrize(
        ("controllers", "reason"), [(1, "only one controller"), (2, "at least 5"), (4, "at least 5")]
    )
    def test_of_fewer_than_five_controllers_have_no_p_values(self, controllers: int, reason: str) -> None:
        words = conclusions(find(measure([1.0, 2.0, 3.0], controllers)))
        assert not p_values(words)
        assert reason in words
        assert ("Friedman" in words, "Kruskal" in words, " A12" in words) == (False, False, False)

    def test_of_five_controllers_have_the_smallest_possible_p(self) -> None:
        words = conclusions(find(measure([1.0, 2.0, 3.0], 5)))
        assert "0.0625" in words
        assert "Friedman" in words

    def test_name_identical_bodies(self) -> None:
        assert "A and C are identical" in conclusions(find(measure([1.0, 2.0, 1.0], 5)))
        many = conclusions(find(measure([1.0, 2.0] * 8, 5, groups="XY" * 8)))
        assert "2 of the 16 bodies" in many
        assert "bodies.csv" in many

    def test_of_many_groups_do_not_list_pairs(self) -> None:
        words = conclusions(find(lifted(measure([1.0] * 12, 50), 1.0)))
        assert words.count(" of 66 pairwise") == 2
        assert "66 of 66 pairwise" in words
        assert words.count("pairs.csv") == 2
        assert "exceeds" not in words
