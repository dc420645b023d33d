"""Motion over a whole simulation: the laws of objectives, and the measure of each."""

from __future__ import annotations

import math
from typing import Any, Literal

import numpy as np
import pytest
from hypothesis import assume, given, strategies as st
from hypothesis.extra.numpy import arrays
from numpy.typing import NDArray

from evoframe import ConfigurationError, Outcome, Record, load_config
from evoframe.testing import ObjectiveContract
from evoframe_objectives import FacePeak, Travel

STEP = 0.01  # s


class TestTravel(ObjectiveContract):
    component = Travel()


class TestTravelAlong(ObjectiveContract):
    component = Travel(along="-y", every=0.1, after=2.0)


class TestFacePeak(ObjectiveContract):
    component = FacePeak()


class TestFacePeakAfter(ObjectiveContract):
    component = FacePeak(every=0.01, after=0.25)


def recorded(track: str, points: Any, initial: bool = False) -> Outcome:
    """Return an outcome with one point after each step; with *initial*, also one before the first step."""
    positions = np.asarray(points, dtype=np.float64)
    steps = np.arange(len(positions)) + (0 if initial else 1)
    return Outcome(steps, np.multiply(steps, STEP, dtype=np.float64), {track: positions})


def paths(least: int = 2) -> st.SearchStrategy[NDArray[np.float64]]:
    coordinates = st.floats(-10, 10, allow_subnormal=False)
    return st.integers(least, 12).flatmap(lambda n: arrays(np.float64, (n, 3), elements=coordinates))


vectors = arrays(np.float64, 3, elements=st.floats(-10, 10))
WALK = [[5.0, 5.0, 0.0], [0.0, 0.0, 9.0], [1.0, 1.0, 1.0], [3.0, -4.0, 7.0]]


class TestTravelOf:
    def test_the_center_of_mass_is_followed_to_the_end(self) -> None:
        assert Travel(every=0.1, after=0.5).record == Record(("body",), every=0.1, until=0.5)
        assert Travel().record == Record(("body",))

    @pytest.mark.parametrize(
        ("along", "score"), [("xy", 5.0), ("x", 3.0), ("-x", -3.0), ("y", -4.0), ("-y", 4.0)]
    )
    def test_is_measured_from_the_first_sample_that_counts_to_the_last(
        self, along: Any, score: float
    ) -> None:
        outcome = recorded("body", WALK)
        assert Travel(along=along, after=2 * STEP).score(outcome) == score
        assert Travel(along=along, after=1.5 * STEP).score(outcome) == score

    @pytest.mark.parametrize(("after", "first"), [(0.0, 1), (1.5 * STEP, 2), (4 * STEP, 4)])
    def test_its_window_starts_with_the_first_sample_that_counts(self, after: float, first: int) -> None:
        assert Travel(after=after).window(recorded("body", WALK).times) == (first * STEP, 4 * STEP)

    def test_a_sample_that_rounding_puts_just_before_the_time_counts(self) -> None:
        outcome = recorded("body", WALK)
        early = Outcome(outcome.steps, outcome.times * (1 - 1e-15), outcome.tracks)
        assert early.times[1] < 2 * STEP
        assert Travel(along="x", after=2 * STEP).score(early) == 3.0

    def test_of_a_single_sample_is_zero(self) -> None:
        assert Travel(after=4 * STEP).score(recorded("body", WALK)) == 0.0

    @given(paths(), vectors)
    def test_does_not_depend_on_where_the_body_is(self, path: NDArray[np.float64], by: NDArray[Any]) -> None:
        here, there = recorded("body", path), recorded("body", path + by)
        for along in ("xy", "x", "-x", "y", "-y"):
            objective = Travel(along=along)
            assert math.isclose(objective.score(here), objective.score(there), abs_tol=1e-13)

    @given(paths())
    def test_height_does_not_count(self, path: NDArray[np.float64]) -> None:
        flat = path * (1, 1, 0)
        assert Travel().score(recorded("body", path)) == Travel().score(recorded("body", flat))

    @given(paths())
    def test_opposite_directions_are_opposite_and_none_exceeds_the_distance(
        self, path: NDArray[np.float64]
    ) -> None:
        outcome = recorded("body", path)
        distance = Travel().score(outcome)
        assert distance >= 0
        axes: list[tuple[Literal["x", "y"], Literal["-x", "-y"]]] = [("x", "-x"), ("y", "-y")]
        for forth, back in axes:
            assert Travel(along=forth).score(outcome) == -Travel(along=back).score(outcome)
            assert abs(Travel(along=forth).score(outcome)) <= distance

    @given(paths(), st.floats(0, math.tau))
    def test_a_rotation_about_the_vertical_does_not_change_the_distance(
        self, path: NDArray[np.float64], angle: float
    ) -> None:
        cos, sin = math.cos(angle), math.sin(angle)
        turned = path @ np.array([[cos, sin, 0], [-sin, cos, 0], [0, 0, 1]])
        scores = [Travel().score(recorded("body", points)) for points in (path, turned)]
        assert math.isclose(*scores, abs_tol=1e-13)

    def test_an_unknown_direction_is_refused_before_anything_runs(self) -> None:
        with pytest.raises(ConfigurationError, match='"xy", "x", "-x", "y", "-y", found "z"') as caught:
            load_config(overrides=['objective={name="travel", along="z"}'])
        [fault] = caught.value.faults
        assert fault.key == "objective.along"


class TestFacePeakOf:
    def test_the_free_face_is_followed_from_rest_to_the_end(self) -> None:
        assert FacePeak(every=0.01, after=0.2).record == Record(
            ("face",), every=0.01, initial=True, until=0.2
        )

    def test_is_the_largest_distance_from_rest_in_the_yz_plane(self) -> None:
        path = [[0.0, 1.0, 1.0], [90.0, 7.0, 9.0], [90.0, 4.0, 5.0], [90.0, 1.0, 2.0]]
        assert FacePeak().score(recorded("face", path, initial=True)) == 10.0
        assert FacePeak(after=2 * STEP).score(recorded("face", path, initial=True)) == 5.0
        assert FacePeak(after=2.5 * STEP).score(recorded("face", path, initial=True)) == 1.0

    @given(paths(), vectors)
    def test_does_not_depend_on_where_the_body_is(self, path: NDArray[np.float64], by: NDArray[Any]) -> None:
        scores = [FacePeak().score(recorded("face", moved, initial=True)) for moved in (path, path + by)]
        assert math.isclose(*scores, abs_tol=1e-13)

    @given(paths(3), st.data())
    def test_one_more_sample_never_lowers_it(self, path: NDArray[np.float64], data: st.DataObject) -> None:
        whole = recorded("face", path, initial=True)
        kept = sorted(data.draw(st.sets(st.integers(1, len(path) - 1), min_size=1)))
        fewer = Outcome(
            whole.steps[[0, *kept]], whole.times[[0, *kept]], {"face": whole.tracks["face"][[0, *kept]]}
        )
        assert 0 <= FacePeak().score(fewer) <= FacePeak().score(whole)

    @given(paths(), st.floats(0, 0.05))
    def test_more_time_to_settle_never_raises_it(self, path: NDArray[np.float64], after: float) -> None:
        outcome = recorded("face", path, initial=True)
        assume(after <= outcome.times[-1])
        assert FacePeak(after=after).score(outcome) <= FacePeak().score(outcome)

    @given(paths())
    def test_reaches_at_least_as_far_as_any_sample_along_y_or_z(self, path: NDArray[np.float64]) -> None:
        reached = np.abs(path - path[0])[:, 1:].max()
        assert FacePeak().score(recorded("face", path, initial=True)) >= reached


class TestTooShort:
    """A simulation that ends before ``after``."""

    @pytest.mark.parametrize("name", ["travel", "face-peak"])
    def test_is_refused_before_anything_runs(self, name: str) -> None:
        override = f'objective={{name="{name}", after=0.5}}'
        with pytest.raises(ConfigurationError, match=r"0\.5 s; .*simulator\.duration = 0\.07 s") as caught:
            load_config(overrides=[override])
        [fault] = caught.value.faults
        assert override in fault.source
        assert fault.key == "objective"
        load_config(overrides=[f'objective={{name="{name}", after=0.06}}'])

    @pytest.mark.parametrize("objective", [Travel(after=1.0), FacePeak(after=1.0)])
    def test_is_reported_even_if_the_simulator_accepts_it(self, objective: Travel | FacePeak) -> None:
        outcome = recorded(objective.record.tracks[0], WALK)
        with pytest.raises(ConfigurationError, match=r"objective\.after = 1\.0 s .* 0\.04 s"):
            objective.score(outcome)


@pytest.mark.parametrize("objective", [Travel, FacePeak])
@pytest.mark.parametrize("option", ["every", "after"])
def test_times_are_not_negative(objective: type[Any], option: str) -> None:
    with pytest.raises(ValueError, match=f"'{option}' must be >= 0"):
        objective(**{option: -1.0})
