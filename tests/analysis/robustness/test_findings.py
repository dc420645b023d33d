"""Tests of findings: groups are compared with the controllers for which all bodies have a score."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings, strategies as st
from measuring import measure

from evoframe.analysis.robustness import find
from evoframe.analysis.robustness.tables import pairs_table, ranking_table
from evoframe.analysis.statistics.corrections import CORRECTIONS, Correction

bodies = st.lists(st.floats(0.5, 4.0), min_size=2, max_size=4, unique=True)


class TestFindings:
    @settings(max_examples=20)
    @given(bodies, st.floats(0.2, 4.0))
    def test_use_the_controllers_with_which_no_body_diverged(self, numbers: list[float], most: float) -> None:
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

    def test_detect_within_controllers_a_difference_that_independent_samples_hide(self) -> None:
        found = find(measure([1.0, 1.02], 200))  # controllers differ far more than bodies
        assert found.apart is not None
        assert found.within is not None
        assert found.apart.pairs[0].p > 0.5
        assert found.within.p == found.within.pairs[0].p
        assert found.within.chi_squared is None

    def test_have_one_value_per_body_if_a_group_has_several(self) -> None:
        measured = measure([1.0, 2.0, 3.0, 1.5], 30, groups="XXXY")
        found = find(measured)
        assert found.by_body is not None
        assert {group.name: group.n for group in found.by_body.groups} == {"X": 3, "Y": 1}
        medians = np.median(measured.scores, axis=0)
        [group] = [group for group in found.by_body.groups if group.name == "X"]
        assert group.median == np.median(medians[:3])
        assert find(measure([1.0, 2.0], 30)).by_body is None

    @pytest.mark.parametrize("correction", CORRECTIONS)
    def test_use_the_given_correction(self, correction: Correction) -> None:
        found = find(measure([1.0, 2.0, 3.0], 10), correction)
        assert found.apart is not None
        assert found.within is not None
        assert found.apart.correction == found.within.correction == correction
        assert set(pairs_table(found)["correction"]) == {correction}

    @pytest.mark.parametrize(("numbers", "most"), [([1.0], 9.0), ([1.0, 2.0], -9.0)])
    def test_are_none_if_nothing_can_be_compared(self, numbers: list[float], most: float) -> None:
        found = find(measure(numbers, 10, most=most))
        assert [found.apart, found.within, found.by_body] == [None, None, None]
        for table in (pairs_table(found), ranking_table(found)):
            assert table.empty
            assert len(table.columns) > 5

    def test_of_one_controller_are_not_significant(self) -> None:
        found = find(measure([1.0, 2.0, 3.0], 1))
        assert found.within is not None
        assert found.within.p > 0.05
