"""Conclusions say what was found, and what cannot be concluded."""

from __future__ import annotations

import attrs
import numpy as np
from measuring import measure

from evoframe import Robustness
from evoframe.analysis.robustness import conclusions, find


def lifted(measured: Robustness, step: float) -> Robustness:
    """Return a measurement in which each body scores a *step* more than the one before it."""
    return attrs.evolve(measured, scores=measured.scores + step * np.arange(measured.scores.shape[1]))


class TestWords:
    def test_of_single_bodies_say_nothing_of_methods(self) -> None:
        words = conclusions(find(measure([1.0, 2.0, 3.0], 50, unit="m")))
        assert words.startswith(
            "3 bodies with 50 controllers, drawn at random from seed 1 and the same for every body."
        )
        assert "Each group is one body, so all this is about these bodies." in words
        assert "more controllers make any difference significant. " in words
        assert "diverged" not in words
        assert "same body" not in words
        assert "a group is worth" not in words

    def test_of_many_controllers_say_that_little_is_found(self) -> None:
        words = conclusions(find(measure([1.0, 2.0, 3.0], 400)))
        assert "more controllers make any difference significant, and 400 are enough for small ones." in words

    def test_of_several_bodies_compare_their_medians(self) -> None:
        words = conclusions(find(measure([1.0, 2.0, 3.0], 50, groups="XXY")))
        assert "With each controller, a group is worth the median of its bodies' scores." in words
        assert "One value for each body, its median: Y = X" in words
        assert "With 1 body in the smallest group these tests, whose" in words
        assert "Y is one body: no sample of a method." in words
        assert "Only this comparison is about what made the bodies" in words
        assert "Each group is one body" not in words

    def test_say_how_small_a_difference_was_found(self) -> None:
        words = conclusions(find(lifted(measure([1.0, 1.0], 50, unit="m"), 0.002)))
        assert "B is above A (the greater with 100.0% of the controllers, p < 0.001), by Wilcoxon's" in words
        assert "The smallest found here: the medians of B and A are 2 mm apart." in words

    def test_say_what_diverged_and_what_rests_on_the_others(self) -> None:
        measured = measure([1.0, 2.0], 50, most=1.5)
        words = conclusions(find(measured))
        lost, out = len(measured.diverged), 50 - len(measured.common)
        assert f"{lost} simulations diverged, and there is no score for that: {lost} of B." in words
        assert f"All tests leave out {out} controllers, with which a body diverged, for all" in words
        assert f"bodies; {50 - out} remain." in words

    def test_of_nothing_but_divergences_say_that_there_are_no_tests(self) -> None:
        words = conclusions(find(measure([1.0, 2.0], 3, most=-9.0)))
        assert "There is no controller with which no body diverged, so there are no tests." in words
        assert "Friedman" not in words

    def test_of_one_body_say_that_there_is_nothing_to_compare(self) -> None:
        words = conclusions(find(measure([1.0], 1)))
        assert words == (
            "1 body with 1 controller, drawn at random from seed 1 and the same for every body.\n\n"
            "There is nothing that it could be compared with, so there are no tests.\n"
        )

    def test_say_which_bodies_are_one(self) -> None:
        assert "A and C are the same body." in conclusions(find(measure([1.0, 2.0, 1.0], 5)))
        many = conclusions(find(measure([1.0, 2.0] * 8, 5, groups="XY" * 8)))
        assert "Only 2 of the 16 bodies are different; bodies.csv has their digests." in many

    def test_of_many_groups_name_no_pairs(self) -> None:
        words = conclusions(find(lifted(measure([1.0] * 12, 50), 1.0)))
        assert (
            "66 of 66 pairs differ by Wilcoxon's test, corrected after Holm; the tables name them." in words
        )
        assert " of 66 pairs differ by Dunn's test, corrected after Holm; the tables name them." in words
