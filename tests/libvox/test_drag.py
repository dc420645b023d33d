"""Drag of a fluid: C A (v n)^2 on each facet of the surface that moves against it (section 7).

The surface is that of the paper's engine unless a test says ``fluid_by_size``.
"""

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from evoframe_libvox import Material, Model

ModelMaker = Callable[..., Model]
MaterialMaker = Callable[..., Material]
Follow = Callable[..., dict[str, NDArray[np.float64]]]
L = 0.05
AREA = float(np.float32(L)) ** 2  # of a face at rest, m2
MASS = 125.0  # kg
G = -9.81
DRAG = 750.0 * 1e4  # kg/m3; voxels are 1000 times as dense as water


def time_step(model: Model, body: Any = 1) -> float:
    cells = np.broadcast_to(np.asarray(body, np.uint8), model.canvas)
    return float(model.time_steps(cells[None])[0][0])


def terminal_speed(voxels: int, faces: int) -> float:
    return math.sqrt(voxels * MASS * -G / (DRAG * faces * AREA))


def final_speed(model: Model, follow: Follow, body: Any = 1) -> float:
    steps = int(model.time_steps(np.broadcast_to(np.asarray(body, np.uint8), (1, *model.canvas)))[1][0])
    track = follow(model, body, steps=[steps - 1, steps], tracks=["body"])["body"]
    return -float(track[1, 2] - track[0, 2]) / time_step(model, body)


def test_a_falling_voxel_follows_the_equation(small_model: ModelMaker, follow: Follow) -> None:
    model = small_model((1, 1, 1), gravity=G, fluid_drag=DRAG, slow_damping=0.0, duration=1.0)
    z, dt = follow(model)["body"][:, 2], time_step(model)
    speed, expected = 0.0, [L / 2]
    for _ in range(len(z) - 1):
        speed += dt * (G + DRAG * L**2 * speed**2 / MASS)
        expected.append(expected[-1] + speed * dt)
    assert np.abs(z - expected).max() < 1e-13
    assert -speed == pytest.approx(terminal_speed(1, 1), rel=1e-6)


@pytest.mark.parametrize("fluid_drag", [DRAG / 4, DRAG, DRAG * 4])
def test_terminal_speed_depends_on_the_root_of_the_drag(
    small_model: ModelMaker, follow: Follow, fluid_drag: float
) -> None:
    model = small_model((1, 1, 1), gravity=G, fluid_drag=fluid_drag, slow_damping=0.0, duration=2.0)
    expected = terminal_speed(1, 1) * math.sqrt(DRAG / fluid_drag)
    assert final_speed(model, follow) == pytest.approx(expected, rel=1e-6)


@pytest.mark.parametrize("canvas", [(1, 1, 4), (4, 1, 1), (3, 2, 1), (2, 3, 2), (3, 3, 3)])
def test_terminal_speed_depends_on_weight_and_area(
    small_model: ModelMaker, material: MaterialMaker, follow: Follow, canvas: tuple[int, int, int]
) -> None:
    """The body is too stiff to deform; only its lower faces count."""
    stiff = {1: material(youngs_modulus=5e8)}
    options = {"gravity": G, "fluid_drag": DRAG, "slow_damping": 0.0, "duration": 0.7}
    model = small_model(canvas, palette=stiff, **options)
    expected = terminal_speed(math.prod(canvas), canvas[0] * canvas[1])
    assert final_speed(model, follow) == pytest.approx(expected, rel=1e-3)


@pytest.mark.parametrize(("fluid_by_size", "size"), [(True, 1.144714), (False, 1.0)])
def test_only_by_size_grown_voxels_have_more_drag(
    small_model: ModelMaker, follow: Follow, fluid_by_size: bool, size: float
) -> None:
    options = {"gravity": G, "fluid_drag": DRAG, "slow_damping": 0.0, "duration": 1.0, "period": 1e9}
    model = small_model((1, 1, 1), **options, fluid_by_size=fluid_by_size)
    steps = int(model.time_steps(np.full((1, 1, 1, 1), 3, np.uint8))[1][0])
    z = follow(model, 3, 0.25, [steps - 1, steps], ["body"])["body"][:, 2]
    assert (z[0] - z[1]) / time_step(model, 3) == pytest.approx(terminal_speed(1, 1) / size, rel=1e-5)


def test_drag_is_normal_to_facets(small_model: ModelMaker, follow: Follow) -> None:
    """Two voxels separate along the diagonal of their faces: each face in front gets half of the square."""
    model = small_model((2, 2, 1), fluid_drag=DRAG, slow_damping=0.0, duration=1.0, voxel_size=0.0625)
    area, mass, dt = 0.0625**2, 1e6 * 0.0625**3, time_step(model, np.eye(2)[..., None])
    voxels = follow(model, np.eye(2), tracks=["voxels"])["voxels"][:, 1, 1, 0]
    assert np.abs(voxels[:, 0] - voxels[:, 1]).max() < 1e-15
    speed = np.diff(voxels[:, 0]) / dt
    apart = 2 * (voxels[:, 0] - 0.0625) > 1.5 * 0.0625 / math.sqrt(2)  # no longer in contact
    free = np.flatnonzero(apart)[0]
    assert len(speed) - free > 100
    expected = speed[free:-1] - dt * DRAG * area * speed[free:-1] ** 2 / mass
    assert speed[free + 1 :] == pytest.approx(expected, rel=1e-9)


def test_drag_never_adds_energy(small_model: ModelMaker, follow: Follow) -> None:
    """A body loses the energy of a kick faster in a fluid, and a body at rest remains at rest."""
    rng = np.random.default_rng(12)
    body, phase = rng.choice([0, 1, 3, 3], (4, 3, 3)), rng.uniform(0.0, 0.25, (4, 3, 3))
    options = {"slow_damping": 0.0, "bond_damping": 0.0, "period": 1e9, "self_collision": False}

    def energies(drag: float, phase: Any) -> NDArray[np.float64]:
        model = small_model(body.shape, fluid_drag=drag, **options, duration=2.0)
        total: NDArray[np.float64] = follow(model, body, phase)["energy"].sum(axis=1)
        return total

    free, slowed = energies(0.0, phase), energies(DRAG, phase)
    assert slowed[-100:].max() < 0.9 * free[-100:].min()
    assert slowed[-100:].mean() < slowed[100:200].mean()
    assert energies(DRAG, 0.0).max() < 1e-9


def test_a_clamped_voxel_does_not_move(small_model: ModelMaker, follow: Follow) -> None:
    voxels = follow(small_model((2, 1, 1), fixed=[63, 63], fluid_drag=DRAG, gravity=G))["voxels"]
    assert (voxels == voxels[0]).all()


# ---- cavities


def falling_box(
    small_model: ModelMaker, material: MaterialMaker, follow: Follow, body: Any, fluid_by_size: bool
) -> float:
    stiff = {1: material(youngs_modulus=5e8)}
    options: dict[str, Any] = {"gravity": G, "fluid_drag": DRAG, "slow_damping": 0.0, "duration": 0.7}
    options["fluid_by_size"] = fluid_by_size
    return final_speed(small_model(np.shape(body), palette=stiff, **options), follow, body)


@pytest.mark.parametrize(("fluid_by_size", "faces"), [(True, 9), (False, 9 + 1)])
def test_in_a_sealed_cavity_only_the_engine_has_drag(
    small_model: ModelMaker, material: MaterialMaker, follow: Follow, fluid_by_size: bool, faces: int
) -> None:
    box = np.ones((3, 3, 3))
    box[1, 1, 1] = 0
    speed = falling_box(small_model, material, follow, box, fluid_by_size)
    assert speed == pytest.approx(terminal_speed(26, faces), rel=1e-3)


@pytest.mark.parametrize("fluid_by_size", [True, False])
def test_an_open_cavity_has_drag(
    small_model: ModelMaker, material: MaterialMaker, follow: Follow, fluid_by_size: bool
) -> None:
    """A tunnel exposes three lower faces of the lid; a hole in the lid exposes none."""
    tunnel, pot = np.ones((3, 3, 3)), np.ones((3, 3, 3))
    tunnel[:, 1, 1] = 0
    pot[1, 1, 1:] = 0
    for body, voxels, faces in ((tunnel, 24, 9 + 3), (pot, 25, 9)):
        speed = falling_box(small_model, material, follow, body, fluid_by_size)
        assert speed == pytest.approx(terminal_speed(voxels, faces), rel=1e-3)


@pytest.mark.parametrize(("fluid_by_size", "faces"), [(True, 9 + 2), (False, 9 + 2 + 1)])
def test_fluid_does_not_pass_through_edges(
    small_model: ModelMaker, material: MaterialMaker, follow: Follow, fluid_by_size: bool, faces: int
) -> None:
    """A cavity that touches notches in two sides along an edge remains sealed; their upper walls count."""
    box = np.ones((3, 3, 4))
    box[1, 1, 1] = box[0, 1, 2] = box[2, 1, 2] = 0
    speed = falling_box(small_model, material, follow, box, fluid_by_size)
    assert speed == pytest.approx(terminal_speed(33, faces), rel=1e-3)


# ---- the surface of the paper's engine


def squeezed(
    small_model: ModelMaker, material: MaterialMaker, follow: Follow, moduli: tuple[float, float]
) -> NDArray[np.float64]:
    """Return the speeds, m/s, of two voxels, one on the other, that sink in a fluid."""
    soft, stiff = (material(youngs_modulus=modulus) for modulus in moduli)
    options = {"gravity": G, "fluid_drag": DRAG, "slow_damping": 0.0, "duration": 3.0}
    model = small_model((1, 1, 2), palette={1: soft, 2: stiff}, **options)
    body = np.array([1, 2], np.uint8).reshape(1, 1, 2)
    voxels = follow(model, body, tracks=["voxels"])["voxels"][:, 0, 0, :, 2]
    return np.diff(voxels, axis=0) / time_step(model, body)


def test_a_strained_bond_moves_no_face_across_it(
    small_model: ModelMaker, material: MaterialMaker, follow: Follow
) -> None:
    """The strain along z changes where lower and upper face are, but not their area."""
    speeds = squeezed(small_model, material, follow, (5e6, 5e6))
    assert -speeds[-1] == pytest.approx([terminal_speed(2, 1)] * 2, rel=1e-4)


def test_growth_widens_faces_only_between_voxels(
    small_model: ModelMaker, material: MaterialMaker, follow: Follow
) -> None:
    """Two grown voxels side by side meet in the middle; outward, each reaches half an edge."""
    options: dict[str, Any] = {"gravity": G, "fluid_drag": DRAG, "slow_damping": 0.0, "duration": 3.0}
    grown = {3: material(expansion=0.01)}
    model = small_model((2, 1, 1), palette=grown, period=1e9, **options)
    steps = int(model.time_steps(np.full((1, 2, 1, 1), 3, np.uint8))[1][0])
    z = follow(model, np.full((2, 1, 1), 3), 0.25, [steps - 1, steps], ["body"])["body"][:, 2]
    speed = float(z[0] - z[1]) / time_step(model, np.full((2, 1, 1), 3))
    width = 0.5 + 0.5 * 1.144714
    assert speed == pytest.approx(terminal_speed(2, 2) / math.sqrt(width), rel=1e-4)
