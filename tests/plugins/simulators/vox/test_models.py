"""Solver models for settings, clocks of bodies, and codes that respond to offsets."""

from __future__ import annotations

import attrs
import numpy as np
import pytest
from bars import bar, soft, torn
from hypothesis import given, strategies as st

from evoframe import ConfigurationError, Record
from evoframe_simulators import FixedRegion, Vox, VoxSettings
from evoframe_simulators.vox.models import (
    acting_codes,
    clock_of,
    clocks_of,
    model_of,
    possible_clocks,
    strip_body_index,
    time_step_of,
)

BAR = bar(1, 3, 3).roles["morphology"]


def test_settings_with_one_canvas_share_a_model() -> None:
    assert model_of(Vox(), (4, 3, 3)) is model_of(attrs.evolve(Vox()), (4, 3, 3))
    assert model_of(Vox(), (4, 3, 3)) is not model_of(Vox(duration=1.0), (4, 3, 3))


def test_equal_simulators_share_a_model() -> None:
    first, again = Vox(gravity=-1.0), Vox(gravity=-1.0)
    assert first is not again
    assert model_of(first, (2, 1, 1)) is model_of(again, (2, 1, 1))


@pytest.mark.parametrize("whole_body", [False, True])
def test_a_model_may_be_of_whole_bodies(whole_body: bool) -> None:
    vox, record = (
        Vox(largest_strain=0.14, whole_body=whole_body),
        Record(("tip",), every=0.01, samples=(0, 5)),
    )
    [outcome] = vox.simulate([torn()], record)
    assert outcome.diverged_at == (2 if whole_body else None)
    assert np.isfinite(outcome.tracks["tip"]).all() != whole_body
    assert Vox(whole_body=whole_body).for_whole_designs() == Vox(whole_body=True)


@given(
    duration=st.floats(1e-3, 1.0),
    fraction=st.floats(0.1, 1.0),
    substeps=st.integers(1, 4),
    fixed=st.sampled_from([(), (FixedRegion(),)]),
)
def test_a_clock_has_the_fewest_steps_that_reach_the_duration(
    duration: float, fraction: float, substeps: int, fixed: tuple[FixedRegion, ...]
) -> None:
    settings = VoxSettings(duration=duration, time_step_fraction=fraction, substeps=substeps, fixed=fixed)
    clock = clock_of(settings, BAR)
    nominal = clock.time_step * substeps
    assert (clock.steps - 1) * nominal <= duration * (1 + 1e-12)
    assert clock.steps * nominal >= duration * (1 - 1e-12)
    assert [clock] == clocks_of(settings, model_of(settings, (3, 1, 1)), BAR[None])
    assert clock in possible_clocks(settings)


@given(duration=st.floats(1e-6, 1e6), fraction=st.floats(0.1, 1.0))
def test_a_time_step_does_not_depend_on_the_duration(duration: float, fraction: float) -> None:
    settings = VoxSettings(duration=duration, time_step_fraction=fraction)
    brief = attrs.evolve(settings, duration=1e-3)
    assert time_step_of(settings, BAR) == clock_of(brief, BAR).time_step


def test_a_time_step_is_known_even_if_the_limit_of_steps_rejects_the_duration() -> None:
    settings = VoxSettings(step_limit=1)
    with pytest.raises(ValueError, match="step_limit"):
        clock_of(settings, BAR)
    assert time_step_of(settings, BAR) == clock_of(VoxSettings(), BAR).time_step


def test_offsets_affect_expanding_materials_at_a_varying_temperature() -> None:
    palette = (soft(2), soft(5, expansion_coefficient=0.01), soft(7, expansion_coefficient=-0.01))
    assert np.flatnonzero(acting_codes(VoxSettings())).tolist() == [3]
    assert np.flatnonzero(acting_codes(VoxSettings(palette=palette))).tolist() == [5, 7]
    assert not acting_codes(VoxSettings(temperature_amplitude=25.0)).any()
    assert not acting_codes(VoxSettings()).flags.writeable


def test_a_record_must_exist_for_every_pair_of_materials() -> None:
    heavy = soft(2, density=1e8)
    clocks = possible_clocks(Vox(palette=(soft(1), heavy, attrs.evolve(heavy, code=3))))
    assert len(clocks) == 3 + 2  # pairs, and each alone; equal materials count once
    with pytest.raises(ConfigurationError, match="3 steps"):
        Vox(palette=(soft(1), heavy)).check(Record(("tip",), samples=(3,)))


def test_the_error_for_unusable_time_steps_contains_no_index_of_a_body() -> None:
    with pytest.raises(ValueError, match=r"time step \(.*2\^53 steps\)$"):
        Vox(density=1e-6, youngs_modulus=1e18, voxel_size=1e-6, duration=1e9)


def test_the_index_of_a_body_is_removed_from_errors() -> None:
    with pytest.raises(ValueError, match=r"\(body 0\)$") as caught:
        clock_of(VoxSettings(), np.full((2, 1, 1), 9, np.uint8))
    assert strip_body_index(caught.value) == str(caught.value).removesuffix(" (body 0)")
