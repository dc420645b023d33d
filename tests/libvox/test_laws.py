"""Laws that hold for every small body."""

from typing import Any

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays
from numpy.typing import NDArray

from evoframe_libvox import Material, Model, Settings

L = 0.05
STEPS = 25
PALETTE = {
    1: Material(5e6, 0.35, 1e6, 0.0),
    2: Material(2e7, 0.1, 5e5, 0.0),
    3: Material(5e6, 0.35, 1e6, 0.01),
    4: Material(5e6, 0.35, 2e6, -0.01),
}
canvases = st.tuples(*(st.integers(1, 4),) * 3)
laws = settings(deadline=None, max_examples=60)


@st.composite
def bodies(draw: st.DrawFn) -> tuple[NDArray[np.uint8], NDArray[np.float64], NDArray[np.bool_]]:
    """A body that is not empty, a controller and a mask of clamped cells."""
    canvas = draw(canvases)
    material = draw(arrays.arrays(np.uint8, canvas, elements=st.sampled_from([0, 1, 2, 3, 4])))
    material[tuple(draw(st.integers(0, n - 1)) for n in canvas)] = 3
    phase = draw(arrays.arrays(np.float64, canvas, elements=st.integers(-64, 64).map(lambda n: n / 64)))
    return material, phase, draw(arrays.arrays(np.bool_, canvas))


def simulate(
    material: NDArray[np.uint8], phase: NDArray[np.float64], clamped: NDArray[np.bool_], **changes: Any
) -> NDArray[np.float64]:
    """Positions after every step."""
    options: dict[str, Any] = {
        "voxel_size": L,
        "duration": 0.2,
        "temperature_amplitude": 14.4714242553,
        "period": 0.25,
    }
    canvas = (material.shape[0], material.shape[1], material.shape[2])
    model = Model(canvas, PALETTE, Settings(**(options | changes)), clamped)
    result = model.simulate(material[None], phase[None], range(STEPS + 1), ["voxels"])
    assert result.diverged_step[0] == 0
    voxels: NDArray[np.float64] = result.tracks["voxels"][0]
    return voxels


def apart(a: NDArray[np.float64], b: NDArray[np.float64]) -> float:
    return float(np.nanmax(np.abs(a - b)))


@laws
@given(bodies())
def test_every_sample_is_finite_and_near(body: Any) -> None:
    material, phase, clamped = body
    voxels = simulate(material, phase, clamped)
    occupied = voxels[:, material > 0]
    assert np.isfinite(occupied).all()
    assert np.abs(occupied - occupied[0]).max() < 2 * L


@laws
@given(bodies())
def test_clamped_voxels_never_move(body: Any) -> None:
    material, phase, clamped = body
    held = simulate(material, phase, clamped)[:, clamped & (material > 0)]
    assert (held == held[0]).all()


@laws
@given(bodies(), st.permutations((0, 1, 2)))
def test_the_axes_are_alike(body: Any, order: tuple[int, int, int]) -> None:
    """Bonds point along +axis whatever the axis. (Contacts are told apart by order: left out.)"""
    material, phase, clamped = body
    plain = simulate(material, phase, clamped, self_collision=False)
    turned = simulate(*(np.ascontiguousarray(a.transpose(order)) for a in body), self_collision=False)
    assert apart(turned, plain.transpose(0, *(1 + i for i in order), 4)[..., list(order)]) < 1e-10 * L


@laws
@given(bodies(), st.tuples(*(st.integers(0, 2),) * 3))
def test_the_place_on_the_canvas_does_not_matter(body: Any, shift: tuple[int, int, int]) -> None:
    pad = [(n, 1) for n in shift]
    moved = simulate(*(np.pad(a, pad) for a in body))
    x, y, z = body[0].shape
    inside = moved[:, shift[0] :, shift[1] :, shift[2] :][:, :x, :y, :z]
    assert apart(inside - L * np.array(shift), simulate(*body)) < 1e-9 * L


@laws
@given(bodies(), st.integers(-6, 6))
def test_whole_cycles_do_not_matter(body: Any, cycles: int) -> None:
    """But for 2 pi, which the engine rounds to single precision."""
    material, phase, clamped = body
    assert apart(simulate(material, phase + cycles, clamped), simulate(material, phase, clamped)) < 1e-4 * L


@laws
@given(bodies())
def test_a_mirrored_body_moves_nearly_mirrored(body: Any) -> None:
    """Not exactly: the frame of a bond is that of its lower voxel."""
    plain = simulate(*body)
    mirrored = simulate(*(np.ascontiguousarray(a[:, ::-1]) for a in body))[:, :, ::-1]
    mirrored = np.stack(
        [mirrored[..., 0], body[0].shape[1] * L - mirrored[..., 1], mirrored[..., 2]], axis=-1
    )
    assert apart(plain, mirrored) < 0.05 * L


@laws
@given(bodies())
def test_a_shorter_time_step_changes_little(body: Any) -> None:
    """Half the step, every second sample."""
    material, phase, clamped = body
    options: dict[str, Any] = {"slow_damping": 0.0, "bond_damping": 0.0, "self_collision": False}
    coarse = simulate(material, phase, clamped, time_step_fraction=0.02, **options)
    fine = simulate(material, phase, clamped, time_step_fraction=0.01, **options)
    half = STEPS // 2
    assert apart(fine[2 : 2 * half + 1 : 2], coarse[1 : half + 1]) < 1e-2 * L


def test_bodies_in_the_strategy_move() -> None:
    """The laws are not about bodies at rest."""
    material = np.full((3, 2, 2), 3, np.uint8)
    voxels = simulate(material, np.linspace(0, 1, 12).reshape(3, 2, 2), np.zeros((3, 2, 2), bool))
    assert np.abs(voxels - voxels[0]).max() > 0.05 * L
