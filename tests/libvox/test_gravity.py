"""Weight: free fall, terminal speed of slow damping, comparison of bodies (docs/physics.md, section 7)."""

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from evoframe_libvox import FIX_ALL, Material, Model

ModelMaker = Callable[..., Model]
MaterialMaker = Callable[..., Material]
Follow = Callable[..., dict[str, NDArray[np.float64]]]
L = 0.05
G = -9.81


def fallen(n: NDArray[np.int64], gravity: float, dt: float) -> NDArray[np.float64]:
    """Return the fall of semi-implicit Euler in n steps: a sum of n speeds, g dt^2 n (n + 1) / 2."""
    return gravity * dt**2 * n * (n + 1) / 2


def time_step(model: Model, body: Any = 1) -> float:
    cells = np.broadcast_to(np.asarray(body, np.uint8), model.canvas)
    return float(model.time_steps(cells[None])[0][0])


def test_a_voxel_without_weight_does_not_move(small_model: ModelMaker, follow: Follow) -> None:
    """Growth and shrinkage do not move it."""
    tip = follow(small_model((1, 1, 1)), 3, 0.3)["tip"]
    assert (tip == L / 2).all()


@pytest.mark.parametrize("gravity", [G, 1.62, -1e3])
def test_a_voxel_falls_freely(small_model: ModelMaker, follow: Follow, gravity: float) -> None:
    model = small_model((1, 1, 1), gravity=gravity, slow_damping=0.0, duration=0.5, largest_distance=1e4)
    body = follow(model)["body"]
    n = np.arange(len(body))
    assert np.abs(body[:, 2] - L / 2 - fallen(n, gravity, time_step(model))).max() < 1e-12 * abs(body).max()
    assert (body[:, :2] == L / 2).all()


def test_slow_damping_limits_a_fall_to_a_terminal_speed(small_model: ModelMaker, follow: Follow) -> None:
    """The force of slow damping is c v, c = 0.01 * 2 sqrt(m E L)."""
    model = small_model((1, 1, 1), gravity=G, duration=12.0, largest_distance=1e4)
    z, dt = follow(model)["body"][:, 2], time_step(model)
    drag = 0.01 * 2 * math.sqrt(125.0 * 5e6 * L) / 125.0
    assert (z[-1] - z[-2]) / dt == pytest.approx(G / drag, rel=1e-3)
    speed, expected = 0.0, [L / 2]
    for _ in range(len(z) - 1):
        speed += dt * (G - drag * speed)
        expected.append(expected[-1] + speed * dt)
    assert np.abs(z - expected).max() < 1e-12


def test_internal_forces_do_not_change_the_fall(small_model: ModelMaker, follow: Follow) -> None:
    """Bonds, contacts and actuation are internal forces; all voxels have the same mass."""
    rng = np.random.default_rng(5)
    body, phase = rng.choice([0, 1, 3, 3], (4, 3, 3)), rng.uniform(-1, 1, (4, 3, 3))
    model = small_model((4, 3, 3), gravity=G, slow_damping=0.0, duration=0.5)
    tracks = follow(model, body, phase)
    centre = tracks["body"]
    assert np.ptp(tracks["voxels"] - centre[:, None, None, None], axis=0)[body > 0].max() > 0.05 * L
    expected = fallen(np.arange(len(centre)), G, time_step(model, body))
    assert np.abs(centre - centre[0] - np.outer(expected, [0, 0, 1])).max() < 1e-13


def test_heavy_and_light_fall_alike(small_model: ModelMaker, material: MaterialMaker, follow: Follow) -> None:
    palette = {1: material(), 2: material(density=7e6), 3: material(density=1e3, youngs_modulus=1e4)}
    model = small_model((3, 3, 1), palette=palette, gravity=G, slow_damping=0.0, self_collision=False)
    z = follow(model, np.diag([1, 2, 3]))["voxels"][:, [0, 1, 2], [0, 1, 2], 0, 2]
    assert np.ptp(z, axis=1).max() < 1e-15
    assert z[-1, 0] < L / 2 - 0.04


def test_a_body_of_two_densities_does_not_bend_in_free_fall(
    small_model: ModelMaker, material: MaterialMaker, follow: Follow
) -> None:
    palette = {1: material(), 2: material(density=7e6)}
    model = small_model((4, 1, 1), palette=palette, gravity=G, slow_damping=0.0, duration=0.5)
    tracks = follow(model, [1, 1, 2, 1])
    assert np.ptp(tracks["voxels"][..., 2], axis=1).max() < 1e-15
    assert tracks["energy"][:, 0].max() < 1e-6 * tracks["energy"][-1, 1]


def test_a_clamped_voxel_does_not_fall(small_model: ModelMaker, follow: Follow) -> None:
    voxels = follow(small_model((1, 1, 2), fixed=[FIX_ALL, FIX_ALL], gravity=G))["voxels"]
    assert (voxels == voxels[0]).all()
