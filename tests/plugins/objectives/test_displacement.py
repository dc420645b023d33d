"""The displacements: the laws of objectives, and the measure of each."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given, strategies as st

from evoframe import ConfigurationError, Outcome, Record
from evoframe.testing import ObjectiveContract
from evoframe_objectives import FaceYz, TipDz, TipYz


class TestTipDz(ObjectiveContract):
    component = TipDz()


class TestTipYz(ObjectiveContract):
    component = TipYz()


class TestFaceYz(ObjectiveContract):
    component = FaceYz(every=0.0, first=2, last=9)


class TestFaceYzToTheEnd(ObjectiveContract):
    component = FaceYz(every=0.0, first=0, last=-1)


class TestTipDzBeforeTheEnd(ObjectiveContract):
    component = TipDz(first=1, last=-3)


def moved(track: str, before: list[float], after: list[float]) -> Outcome:
    return Outcome(np.array([1, 21]), np.array([0.1, 0.2]), {track: np.array([before, after])})


@pytest.mark.parametrize(
    ("objective", "track", "score"), [(TipDz(), "tip", -4.0), (TipYz(), "tip", 5.0), (FaceYz(), "face", 5.0)]
)
def test_each_measures_its_track(objective: Any, track: str, score: float) -> None:
    assert objective.record == Record((track,), every=0.01, samples=(0, 5))
    assert objective.score(moved(track, [1.0, 1.0, 1.0], [9.0, 4.0, -3.0])) == score


coordinates = st.lists(st.floats(-1e3, 1e3), min_size=3, max_size=3)


@given(coordinates, coordinates)
def test_signed_rise_never_exceeds_the_distance(before: list[float], after: list[float]) -> None:
    outcome = moved("tip", before, after)
    assert abs(TipDz().score(outcome)) <= TipYz().score(outcome) * (1 + 1e-15)


@given(coordinates, coordinates)
def test_signed_rise_changes_its_sign_when_time_is_reversed(before: list[float], after: list[float]) -> None:
    forth, back = moved("tip", before, after), moved("tip", after, before)
    assert TipDz().score(forth) == -TipDz().score(back)
    assert math.isclose(TipYz().score(forth), TipYz().score(back))


def path(points: int) -> Outcome:
    """Return an outcome whose tip rises by one more in each step."""
    steps = np.arange(1, points + 1)
    heights = np.cumsum(steps, dtype=np.float64)
    return Outcome(
        steps, np.multiply(steps, 0.5, dtype=np.float64), {"tip": np.outer(heights, [0.0, 0.0, 1.0])}
    )


class TestToTheEnd:
    """An index that counts from the end of the simulation, as in Python."""

    @pytest.mark.parametrize(("first", "last"), [(0, -1), (0, -2), (2, -1), (1, -3), (4, -1)])
    def test_selects_the_sample_that_a_list_would(self, first: int, last: int) -> None:
        outcome, objective = path(5), TipDz(first=first, last=last)
        heights = outcome.tracks["tip"][:, 2].tolist()
        assert objective.score(outcome) == heights[last] - heights[first]
        times = outcome.times.tolist()
        assert objective.window(outcome.times) == (times[first], times[last])

    def test_records_every_sample_and_requires_as_many_as_it_needs(self) -> None:
        assert TipDz(every=0.0, last=-1).record == Record(("tip",))
        assert TipDz(every=0.5, first=2, last=-2).record == Record(("tip",), every=0.5, until=1.5)

    @pytest.mark.parametrize(("first", "last"), [(5, -1), (0, -6), (3, -3)])
    def test_in_a_simulation_with_too_few_samples_is_an_error(self, first: int, last: int) -> None:
        objective = TipDz(every=0.0, first=first, last=last)
        for use in (lambda: objective.score(path(5)), lambda: objective.window(path(5).times)):
            with pytest.raises(ConfigurationError, match=rf"require {first - last} samples.* has 5"):
                use()

    @given(st.integers(1, 30))
    def test_equals_the_index_of_the_last_sample(self, n: int) -> None:
        outcome = path(n + 1)
        rows = Outcome(outcome.steps[[0, n]], outcome.times[[0, n]], {"tip": outcome.tracks["tip"][[0, n]]})
        fixed, to_the_end = TipDz(last=n), TipDz(last=-1)
        assert fixed.score(rows) == to_the_end.score(outcome)
        assert fixed.window(rows.times) == to_the_end.window(outcome.times)


def test_the_first_sample_comes_before_the_last() -> None:
    with pytest.raises(ValueError, match="found first = 5 and last = 5"):
        TipDz(first=5, last=5)
