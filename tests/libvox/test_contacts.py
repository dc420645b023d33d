"""Forces between touching voxels: engine's law, envelope, damping, friction (docs/physics.md, section 10).

Pairs without a bond are diagonal, 1.414 edges apart, or in one column with a gap.
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
MASS = 125.0  # kg
DIAGONAL = math.hypot(L, L)


def harmonic(a: float, b: float) -> float:
    return 2 * a * b / (a + b)


def first_push(model: Model, follow: Follow, body: Any) -> Any:
    """Return the displacements after one step with contact forces only; sizes are still those at rest."""
    moved = follow(model, body, steps=[0, 1], tracks=["voxels"])["voxels"]
    return moved[1] - moved[0]


def time_step(model: Model, body: Any) -> float:
    return float(model.time_steps(np.reshape(body, (1, *model.canvas)).astype(np.uint8))[0][0])


# ---- the engine's law


def test_diagonal_voxels_on_a_path_of_four_bonds_repel_at_rest(
    small_model: ModelMaker, material: MaterialMaker, follow: Follow
) -> None:
    ends = {1: material(), 2: material(youngs_modulus=2e7, density=2e6)}
    model = small_model((2, 2, 2), palette=ends)
    body = np.ones((2, 2, 2), np.uint8)
    body[:, :, 0] = [[0, 1], [2, 0]]
    body[0, 0, 1] = 0
    step = np.array([-1, 1, 0]) * harmonic(5e6, 2e7) * L * (1.5 * L - DIAGONAL) / math.sqrt(2)
    step *= time_step(model, body) ** 2
    moved = first_push(model, follow, body)
    assert moved[0, 1, 0] == pytest.approx(step / MASS, rel=1e-12)
    assert moved[1, 0, 0] == pytest.approx(-step / (2 * MASS), rel=1e-12)
    assert not moved[[0, 1, 1], [1, 0, 1], 1].any()
    apart = first_push(small_model((2, 2, 2), palette=ends, self_collision=False), follow, body)
    assert not apart[body > 0].any()


def test_diagonal_voxels_on_a_path_of_two_bonds_do_not_collide(
    small_model: ModelMaker, follow: Follow
) -> None:
    body = np.array([[1, 1], [0, 1]])
    assert not first_push(small_model((2, 2, 1)), follow, body)[body > 0].any()


def test_paths_consist_of_existing_bonds_only(small_model: ModelMaker, follow: Follow) -> None:
    """Clamped neighbors have no bond, so no path connects the free corner of a square to the opposite one."""
    held = np.array([[FIX_ALL, FIX_ALL], [FIX_ALL, 0]])
    model = small_model((2, 2, 1), fixed=held)
    push = 5e6 * L * (1.5 * L - DIAGONAL) / math.sqrt(2)
    moved = first_push(model, follow, np.ones((2, 2)))
    step = np.array([1, 1, 0]) * push * time_step(model, np.ones((2, 2))) ** 2 / MASS
    assert moved[1, 1, 0] == pytest.approx(step, rel=1e-12)
    assert not moved[held.reshape(2, 2, 1) > 0].any()


def test_the_published_law_is_the_default(small_model: ModelMaker, follow: Follow) -> None:
    published = {"collision_envelope": 1.5, "contact_damping": 0.0}
    rng = np.random.default_rng(6)
    body, phase = rng.choice([0, 1, 3], (5, 4, 4)), rng.uniform(-1, 1, (5, 4, 4))
    plain = follow(small_model(body.shape), body, phase)
    said = small_model(body.shape, **published, contact_friction=False, complete_contacts=False)
    named = follow(said, body, phase)
    none = follow(small_model(body.shape, self_collision=False), body, phase)
    assert all(np.array_equal(plain[name], named[name], equal_nan=True) for name in plain)
    assert np.nanmax(np.abs(plain["voxels"] - none["voxels"])) > 1e-3 * L


# ---- envelope


@pytest.mark.parametrize("envelope", [1.0, 1.41, 1.42, 1.5, 1.7, 2.0])
@pytest.mark.parametrize("options", [{}, {"contact_damping": 1.0}, {"complete_contacts": True}])
def test_the_envelope_determines_where_repulsion_starts(
    small_model: ModelMaker, follow: Follow, envelope: float, options: dict[str, Any]
) -> None:
    model = small_model((2, 2, 1), collision_envelope=envelope, **options)
    body = np.eye(2)
    push = 5e6 * L * max(0.0, envelope * L - DIAGONAL) / math.sqrt(2)
    moved = first_push(model, follow, body)
    step = np.array([1, 1, 0]) * push * time_step(model, body) ** 2 / MASS
    assert moved[1, 1, 0] == pytest.approx(step, rel=1e-12, abs=1e-16)
    assert moved[0, 0, 0] == pytest.approx(-step, rel=1e-12, abs=1e-16)


def test_the_envelope_grows_with_both_voxels(
    small_model: ModelMaker, material: MaterialMaker, follow: Follow
) -> None:
    """Of two voxels that do not touch at rest one grows: the mean size matters."""
    palette = {1: material(), 2: material(expansion=0.01)}
    model = small_model((2, 2, 1), palette=palette, collision_envelope=1.35, period=1e9)
    moved = follow(model, np.diag([1, 2]), 0.25, range(3), ["voxels"])["voxels"][:, 1, 1, 0]
    rest = float(np.float32(L))
    reach = 1.35 * (rest + 0.144714242553 * L / 2)
    push = 5e6 * L * (reach - DIAGONAL) / math.sqrt(2)
    assert (moved[1] == moved[0]).all()
    step = push * time_step(model, np.eye(2)) ** 2 / MASS
    assert moved[2] - moved[1] == pytest.approx(np.array([1, 1, 0]) * step, rel=1e-6)


# ---- damping


def fall(small_model: ModelMaker, follow: Follow, **changes: Any) -> dict[str, NDArray[np.float64]]:
    """Drop a voxel on a clamped one from two edges above, and return its height and speed."""
    options = {"collision_envelope": 1.0, "gravity": -9.81, "slow_damping": 0.0, "time_step_fraction": 0.1}
    options |= {"duration": 0.4, "complete_contacts": True} | changes
    model = small_model((1, 1, 4), fixed=[FIX_ALL, 0, 0, 0], **options)
    tracks = follow(model, [1, 0, 0, 1], tracks=["voxels", "momentum"])
    return {"height": tracks["voxels"][:, 0, 0, 3, 2], "speed": tracks["momentum"][:, 2] / MASS}


@pytest.mark.parametrize("damping", [0.0, 0.1, 0.3, 0.7])
def test_rebound_agrees_with_a_damped_spring(
    small_model: ModelMaker, material: MaterialMaker, follow: Follow, damping: float
) -> None:
    """The contact force ends when the damper exceeds the spring, as it is never attractive. For damping z,
    as a fraction of critical, exp(-z / sqrt(1 - z^2) * acos(2 z^2 - 1)) of the speed remains (z below
    0.7, no weight).
    """
    stiff = {1: material(youngs_modulus=5e8)}
    speed = fall(small_model, follow, palette=stiff, contact_damping=damping)["speed"]
    # The damper uses the mass of the clamped end as well: the reduced mass is half a mass.
    z = damping / math.sqrt(2)
    expected = math.exp(-z / math.sqrt(1 - z**2) * math.acos(2 * z**2 - 1))
    assert speed.max() / -speed.min() == pytest.approx(expected, abs=0.02)


@pytest.mark.parametrize("damping", [0.0, 0.3, 1.0, 10.0, 1000.0])
def test_damping_is_never_attractive(small_model: ModelMaker, follow: Follow, damping: float) -> None:
    """Two voxels that start too close separate with increasing speed, and keep it after the contact."""
    model = small_model((2, 2, 1), contact_damping=damping, slow_damping=0.0, duration=0.5)
    tracks = follow(model, np.eye(2), tracks=["voxels", "momentum", "energy"])
    way = tracks["voxels"][:, 1, 1, 0] - tracks["voxels"][:, 0, 0, 0]
    steps = np.diff(np.linalg.norm(way, axis=-1))
    assert (np.diff(steps) > -1e-15).all()
    assert steps[-1] > 0.0
    assert np.abs(tracks["momentum"]).max() < 1e-12


def test_damping_dissipates_energy(small_model: ModelMaker, follow: Follow) -> None:
    def left(damping: float) -> float:
        model = small_model((2, 2, 1), contact_damping=damping, slow_damping=0.0, duration=1.0)
        return float(follow(model, np.eye(2))["energy"][-1, 1])

    energies = [left(damping) for damping in (0.0, 0.1, 0.3, 1.0, 3.0)]
    stored = 0.5 * 5e6 * L * (1.5 * L - DIAGONAL) ** 2
    assert energies[0] == pytest.approx(stored, rel=0.05)
    assert energies == sorted(energies, reverse=True)
    assert energies[-1] < 0.2 * energies[0]


def test_damping_acts_only_on_touching_voxels(small_model: ModelMaker, follow: Follow) -> None:
    """A voxel falls freely before the contact."""
    plain = fall(small_model, follow)
    damped = fall(small_model, follow, contact_damping=1.0)
    meet = int(np.flatnonzero(plain["height"] < 1.5 * L)[0])
    assert np.array_equal(plain["height"][: meet + 1], damped["height"][: meet + 1])
    assert damped["height"][meet + 2] > plain["height"][meet + 2]


@pytest.mark.parametrize("pair", [({"density": 4e6}, {}), ({"youngs_modulus": 4e7}, {"density": 3e5})])
def test_unequal_voxels_push_each_other_equally(
    small_model: ModelMaker, material: MaterialMaker, follow: Follow, pair: tuple[dict[str, float], ...]
) -> None:
    palette = {i + 1: material(**fields) for i, fields in enumerate(pair)}
    options = {"contact_damping": 0.5, "contact_friction": True, "slow_damping": 0.0}
    tracks = follow(small_model((2, 2, 1), palette=palette, **options), np.diag([1, 2]))
    assert tracks["energy"][-1, 1] > 0.0
    assert np.abs(tracks["momentum"]).max() < 1e-12


# ---- friction


def burst(
    small_model: ModelMaker, material: MaterialMaker, follow: Follow, frictions: tuple[float, float]
) -> dict[str, NDArray[np.float64]]:
    """Simulate two heavy and two light voxels in a zigzag that start too close and rub while separating."""
    palette = {
        1: material(dynamic_friction=frictions[0], density=3e6),
        2: material(dynamic_friction=frictions[1], density=3e5),
    }
    options = {"contact_friction": True, "slow_damping": 0.0, "time_step_fraction": 0.1, "duration": 0.5}
    model = small_model((4, 2, 1), palette=palette, **options, collision_envelope=1.9)
    return follow(model, [[1, 0], [0, 2], [1, 0], [0, 2]])


def test_friction_between_voxels_conserves_momentum_and_dissipates_energy(
    small_model: ModelMaker, material: MaterialMaker, follow: Follow
) -> None:
    """Linear and angular momentum remain zero; the energy of the contacts is not fully recovered."""
    stored = 3 * 0.5 * 5e6 * L * (1.9 * L - DIAGONAL) ** 2
    left = []
    for friction in (0.0, 0.1, 0.5):
        tracks = burst(small_model, material, follow, (friction, friction))
        assert np.abs(tracks["momentum"]).max() < 1e-10
        left.append(float(tracks["energy"][-1, 1]) / stored)
    assert left[0] == pytest.approx(1.0, abs=5e-3)
    assert left[0] > left[1] + 0.01
    assert left[1] > left[2] + 0.01


def test_head_on_contacts_have_no_friction(
    small_model: ModelMaker, material: MaterialMaker, follow: Follow
) -> None:
    rough = {1: material(dynamic_friction=5.0)}
    plain = fall(small_model, follow)
    rubbed = fall(small_model, follow, palette=rough, contact_friction=True)
    assert np.abs(plain["height"] - rubbed["height"]).max() < 1e-14


def test_friction_is_the_mean_of_both_voxels(
    small_model: ModelMaker, material: MaterialMaker, follow: Follow
) -> None:
    alike, mixed, other = (
        burst(small_model, material, follow, frictions)["voxels"]
        for frictions in ((0.3, 0.3), (0.1, 0.5), (0.2, 0.5))
    )
    assert np.nanmax(np.abs(alike - mixed)) < 1e-14
    assert np.nanmax(np.abs(alike - other)) > 1e-6
