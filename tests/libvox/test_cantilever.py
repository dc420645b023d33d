"""A bar that is clamped at one end and bends under its weight, compared with Euler-Bernoulli theory.

A bond is a beam of square cross section between the centers of two voxels. A bar of n voxels with the first
one clamped is a beam of (n - 1) lattice edges, clamped at the center of the first voxel, with the weight of
each other voxel at its center. For small loads beam theory is exact at the centers. A beam with uniform
weight that ends half an edge beyond the last center differs: here the first half voxel has no load, and the
other loads are points.
"""

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from evoframe_libvox import FIX_ALL, Model

ModelMaker = Callable[..., Model]
Follow = Callable[..., dict[str, NDArray[np.float64]]]
L = 0.05
WEIGHT_PER_G = 1e6 * L**3  # N per m/s2
STIFFNESS = 5e6 * L**4 / 12  # E I


def under_points(at: NDArray[np.floating[Any]], load: float) -> NDArray[np.float64]:
    """Return the deflections of a clamped beam at its point loads, m."""
    x, a = np.maximum.outer(at, at), np.minimum.outer(at, at)
    total: NDArray[np.float64] = (load * a**2 * (3 * x - a) / (6 * STIFFNESS)).sum(axis=1)
    return total


def under_own_weight(x: float, length: float, load_per_length: float) -> float:
    """Return the deflection of a clamped beam at x under a uniform load, m."""
    return load_per_length * x**2 * (x**2 + 6 * length**2 - 4 * length * x) / (24 * STIFFNESS)


def settled(small_model: ModelMaker, follow: Follow, n: int, axis: int, slope: float) -> tuple[float, ...]:
    """Return gravity and the sags of the voxels of a bar at rest, m."""
    gravity = slope * 6 * STIFFNESS / (WEIGHT_PER_G / L * ((n - 1) * L) ** 3)
    slowest = 1.875**2 * math.sqrt(STIFFNESS * L / WEIGHT_PER_G) / ((n - 1) * L) ** 2  # rad/s
    fastest = math.sqrt(5e6 * L / WEIGHT_PER_G)
    # Half of critical damping, at most 0.05: rotation has stronger damping.
    damping = min(0.05, 0.5 * slowest / fastest)
    canvas = (n, 1, 1) if axis == 0 else (1, n, 1)
    options = {"gravity": -gravity, "duration": 30 / (damping * fastest), "slow_damping": damping}
    model = small_model(canvas, fixed=[FIX_ALL] + (n - 1) * [0], **options)
    tracks = follow(model, steps=[0, int(model.time_steps(np.ones((1, *canvas), np.uint8))[1][0])])
    assert tracks["energy"][1, 1] < 1e-12 * tracks["energy"][1, 0]
    sag = (tracks["voxels"][0] - tracks["voxels"][1])[..., 2].ravel()
    return (gravity, *sag.tolist())


@pytest.mark.parametrize("axis", [0, 1])
@pytest.mark.parametrize("n", [2, 5, 10, 20])
def test_a_bar_bends_like_a_beam(
    small_model: ModelMaker, follow: Follow, n: int, axis: int, report: Callable[[str], None]
) -> None:
    """The remaining differences are rounding of small angles and the square of the slope, 1e-3."""
    gravity, *sag = settled(small_model, follow, n, axis, slope=1e-3)
    points = under_points(np.arange(1, n) * L, WEIGHT_PER_G * gravity)
    spread = under_own_weight((n - 1) * L, (n - 0.5) * L, WEIGHT_PER_G * gravity / L)
    off = float(np.abs(np.array(sag[1:]) / points - 1).max())
    report(
        f"bar of {n:2} along {'xy'[axis]}: from Euler-Bernoulli with point loads {off:.1e}, "
        f"of the tip with a spread load {sag[-1] / spread - 1:+.4f}"
    )
    assert sag[0] == 0.0
    assert off < 2e-6
    assert abs(sag[-1] / spread - 1) < 0.25 / n**2


def test_deflection_grows_less_than_large_loads(small_model: ModelMaker, follow: Follow) -> None:
    """As in every elastica, the lever becomes shorter."""
    gravity, *sag = settled(small_model, follow, 6, 0, slope=1.0)
    small = under_points(np.arange(1, 6) * L, WEIGHT_PER_G * gravity)[-1]
    assert 0.5 * small < sag[-1] < 0.95 * small
