"""The displacements: the laws of objectives, and the measure of each."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given, strategies as st

from evoframe import Outcome, Record
from evoframe.testing import ObjectiveContract
from evoframe_objectives import FaceYz, TipDz, TipYz


class TestTipDz(ObjectiveContract):
    component = TipDz()


class TestTipYz(ObjectiveContract):
    component = TipYz()


class TestFaceYz(ObjectiveContract):
    component = FaceYz(every=0.0, first=2, last=9)


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


def test_the_first_sample_comes_before_the_last() -> None:
    with pytest.raises(ValueError, match="found first = 5 and last = 5"):
        TipDz(first=5, last=5)
