"""Normal force of the floor: depth at rest, rebound, and slope (docs/physics.md, section 9)."""

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
SIZE = float(np.float32(L))  # of a voxel at rest
G = -9.81
ON_FLOOR: dict[str, Any] = {"gravity": G, "floor": True}


def depth(voxels: int, density: float = 1e6, youngs_modulus: float = 5e6) -> float:
    """Return the depth of a resting column of voxels in the floor with stiffness 2 E L, m."""
    return voxels * density * L**3 * -G / (2 * youngs_modulus * L)


@pytest.mark.parametrize(
    "substance", [{}, {"density": 3e6}, {"youngs_modulus": 2e7}, {"density": 2e5, "youngs_modulus": 1e6}]
)
def test_the_depth_at_rest_depends_on_the_weight(
    small_model: ModelMaker, material: MaterialMaker, follow: Follow, substance: dict[str, float]
) -> None:
    palette = {1: material(**substance)}
    body = follow(small_model((1, 1, 3), palette=palette, **ON_FLOOR, duration=10.0), [0, 0, 1])["body"]
    assert body[-1, 2] == pytest.approx(SIZE / 2 - depth(1, **substance), abs=1e-12)
    assert (body[:, :2] == body[0, :2]).all()


def test_a_tower_rests_on_its_lowest_voxel(small_model: ModelMaker, follow: Follow) -> None:
    tracks = follow(small_model((1, 1, 4), **ON_FLOOR, duration=30.0, slow_damping=0.05))
    z = tracks["voxels"][-1, 0, 0, :, 2]
    assert z[0] == pytest.approx(SIZE / 2 - depth(4), abs=1e-12)
    assert np.diff(z) == pytest.approx([SIZE - 2 * depth(n) for n in (3, 2, 1)], abs=1e-12)
    assert tracks["strain"][-1] == pytest.approx([-2 * depth(3) / L, -2 * depth(1) / L], rel=1e-6)


def test_the_normal_force_depends_on_each_voxels_stiffness(
    small_model: ModelMaker, material: MaterialMaker, follow: Follow
) -> None:
    palette = {1: material(), 2: material(youngs_modulus=2e7, density=3e6)}
    model = small_model((2, 2, 1), palette=palette, **ON_FLOOR, duration=20.0, self_collision=False)
    z = follow(model, np.diag([1, 2]))["voxels"][-1, [0, 1], [0, 1], 0, 2]
    assert z == pytest.approx(SIZE / 2 - np.array([depth(1), depth(1, 3e6, 2e7)]), abs=1e-12)


def test_a_grown_voxel_stands_higher(
    small_model: ModelMaker, material: MaterialMaker, follow: Follow
) -> None:
    palette = {1: material(expansion=0.01)}
    model = small_model((1, 1, 1), palette=palette, **ON_FLOOR, duration=10.0, period=1e9)
    z = follow(model, phase=0.25)["body"][-1, 2]
    assert z == pytest.approx((SIZE + 0.144714242553 * L) / 2 - depth(1), abs=1e-12)


def test_without_a_floor_a_voxel_keeps_falling(small_model: ModelMaker, follow: Follow) -> None:
    assert follow(small_model((1, 1, 1), gravity=G, duration=0.3))["body"][-1, 2] < -L


def test_the_floor_does_not_lift_voxels_above_it(small_model: ModelMaker, follow: Follow) -> None:
    """A voxel that starts exactly on it is not touched either."""
    for floor in (True, False):
        model = small_model((1, 1, 2), gravity=0.0, floor=floor, voxel_size=0.0625)
        assert (follow(model)["voxels"] == follow(model)["voxels"][0]).all()


def test_a_clamped_voxel_in_the_floor_does_not_move(small_model: ModelMaker, follow: Follow) -> None:
    model = small_model((4, 1, 1), fixed=4 * [FIX_ALL], **ON_FLOOR, floor_slope=45.0)
    voxels = follow(model)["voxels"]
    assert (voxels == voxels[0]).all()


# ---- rebound


def restitution(model: Model, follow: Follow) -> float:
    """Return the ratio of speeds after and before the rebound of a voxel dropped from ten edges."""
    track = follow(model, 10 * [0] + [1], tracks=["momentum", "body"])
    speed = track["momentum"][:, 2]
    lands = int(np.argmin(speed))
    leaves = lands + int(np.flatnonzero(track["body"][lands:, 2] > SIZE / 2)[0])
    return -float(speed[leaves] / speed[lands])


@pytest.fixture(scope="module")
def dropped(small_model: ModelMaker, material: MaterialMaker) -> Callable[[float], Model]:
    """Create models of a voxel that falls from a height of ten edges and is so stiff that its weight is
    negligible during the contact with the floor.
    """
    options = ON_FLOOR | {"slow_damping": 0.0, "time_step_fraction": 0.1, "duration": 0.7}

    def make(damping: float) -> Model:
        palette = {1: material(youngs_modulus=5e8)}
        return small_model((1, 1, 11), palette=palette, **options, floor_damping=damping)

    return make


@pytest.mark.parametrize("damping", [0.0, 0.1, 0.4, 0.8])
def test_rebound_agrees_with_a_damped_spring(
    dropped: Callable[[float], Model], follow: Follow, damping: float
) -> None:
    """Spring 2 E L and damper damping * 2 sqrt(m E L): damping / sqrt(2) of critical."""
    share = damping / math.sqrt(2)
    expected = math.exp(-math.pi * share / math.sqrt(1 - share**2))
    assert restitution(dropped(damping), follow) == pytest.approx(expected, abs=0.02)


def test_more_damping_means_less_rebound(dropped: Callable[[float], Model], follow: Follow) -> None:
    shares = [restitution(dropped(damping), follow) for damping in (0.0, 0.05, 0.2, 0.8)]
    assert shares == sorted(shares, reverse=True)
    assert shares[0] == pytest.approx(1.0, abs=3e-3)


def test_the_fall_of_a_body_ends_at_rest(small_model: ModelMaker, follow: Follow) -> None:
    body = np.zeros((3, 3, 6))
    body[:, :, 3:] = 1
    tracks = follow(small_model(body.shape, **ON_FLOOR, duration=6.0), body)
    assert np.abs(tracks["voxels"][-1] - tracks["voxels"][-100])[body > 0].max() < 1e-6
    lowest = tracks["voxels"][-1][:, :, 3, 2]
    assert (lowest < SIZE / 2).all()
    assert 2 * 5e6 * L * (SIZE / 2 - lowest).sum() == pytest.approx(27 * 125.0 * -G, rel=1e-4)


# ---- slope


@pytest.mark.parametrize("slope", [-30.0, -5.0, 0.0, 10.0, 40.0])
def test_a_slope_changes_the_height_only(small_model: ModelMaker, follow: Follow, slope: float) -> None:
    """The floor is z = x tan(slope); a body at rest does not slide even without friction."""
    model = small_model((3, 1, 3), **ON_FLOOR, floor_slope=slope, duration=10.0, slow_damping=0.05)
    body = np.zeros((3, 1, 3))
    body[2, 0, 2] = 1
    track = follow(model, body, steps=range(0, 10_000, 10))["body"]
    assert (track[:, :2] == track[0, :2]).all()
    rise = 2.5 * L * math.tan(math.radians(slope))
    assert track[-1, 2] == pytest.approx(SIZE / 2 - depth(1) + rise, abs=1e-12)


def test_a_slope_has_its_own_height_at_each_voxel(small_model: ModelMaker, follow: Follow) -> None:
    model = small_model((5, 1, 4), **ON_FLOOR, floor_slope=20.0, duration=10.0, self_collision=False)
    body = np.zeros((5, 1, 4))
    body[[0, 2, 4], 0, [1, 2, 3]] = 1
    track = follow(model, body, tracks=["voxels"])["voxels"][-1, [0, 2, 4], 0, [1, 2, 3]]
    rise = track[:, 0] * math.tan(math.radians(20.0))
    assert track[:, 2] == pytest.approx(SIZE / 2 - depth(1) + rise, abs=1e-12)
