"""Limits of the sizes of voxels (section 4)."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings, strategies as st
from numpy.typing import NDArray

from evoframe_libvox import KERNELS, Material, Model

ModelMaker = Callable[..., Model]
MaterialMaker = Callable[..., Material]
Follow = Callable[..., dict[str, NDArray[np.float64]]]
L = 0.05
STRAIN = 0.144714  # amplitude of contractile voxels
BAR = np.full((2, 1, 1), 3)


def apart(small_model: ModelMaker, follow: Follow, phase: float, **options: Any) -> float:
    """Return the distance of two voxels at rest, in edges; their size jumps to its value at the start."""
    model = small_model(BAR.shape, period=1e9, duration=2.0, **options)
    steps = int(model.time_steps(BAR[None].astype(np.uint8))[1][0])
    [(one, other)] = follow(model, BAR, phase, [steps], ["voxels"])["voxels"][:, :, 0, 0, 0]
    return float(other - one) / L


@pytest.mark.parametrize(
    ("limits", "phase", "size"),
    [
        ({}, 0.25, 1 + STRAIN),
        ({}, -0.25, 1 - STRAIN),
        ({"largest_size": 1.1}, 0.25, 1.0),
        ({"largest_size": 1.1, "size_clamp": True}, 0.25, 1.1),
        ({"largest_size": 1.1}, -0.25, 1 - STRAIN),
        ({"smallest_size": 0.9}, -0.25, 1.0),
        ({"smallest_size": 0.9, "size_clamp": True}, -0.25, 0.9),
        ({"smallest_size": 0.9, "size_clamp": True}, 0.25, 1 + STRAIN),
    ],
)
def test_a_size_beyond_a_limit_is_held_or_clamped(
    small_model: ModelMaker, follow: Follow, limits: dict[str, Any], phase: float, size: float
) -> None:
    assert apart(small_model, follow, phase, **limits) == pytest.approx(size, rel=1e-5)


def test_a_held_size_is_the_last_one_within_the_limit(small_model: ModelMaker, follow: Follow) -> None:
    """A slowly growing voxel stops at the limit; one that shrinks again follows the actuation."""
    model = small_model(BAR.shape, period=8.0, duration=8.0, largest_size=1.1)
    track = follow(model, BAR, 0.0, tracks=["voxels"])["voxels"][:, :, 0, 0, 0]
    size = np.diff(track, axis=1)[:, 0] / L
    time = np.linspace(0.0, 8.0, len(size))
    assert size[np.abs(time - 2.0).argmin()] == pytest.approx(1.1, abs=1e-3)
    assert size[np.abs(time - 6.0).argmin()] == pytest.approx(1 - STRAIN, abs=1e-3)


@given(
    largest=st.floats(1.0, 1.2),
    smallest=st.floats(0.8, 1.0),
    clamp=st.booleans(),
    phase=st.floats(0.0, 1.0),
)
@settings(suppress_health_check=[HealthCheck.function_scoped_fixture], max_examples=30)
def test_kernels_agree_on_limited_sizes(
    small_model: ModelMaker, follow: Follow, largest: float, smallest: float, clamp: bool, phase: float
) -> None:
    options = {"largest_size": largest, "smallest_size": smallest, "size_clamp": clamp}
    model = small_model((3, 1, 1), **options)
    ends = [
        follow(
            Model(
                model.canvas, model.palette, model.settings, np.zeros(model.canvas, np.uint8), kernel=kernel
            ),
            [[[3]], [[1]], [[3]]],
            phase,
        )["voxels"]
        for kernel in KERNELS
    ]
    for end in ends[2:]:
        assert (end == ends[1]).all()
    assert np.abs(ends[0] - ends[1]).max() < 1e-9 * L
