"""The contents of a VXA file, and the settings that simulate it."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given, strategies as st

from evoframe import InputError
from evoframe_simulators import VoxSettings
from evoframe_simulators.vox.models import clock_of
from evoframe_simulators.vox.vxa import VxaFile

BAR = np.array([1, 3, 3], np.uint8).reshape(3, 1, 1)


def file(steps: int | None = None, **options: Any) -> VxaFile:
    return VxaFile(options, BAR, np.zeros(BAR.shape), steps)


def test_settings_are_the_options_and_else_the_defaults() -> None:
    assert file().settings() == VoxSettings()
    assert file(frequency=2.0, duration=0.5).settings() == VoxSettings(frequency=2.0, duration=0.5)
    assert file().canvas == (3, 1, 1)


@given(steps=st.integers(1, 10**6), fraction=st.floats(0.1, 1.0))
def test_counted_steps_become_a_duration_that_takes_as_many(steps: int, fraction: float) -> None:
    settings = file(steps, time_step_fraction=fraction).settings()
    clock = clock_of(settings, BAR)
    assert clock.total == steps
    assert settings.duration == (steps - 0.5) * clock.time_step


def test_counted_steps_need_no_duration_that_suits_the_time_step() -> None:
    options: dict[str, Any] = {"voxel_size": 1e-6, "youngs_modulus": 1e18, "density": 1e-6}
    with pytest.raises(InputError, match=r"no usable time step \(at most 2\^53 steps\)$"):
        file(**options).settings()
    assert clock_of(file(20, **options).settings(), BAR).total == 20


@pytest.mark.parametrize(
    ("steps", "options", "message"),
    [
        (None, {"voxel_size": -1.0}, "'voxel_size' must be between 1e-6 and 1e6 m"),
        (None, {"frequency": 1e-60}, "^period must be"),
        (7, {"frequency": 1e-60}, "^period must be"),
        (10**9, {}, r"^duration = .* takes 1000000000 steps, more than step_limit = 10000000; simulate less"),
    ],
)
def test_what_cannot_be_simulated_is_refused(steps: int | None, options: Any, message: str) -> None:
    with pytest.raises(InputError, match=message):
        file(steps, **options).settings()
