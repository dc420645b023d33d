"""Dry friction on the floor: sticking, sliding and sliding distance (docs/physics.md, section 9).

The sliding voxel is one of two diagonal voxels on the floor without a bond. When the actuation starts, they
grow into each other, separate, and slide freely.
"""

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
WEIGHT = 125.0 * 9.81  # N
ON_FLOOR: dict[str, Any] = {"gravity": G, "floor": True, "slow_damping": 0.0}


# ---- sliding


def slide(
    small_model: ModelMaker, material: MaterialMaker, follow: Follow, frictions: tuple[float, float]
) -> tuple[NDArray[np.float64], float]:
    """Return the positions of both voxels on the floor after settling, ``[step, voxel, xy]``, and dt."""
    palette = {i + 1: material(expansion=0.01, dynamic_friction=mu) for i, mu in enumerate(frictions)}
    options = {"start_time": 2.0, "period": 1e9, "collision_envelope": 1.4, "duration": 7.0}
    model = small_model((2, 2, 1), palette=palette, **ON_FLOOR, **options)
    body = np.diag([1, 2])
    dt = float(model.time_steps(body.astype(np.uint8)[None, ..., None])[0][0])
    voxels = follow(model, body, 0.25, tracks=["voxels"])["voxels"][:, [0, 1], [0, 1], 0]
    settled = int(3.0 / dt)
    assert np.ptp(voxels[settled:, :, 2]) < 1e-12
    return voxels[settled:, :, :2], dt


def slid(speed: float, deceleration: float, dt: float) -> float:
    """Return the distance of a voxel that loses the same speed in each step until it stops, m."""
    left = np.arange(1, math.ceil(speed / (deceleration * dt)))
    return float((speed - left * deceleration * dt).sum() * dt)


@pytest.mark.parametrize("friction", [0.01, 0.02])
def test_a_sliding_voxel_stops_at_the_expected_distance(
    small_model: ModelMaker,
    material: MaterialMaker,
    follow: Follow,
    friction: float,
    report: Callable[[str], None],
) -> None:
    places, dt = slide(small_model, material, follow, (friction, friction))
    for voxel in range(2):
        way = places[:, voxel] - places[0, voxel]
        speed = float(np.linalg.norm(way[1]) / dt)
        measured = float(np.linalg.norm(way[-1] - way[1]))
        deceleration = friction * -G
        continuous = speed**2 / (2 * deceleration)
        report(
            f"friction {friction}: from {speed:.4f} m/s it slides {measured:.6f} m, "
            f"v^2 / (2 mu g) = {continuous:.6f} m, the sum over steps {slid(speed, deceleration, dt):.6f} m"
        )
        assert measured == pytest.approx(slid(speed, deceleration, dt), rel=1e-9)
        assert measured == pytest.approx(continuous, abs=speed * dt)
        assert continuous > 0.2 * L
        stopped = int(np.flatnonzero((way == way[-1]).all(axis=1))[0])
        assert stopped * dt == pytest.approx(speed / deceleration, abs=3 * dt)
        assert stopped < len(way) - 100


def test_each_voxel_has_its_own_friction(
    small_model: ModelMaker, material: MaterialMaker, follow: Follow
) -> None:
    places, dt = slide(small_model, material, follow, (0.01, 0.02))
    ways = places - places[0]
    speeds = np.linalg.norm(ways[1], axis=-1) / dt
    expected = [slid(v, mu * -G, dt) for v, mu in zip(speeds, (0.01, 0.02), strict=True)]
    assert np.linalg.norm(ways[-1] - ways[1], axis=-1) == pytest.approx(expected, rel=1e-9)
    assert expected[0] > 1.5 * expected[1]


def test_without_friction_a_voxel_keeps_sliding(
    small_model: ModelMaker, material: MaterialMaker, follow: Follow
) -> None:
    places, dt = slide(small_model, material, follow, (0.0, 0.0))
    steps = np.diff(places, axis=0)
    assert np.abs(steps - steps[0]).max() < 1e-14
    assert np.abs(steps[0]).min() > 0.01 * dt


def test_friction_is_opposite_to_the_motion(
    small_model: ModelMaker, material: MaterialMaker, follow: Follow
) -> None:
    """A voxel slides along the line of the push."""
    places, _ = slide(small_model, material, follow, (0.01, 0.01))
    way = places[:, 1] - places[0, 1]
    assert way[-1, 0] > 0.1 * L
    assert np.abs(way[:, 0] - way[:, 1]).max() < 1e-13


# ---- sticking

SETTLED = 1500  # steps, for the pair of voxels below


class Pull:
    """Two bonded voxels that rest on the floor until they start to shrink uniformly and slowly."""

    def __init__(
        self,
        small_model: ModelMaker,
        material: MaterialMaker,
        static: tuple[float, float],
        held: int = 0,
    ) -> None:
        self.dt = 0.9 / (2 * 3.1415926 * math.sqrt(5e6 * L / 125.0))
        self.start, self.ramp, self.strain = SETTLED * self.dt, 15.0, -1e-3 * 14.4714242553
        timing = {"start_time": self.start, "ramp": self.ramp, "period": 1e9, "duration": 20.0}
        palette = {
            i + 1: material(expansion=-1e-3, static_friction=mu, dynamic_friction=0.05)
            for i, mu in enumerate(static)
        }
        self.model = small_model(
            (2, 1, 1), palette=palette, fixed=[held, 0], **ON_FLOOR, **timing, bond_damping=0.0
        )

    def follow(self, follow: Follow) -> NDArray[np.float64]:
        """Return the displacement in x of both voxels since settling, after each step."""
        x = follow(self.model, [1, 2], 0.25, tracks=["voxels"])["voxels"][:, :, 0, 0, 0]
        shifts: NDArray[np.float64] = x - x[SETTLED]
        return shifts

    def force(self, steps: int) -> NDArray[np.float64]:
        """Return the force of the bond in each step if no voxel moves, N; sizes lag by one step."""
        time = (np.arange(steps) - 1) * self.dt
        share: NDArray[np.float64] = np.clip((time - self.start) / self.ramp, 0.0, 1.0)
        return -5e6 * L * L * self.strain * share

    def weight(self) -> float:
        """Return the normal force, without damping, on voxels that sink while shrinking, N."""
        sinking = -L * self.strain / (2 * self.ramp)
        return WEIGHT - 0.8 * 2 * math.sqrt(125.0 * 5e6 * L) * sinking


def test_voxels_stick_while_the_pull_is_below_their_static_friction(
    small_model: ModelMaker, material: MaterialMaker, follow: Follow
) -> None:
    pull = Pull(small_model, material, (1.0, 1.0))
    x = pull.follow(follow)
    assert not x[SETTLED:].any()
    assert 0.1 * WEIGHT < pull.force(len(x)).max() < WEIGHT


@pytest.mark.parametrize("friction", [0.09, 0.12])
def test_voxels_break_free_when_the_pull_reaches_it(
    small_model: ModelMaker, material: MaterialMaker, follow: Follow, friction: float
) -> None:
    pull = Pull(small_model, material, (friction, friction))
    x = pull.follow(follow)
    breaks = int(np.flatnonzero(pull.force(len(x)) >= friction * pull.weight())[0])
    assert not x[SETTLED : breaks + 1].any()
    assert x[breaks + 1, 0] > 0.0
    assert x[breaks + 1, 1] < 0.0


def test_the_one_with_less_friction_breaks_free_alone(
    small_model: ModelMaker, material: MaterialMaker, follow: Follow
) -> None:
    x = Pull(small_model, material, (1.0, 0.09)).follow(follow)
    assert not x[SETTLED:, 0].any()
    assert x[-1, 1] < -1e-3 * L


def test_a_clamped_voxel_is_not_braked(
    small_model: ModelMaker, material: MaterialMaker, follow: Follow
) -> None:
    """Its momentum does not depend on friction."""
    x = Pull(small_model, material, (0.0, 0.09), held=FIX_ALL).follow(follow)
    assert not x[:, 0].any()
    assert x[-1, 1] < -1e-3 * L


def test_friction_requires_a_normal_force(
    small_model: ModelMaker, material: MaterialMaker, follow: Follow
) -> None:
    """Without weight a voxel does not stick to the roughest floor."""
    palette = {3: material(expansion=0.01, static_friction=1e9, dynamic_friction=1e9)}
    model = small_model((2, 1, 1), palette=palette, floor=True, voxel_size=0.0625)
    without = small_model((2, 1, 1), palette=palette, floor=False, voxel_size=0.0625)
    sizes = follow(model, 3, 0.6)["tip"]  # they shrink first, so that no corner touches the floor
    assert np.array_equal(sizes[:20], follow(without, 3, 0.6)["tip"][:20])
    assert np.ptp(sizes[:20, 0]) > 0.0
