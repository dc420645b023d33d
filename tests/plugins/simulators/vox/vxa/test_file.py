"""Contents of a VXA file, and its settings."""

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


def test_settings_are_the_options_and_the_defaults_of_others() -> None:
    assert file().settings() == VoxSettings()
    assert file(frequency=2.0, duration=0.5).settings() == VoxSettings(frequency=2.0, duration=0.5)
    assert file().canvas == (3, 1, 1)


@given(steps=st.integers(1, 10**6), fraction=st.floats(0.1, 1.0))
def test_a_number_of_steps_becomes_a_duration_with_this_number(steps: int, fraction: float) -> None:
    settings = file(steps, time_step_fraction=fraction).settings()
    clock = clock_of(settings, BAR)
    assert clock.total == steps
    assert settings.duration == (steps - 0.5) * clock.time_step


def test_a_number_of_steps_does_not_depend_on_the_default_duration() -> None:
    options: dict[str, Any] = {"voxel_size": 1e-6, "youngs_modulus": 1e18, "density": 1e-6}
    with pytest.raises(InputError, match=r"time step \(.*2\^53 steps\)$"):
        file(**options).settings()
    assert clock_of(file(20, **options).settings(), BAR).total == 20


@pytest.mark.parametrize(
    ("steps", "options", "message"),
    [
        (None, {"voxel_size": -1.0}, "'voxel_size'.* 1e-6 and 1e6 m"),
        (None, {"frequency": 1e-60}, "^period "),
        (7, {"frequency": 1e-60}, "^period "),
        (10**9, {}, r"^duration = .* 1000000000 steps, .* step_limit = 10000000;"),
    ],
)
def test_settings_that_cannot_be_simulated_are_rejected(
    steps: int | None, options: Any, message: str
) -> None:
    with pytest.raises(InputError, match=message):
        file(steps, **options).settings()
