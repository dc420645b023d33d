"""Voxels that are clamped in some or all degrees of freedom (docs/physics.md, section 8)."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from hypothesis import given, strategies as st
from hypothesis.extra import numpy as arrays
from numpy.typing import NDArray

from evoframe_libvox import FIX_ALL, Model

ModelMaker = Callable[..., Model]
Follow = Callable[..., dict[str, NDArray[np.float64]]]
L = 0.05
POSITION, ROTATION = 7, 56
MASS, STIFFNESS = 125.0, 5e6 * L


def test_clamped_voxels_do_not_move_but_change_their_size(small_model: ModelMaker, follow: Follow) -> None:
    voxels = follow(small_model((2, 1, 1), fixed=[FIX_ALL, 0]), [3, 1], 0.25)["voxels"]
    assert (voxels[:, 0, 0, 0] == L / 2).all()
    assert voxels[:, 1, 0, 0, 0].max() > 1.5 * L * 1.02


@st.composite
def held_bodies(draw: st.DrawFn) -> tuple[NDArray[np.uint8], NDArray[np.uint8]]:
    canvas = draw(st.tuples(*(st.integers(1, 3),) * 3))
    masks = st.one_of(st.just(0), st.just(FIX_ALL), st.integers(0, FIX_ALL))
    body = draw(arrays.arrays(np.uint8, canvas, elements=st.sampled_from([0, 1, 3, 3])))
    body[0, 0, 0] = 3
    return body, draw(arrays.arrays(np.uint8, canvas, elements=masks))


@given(held=held_bodies(), floor=st.booleans(), drag=st.sampled_from([0.0, 1e6]))
def test_clamped_coordinates_never_change_and_free_ones_may(
    small_model: ModelMaker,
    follow: Follow,
    held: tuple[NDArray[np.uint8], NDArray[np.uint8]],
    floor: bool,
    drag: float,
) -> None:
    body, masks = held
    surroundings: dict[str, Any] = {"gravity": -9.81, "floor": floor, "fluid_drag": drag}
    model = small_model(body.shape, fixed=masks, **surroundings)
    tracks = follow(model, body, 0.13)
    free = np.stack([masks & 1, masks & 2, masks & 4], axis=-1)[body > 0] == 0
    way = (tracks["voxels"] - tracks["voxels"][0])[:, body > 0]
    assert not way[:, ~free].any()
    falls = free[:, 2].any()
    assert bool(way[..., 2].any()) == bool(falls)
    assert bool(tracks["momentum"][:, 2].any()) == bool(falls)


@pytest.mark.parametrize("axis", [0, 1, 2])
def test_a_voxel_moves_along_its_free_axis(small_model: ModelMaker, follow: Follow, axis: int) -> None:
    """A voxel between diagonal neighbors that push it moves along its only free axis."""
    held = np.zeros((2, 2, 2))
    held[0, 0, 0], held[1, 1, 1] = FIX_ALL, FIX_ALL - (1 << axis)
    body = np.zeros((2, 2, 2))
    body[0, 0, 0] = body[1, 1, 1] = 1
    model = small_model((2, 2, 2), fixed=held, collision_envelope=2.0, slow_damping=0.0)
    way = follow(model, body)["voxels"][:, 1, 1, 1] - 1.5 * L
    assert not np.delete(way, axis, axis=-1).any()
    assert way[-1, axis] > 0.01 * L


# ---- rotation


def bar(small_model: ModelMaker, follow: Follow, held: tuple[int, int], **changes: Any) -> Any:
    """Return the positions after each step of two adjacent voxels that sag until they rest."""
    options = {"gravity": -0.2, "duration": 10.0, "slow_damping": 0.03} | changes
    voxels = follow(small_model((2, 1, 1), fixed=held, **options), tracks=["voxels"])["voxels"]
    return voxels[:, :, 0, 0]


def test_a_clamped_rotation_carries_a_load_and_a_free_one_yields(
    small_model: ModelMaker, follow: Follow
) -> None:
    """A free end sags by 4 m g / (E L) below a clamped one, and a guided end by a quarter of that."""
    sag = MASS * 0.2 / STIFFNESS
    clamped = bar(small_model, follow, (FIX_ALL, 0))
    guided = bar(small_model, follow, (FIX_ALL, ROTATION))
    assert L / 2 - clamped[-1, 1, 2] == pytest.approx(4 * sag, rel=1e-4)
    assert L / 2 - guided[-1, 1, 2] == pytest.approx(sag, rel=1e-4)


def test_the_other_voxel_swings_below_a_pinned_one(small_model: ModelMaker, follow: Follow) -> None:
    voxels = bar(small_model, follow, (POSITION, 0), gravity=-9.81, duration=60.0, slow_damping=0.01)
    assert (voxels[:, 0] == voxels[0, 0]).all()
    assert voxels[-1, 1] - voxels[-1, 0] == pytest.approx([0.0, 0.0, -L * (1 + 0.0981)], abs=2e-4 * L)


@pytest.mark.parametrize(("some", "holds"), [(8, 0), (32, 0), (40, 0), (16, 56), (24, 56), (48, 56)])
def test_a_bar_under_gravity_turns_about_y_only(
    small_model: ModelMaker, follow: Follow, some: int, holds: int
) -> None:
    """Clamping another rotation has no effect; clamping this one has the effect of clamping all."""
    partly, expected, other = (
        bar(small_model, follow, (POSITION + mask, mask), duration=0.5)
        for mask in (some, holds, ROTATION - holds)
    )
    assert partly == pytest.approx(expected, abs=1e-15)
    assert np.abs(partly - other).max() > 1e-6


def test_a_voxel_that_cannot_turn_has_no_spin(small_model: ModelMaker, follow: Follow) -> None:
    """Its angular momentum comes only from its translation."""
    model = small_model((2, 1, 1), fixed=[FIX_ALL, ROTATION], gravity=-1.0)
    tracks = follow(model)
    expected = np.cross(tracks["voxels"][:, 1, 0, 0], tracks["momentum"][:, :3])
    assert tracks["momentum"][:, 3:] == pytest.approx(expected, abs=1e-12)
    assert np.abs(expected).max() > 0.1
