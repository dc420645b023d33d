"""Groups of bodies are compared where all have a score, and in the words of what is compared."""

from __future__ import annotations

import attrs
import numpy as np
import pytest
from hypothesis import given, settings, strategies as st
from measuring import measure

from evoframe import Robustness
from evoframe.analysis.robustness import conclusions, find
from evoframe.analysis.robustness.tables import bodies_table, groups_table, pairs_table, ranking_table
from evoframe.analysis.statistics.corrections import CORRECTIONS, Correction


def lifted(measured: Robustness, step: float) -> Robustness:
    """Return a measurement in which each body scores a *step* more than the one before it."""
    return attrs.evolve(measured, scores=measured.scores + step * np.arange(measured.scores.shape[1]))


bodies = st.lists(st.floats(0.5, 4.0), min_size=2, max_size=4, unique=True)


class TestFindings:
    @settings(max_examples=20)
    @given(bodies, st.floats(0.2, 4.0))
    def test_rest_on_the_controllers_with_which_no_body_diverged(
        self, numbers: list[float], most: float
    ) -> None:
        measured = measure(numbers, 30, most=most)
        found = find(measured)
        clean = np.isfinite(measured.scores).all(axis=1)
        assert found.common == clean.sum()
        assert found.within is not None
        assert found.within.blocks == found.common
        assert found.apart is not None
        assert {group.n for group in found.apart.groups} == {found.common}
        medians = {group.name: group.median for group in found.apart.groups}
        for column, body in enumerate(measured.setting.bodies):
            assert medians[body.label] == pytest.approx(np.median(measured.scores[clean, column]))

    def test_see_within_controllers_what_is_lost_between_them(self) -> None:
        found = find(measure([1.0, 1.02], 200))  # the controllers differ far more than the bodies
        assert found.apart is not None
        assert found.within is not None
        assert found.apart.pairs[0].p > 0.5
        assert found.within.p == found.within.pairs[0].p
        assert found.within.chi_squared is None

    def test_have_one_value_for_each_body_where_groups_have_several(self) -> None:
        measured = measure([1.0, 2.0, 3.0, 1.5], 30, groups="XXXY")
        found = find(measured)
        assert found.by_body is not None
        assert {group.name: group.n for group in found.by_body.groups} == {"X": 3, "Y": 1}
        medians = np.median(measured.scores, axis=0)
        [group] = [group for group in found.by_body.groups if group.name == "X"]
        assert group.median == np.median(medians[:3])
        assert find(measure([1.0, 2.0], 30)).by_body is None

    @pytest.mark.parametrize("correction", CORRECTIONS)
    def test_are_corrected_as_was_asked(self, correction: Correction) -> None:
        found = find(measure([1.0, 2.0, 3.0], 10), correction)
        assert found.apart is not None
        assert found.within is not None
        assert found.apart.correction == found.within.correction == correction
        assert set(pairs_table(found)["correction"]) == {correction}

    @pytest.mark.parametrize(("numbers", "most"), [([1.0], 9.0), ([1.0, 2.0], -9.0)])
    def test_are_none_where_nothing_can_be_compared(self, numbers: list[float], most: float) -> None:
        found = find(measure(numbers, 10, most=most))
        assert [found.apart, found.within, found.by_body] == [None, None, None]
        for table in (pairs_table(found), ranking_table(found)):
            assert table.empty
            assert len(table.columns) > 5

    def test_of_one_controller_find_nothing(self) -> None:
        found = find(measure([1.0, 2.0, 3.0], 1))
        assert found.within is not None
        assert found.within.p > 0.05


class TestTables:
    def test_of_groups_have_the_scores_of_all_their_bodies(self) -> None:
        measured = measure([1.0, 2.0, 3.0], 40, groups="XXY", most=1.5)
        x, y = groups_table(find(measured)).to_dict(orient="records")
        assert (x["group"], x["bodies"], y["group"], y["bodies"]) == ("X", 2, "Y", 1)
        values = measured.values([0, 1])
        assert [x["least"], x["median"], x["greatest"]] == pytest.approx(
            [values.min(), np.median(values), values.max()]
        )
        assert x["positive"] == np.mean(values > 0)
        assert x["diverged"] + y["diverged"] == len(measured.diverged) > 0
        assert 0 <= x["Shapiro-Wilk p"] <= 1
        assert x["letters"]

    def test_of_bodies_have_a_line_for_each(self) -> None:
        measured = measure([1.0, 2.0, 1.0], 40)
        rows = bodies_table(measured).to_dict(orient="records")
        assert [row["body"] for row in rows] == ["A", "B", "C"]
        assert rows[0]["digest"] == rows[2]["digest"] != rows[1]["digest"]
        assert rows[1]["median"] == np.median(measured.scores[:, 1])

    def test_have_nothing_where_all_diverged(self) -> None:
        [row] = bodies_table(measure([1.0], 5, most=-9.0)).to_dict(orient="records")
        assert row["diverged"] == 5
        assert row["median"] is None

    def test_of_pairs_have_both_tests_side_by_side(self) -> None:
        found = find(measure([1.0, 2.0, 3.0], 40, groups="XXY"))
        [row] = pairs_table(found).to_dict(orient="records")
        assert found.within is not None
        assert found.by_body is not None
        block = found.within.pair(row["first"], row["second"])
        assert (row["Wilcoxon p"], row["wins"]) == (block.p, block.wins)
        assert row["A12 by body"] == found.by_body.pair(row["first"], row["second"]).a12

    def test_of_rankings_have_a_line_for_each_way_to_compare(self) -> None:
        three = ranking_table(find(measure([1.0, 2.0, 3.0, 4.0], 40, groups="XXYZ")))
        assert list(three["compared"]) == [
            "each controller for itself", "within controllers", "medians of bodies",
        ]  # fmt: skip
        assert list(three["test"]) == ["Kruskal-Wallis", "Friedman", "Kruskal-Wallis"]
        assert list(three["effect size"]) == ["epsilon squared", "Kendall's W", "epsilon squared"]
        two = ranking_table(find(measure([1.0, 2.0], 40)))
        assert list(two["test"]) == ["Kruskal-Wallis", "Wilcoxon"]
        assert list(two["effect size"]) == ["epsilon squared", "wins"]


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
