"""Laws that hold for every small body."""

from typing import Any

import numpy as np
import pytest
from hypothesis import given, strategies as st
from hypothesis.extra import numpy as arrays
from numpy.typing import NDArray

from evoframe_libvox import FIX_ALL, Material, Model, Settings

L = 0.05
STEPS = 25
PALETTE = {
    1: Material(5e6, 0.35, 1e6, 0.0, 1.0, 0.5),
    2: Material(2e7, 0.1, 5e5, 0.0, 0.2, 0.1),
    3: Material(5e6, 0.35, 1e6, 0.01, 1.0, 0.5),
    4: Material(5e6, 0.35, 2e6, -0.01, 0.5, 0.5),
}
Body = tuple[NDArray[Any], NDArray[Any], NDArray[Any]]  # material, phase, fixed
HEAVY: dict[str, Any] = {"gravity": -9.81, "fluid_drag": 1e5}


@st.composite
def bodies(draw: st.DrawFn) -> Body:
    """Draw a body that is not empty, a controller, and clamped degrees of freedom of cells."""
    canvas = draw(st.tuples(*(st.integers(1, 4),) * 3))
    material = draw(arrays.arrays(np.uint8, canvas, elements=st.sampled_from([0, 1, 2, 3, 4])))
    material[tuple(draw(st.integers(0, n - 1)) for n in canvas)] = 3
    phase = draw(arrays.arrays(np.float64, canvas, elements=st.integers(-64, 64).map(lambda n: n / 64)))
    masks = st.one_of(st.just(0), st.just(FIX_ALL), st.integers(0, FIX_ALL))
    return material, phase, draw(arrays.arrays(np.uint8, canvas, elements=masks))


def simulate(body: Body, **changes: Any) -> NDArray[np.float64]:
    """Return the positions after every step."""
    material, phase, fixed = body
    options: dict[str, Any] = {
        "voxel_size": L,
        "duration": 0.2,
        "temperature_amplitude": 14.4714242553,
        "period": 0.25,
    }
    canvas = (material.shape[0], material.shape[1], material.shape[2])
    model = Model(canvas, PALETTE, Settings(**(options | changes)), fixed)
    result = model.simulate(material[None], phase[None], range(STEPS + 1), ["voxels"])
    assert result.diverged_step[0] == 0
    voxels: NDArray[np.float64] = result.tracks["voxels"][0]
    return voxels


def apart(a: NDArray[np.float64], b: NDArray[np.float64]) -> float:
    return float(np.nanmax(np.abs(a - b)))


def way(voxels: NDArray[np.float64]) -> float:
    return apart(voxels, voxels[:1])


def swapped(fixed: NDArray[Any], order: tuple[int, int, int]) -> NDArray[Any]:
    """Return the masks for a permutation of the axes."""
    total = np.zeros_like(fixed)
    for new, old in enumerate(order):
        total |= ((fixed >> old & 9) << new).astype(
            np.uint8
        )  # 9: bits for translation along and rotation about an axis
    return total


@given(bodies())
def test_every_sample_is_finite_and_close(body: Body) -> None:
    voxels = simulate(body, **HEAVY, floor=True)
    occupied = voxels[:, body[0] > 0]
    assert np.isfinite(occupied).all()
    assert np.abs(occupied - occupied[0]).max() < 2 * L


@given(bodies(), st.permutations((0, 1, 2)))
def test_the_axes_are_equivalent(body: Body, order: tuple[int, int, int]) -> None:
    """Bonds point along +axis for every axis, and drag is equal along all axes."""
    material, phase, fixed = (np.ascontiguousarray(a.transpose(order)) for a in body)
    options: dict[str, Any] = {"fluid_drag": 1e5, "complete_contacts": True}
    plain = simulate(body, **options)
    turned = simulate((material, phase, swapped(fixed, order)), **options)
    assert apart(turned, plain.transpose(0, *(1 + i for i in order), 4)[..., list(order)]) < 1e-10 * L


@given(bodies(), st.tuples(*(st.integers(0, 2),) * 3), st.booleans())
def test_the_position_in_the_canvas_does_not_matter(
    body: Body,
    shift: tuple[int, int, int],
    floor: bool,
) -> None:
    """Along x and y, and along z without a floor."""
    shift = (*shift[:2], 0 if floor else shift[2])
    options: dict[str, Any] = HEAVY | {"floor": floor}
    material, phase, fixed = (np.pad(a, [(n, 1) for n in shift]) for a in body)
    moved = simulate((material, phase, fixed), **options)
    x, y, z = body[0].shape
    inside = moved[:, shift[0] :, shift[1] :, shift[2] :][:, :x, :y, :z]
    assert apart(inside - L * np.array(shift), simulate(body, **options)) < 1e-9 * L


@given(bodies(), st.integers(-6, 6))
def test_whole_cycles_do_not_matter(body: Body, cycles: int) -> None:
    """Except for 2 pi, which the engine rounds to single precision."""
    material, phase, fixed = body
    assert apart(simulate((material, phase + cycles, fixed)), simulate(body)) < 1e-4 * L


@given(bodies())
def test_half_a_cycle_changes_the_sign(body: Body) -> None:
    material, phase, fixed = body
    turned = simulate((material, phase + 0.5, fixed))
    assert apart(turned, simulate(body, temperature_amplitude=-14.4714242553)) < 1e-4 * L


@given(bodies())
def test_a_shorter_time_step_changes_little(body: Body) -> None:
    """Compare half the step, at every second sample."""
    options: dict[str, Any] = {"slow_damping": 0.0, "bond_damping": 0.0, "self_collision": False}
    coarse = simulate(body, time_step_fraction=0.02, **options)
    for fine in (
        simulate(body, time_step_fraction=0.01, **options),
        simulate(body, time_step_fraction=0.02, substeps=2, **options),
    ):
        half = STEPS // 2
        assert apart(fine[2 : 2 * half + 1 : 2], coarse[1 : half + 1]) < 1e-2 * L


# ---- mirrors and quarter turns: approximate, as bonds have the lower voxel's frame (docs/physics.md, 12.3)


def mirrored(body: Body) -> tuple[Body, Any]:
    """Return the body mirrored in y, and the transformation of positions."""
    width = body[0].shape[1] * L
    material, phase, fixed = (np.ascontiguousarray(a[:, ::-1]) for a in body)

    def expected(voxels: NDArray[np.float64]) -> NDArray[np.float64]:
        x, y, z = np.moveaxis(voxels[:, :, ::-1], -1, 0)
        return np.stack([x, width - y, z], axis=-1)

    return (material, phase, fixed), expected


def turned_about_z(body: Body) -> tuple[Body, Any]:
    """Return the body turned by 90 degrees, x to y, and the transformation of positions."""
    width = body[0].shape[1] * L
    material, phase, fixed = (np.ascontiguousarray(np.rot90(a, axes=(0, 1))) for a in body)

    def expected(voxels: NDArray[np.float64]) -> NDArray[np.float64]:
        x, y, z = np.moveaxis(np.rot90(voxels, axes=(1, 2)), -1, 0)
        return np.stack([width - y, x, z], axis=-1)

    return (material, phase, swapped(fixed, (1, 0, 2))), expected


def turned_about_x(body: Body) -> tuple[Body, Any]:
    """Return the body turned by 90 degrees, y to z, and the transformation of positions."""
    height = body[0].shape[2] * L
    material, phase, fixed = (np.ascontiguousarray(np.rot90(a, axes=(1, 2))) for a in body)

    def expected(voxels: NDArray[np.float64]) -> NDArray[np.float64]:
        x, y, z = np.moveaxis(np.rot90(voxels, axes=(2, 3)), -1, 0)
        return np.stack([x, height - z, y], axis=-1)

    return (material, phase, swapped(fixed, (0, 2, 1))), expected


SYMMETRIES = {"mirror": mirrored, "about z": turned_about_z, "about x": turned_about_x}


@pytest.mark.parametrize("symmetry", SYMMETRIES)
@given(body=bodies(), strain=st.sampled_from([1e-3, 1e-4]))
def test_small_motions_turn_with_the_body(symmetry: str, body: Body, strain: float) -> None:
    """Differences are of second order in the strain of the actuation."""
    other, expected = SYMMETRIES[symmetry](body)
    options: dict[str, Any] = {"temperature_amplitude": 100 * strain, "complete_contacts": True}
    options |= {"collision_envelope": 1.0}  # no contacts at the start
    plain = simulate(body, **options)
    assert apart(simulate(other, **options), expected(plain)) < 2.0 * strain**2 * L


@pytest.mark.parametrize("symmetry", SYMMETRIES)
@given(body=bodies(), weight=st.booleans())
def test_large_motions_nearly_turn_with_the_body(
    symmetry: str,
    body: Body,
    weight: bool,
) -> None:
    other, expected = SYMMETRIES[symmetry](body)
    options: dict[str, Any] = {"complete_contacts": True}
    options |= HEAVY if weight and symmetry != "about x" else {}
    plain = simulate(body, **options)
    assert apart(simulate(other, **options), expected(plain)) < 0.05 * L


@given(bodies())
def test_voxels_without_bonds_turn_exactly(body: Body) -> None:
    """Contacts, weight, floor, friction and drag have no frame: exact up to rounding (floor: about z)."""
    material, phase, fixed = body
    loose = np.where(np.indices(material.shape).sum(axis=0) % 2 == 0, material, 0).astype(np.uint8)
    loose[0, 0, 0] = 1
    alone: Body = (loose, phase, fixed)
    options: dict[str, Any] = HEAVY | {"complete_contacts": True}
    options |= {"contact_damping": 0.2, "contact_friction": True, "fluid_by_size": True}
    other, expected = turned_about_z(alone)
    plain = simulate(alone, **options, floor=True)
    assert apart(simulate(other, **options, floor=True), expected(plain)) < 1e-9 * L


def test_bodies_in_the_strategy_move() -> None:
    """The laws are not tested on bodies at rest."""
    shape = (3, 2, 2)
    body = (np.full(shape, 3, np.uint8), np.linspace(0, 1, 12).reshape(shape), np.zeros(shape, np.uint8))
    assert way(simulate(body)) > 0.05 * L
