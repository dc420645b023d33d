"""Conditions and steps of divergence, and independence of the other bodies in a batch."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from evoframe_libvox import FIX_ALL, Material, Model, Result

ModelMaker = Callable[..., Model]
MaterialMaker = Callable[..., Material]
Follow = Callable[..., dict[str, NDArray[np.float64]]]
L = 0.05
COLUMN = np.ones((1, 1, 1, 2), np.uint8)


def simulate(model: Model, bodies: NDArray[np.uint8]) -> Result:
    """Simulate bodies with equal numbers of steps, and sample every step."""
    steps = int(model.time_steps(bodies)[1].min())
    return model.simulate(bodies, np.zeros(bodies.shape), range(steps + 1))


def assert_nothing_after(result: Result, bodies: NDArray[np.uint8], body: int) -> None:
    """Check that the samples of a body are finite until it diverges, and NaN from then on."""
    at = int(result.diverged_step[body])
    assert at > 0
    for name, track in result.tracks.items():
        rows = track[body][:, bodies[body] > 0] if name == "voxels" else track[body]
        assert np.isfinite(rows[:at]).all()
        assert np.isnan(rows[at:]).all()


# ---- strain


@pytest.mark.parametrize("gravity", [-9.81, 9.81])
@pytest.mark.parametrize("largest", [0.01, 0.08])
def test_a_bond_beyond_the_largest_strain_has_diverged(
    small_model: ModelMaker, gravity: float, largest: float
) -> None:
    """Stretched or compressed; the step is the one that finds the bond in this state."""
    options = {"fixed": [0, FIX_ALL], "gravity": gravity, "duration": 0.3, "bond_damping": 0.0}
    free = simulate(small_model((1, 1, 2), **options), COLUMN)
    assert free.diverged_step.tolist() == [0]
    strain = free.tracks["strain"][0, :, 0 if gravity > 0 else 1]
    beyond = int(np.flatnonzero(np.abs(strain) > largest)[0])
    bound = simulate(small_model((1, 1, 2), **options, largest_strain=largest), COLUMN)
    assert bound.diverged_step.tolist() == [beyond + 1]
    assert_nothing_after(bound, COLUMN, 0)
    assert np.array_equal(bound.tracks["tip"][0, : beyond + 1], free.tracks["tip"][0, : beyond + 1])


def test_a_strain_that_is_never_reached_changes_nothing(small_model: ModelMaker) -> None:
    options: dict[str, Any] = {"fixed": [0, FIX_ALL], "gravity": -1.0}
    plain = simulate(small_model((1, 1, 2), **options), COLUMN)
    bound = simulate(small_model((1, 1, 2), **options, largest_strain=0.1), COLUMN)
    assert bound.diverged_step.tolist() == [0]
    assert np.array_equal(plain.tracks["tip"], bound.tracks["tip"])


# ---- distance


@pytest.mark.parametrize("largest", [0.3, 1.0, 7.5])
@pytest.mark.parametrize("canvas", [(1, 1, 1), (3, 1, 2)])
def test_a_voxel_beyond_the_largest_distance_has_diverged(
    small_model: ModelMaker, follow: Follow, largest: float, canvas: tuple[int, int, int]
) -> None:
    """Measured from its start, in longest edges of the canvas."""
    options = {"gravity": -9.81, "slow_damping": 0.0, "duration": 1.0}
    body = np.zeros((1, *canvas), np.uint8)
    body[0, 0, 0, 0] = 1
    fallen = L / 2 - follow(small_model(canvas, **options, largest_distance=1e3), body)["tip"][:, 2]
    result = simulate(small_model(canvas, **options, largest_distance=largest), body)
    assert result.diverged_step.tolist() == [np.flatnonzero(fallen > largest * max(canvas) * L)[0]]
    assert_nothing_after(result, body, 0)


def test_a_clamped_voxel_never_exceeds_the_distance(small_model: ModelMaker) -> None:
    model = small_model((1, 1, 2), fixed=[FIX_ALL, FIX_ALL], gravity=-1e9, largest_distance=1e-9)
    assert simulate(model, COLUMN).diverged_step.tolist() == [0]


# ---- numbers that are not finite


@pytest.mark.parametrize(
    "changes",
    [
        {"gravity": 1e308},
        {"gravity": -1e200},
        {"fluid_drag": 1e308, "gravity": -9.81},
        {"slow_damping": 1e308, "gravity": -9.81},
        {"floor": True, "floor_damping": 1e308, "gravity": -9.81},
        {"temperature_amplitude": 1e300},
    ],
)
@pytest.mark.parametrize("bounds", [{}, {"largest_strain": 1e9, "largest_distance": 1e9}])
def test_absurd_forces_lead_to_divergence(
    small_model: ModelMaker, changes: dict[str, Any], bounds: dict[str, float]
) -> None:
    """With any bounds, all samples before the reported step are finite."""
    bodies = np.full((1, 1, 1, 2), 3, np.uint8)
    result = simulate(small_model((1, 1, 2), duration=3.0, **changes, **bounds), bodies)
    if "temperature_amplitude" in changes:  # sizes stay within the limits
        assert result.diverged_step.tolist() == [0]
    else:
        assert_nothing_after(result, bodies, 0)


# ---- other bodies


def test_the_other_bodies_in_a_batch_are_not_affected(
    small_model: ModelMaker, material: MaterialMaker
) -> None:
    """The bond of a heavy body breaks; the light bodies before and after it move like bodies alone."""
    palette = {1: material(), 2: material(density=1e8), 3: material(youngs_modulus=5e8, density=1e8)}
    options = {"fixed": [FIX_ALL, 0, 0], "gravity": -9.81, "largest_strain": 0.5, "duration": 0.5}
    model = small_model((3, 1, 1), palette=palette, **options)
    batch = np.array([[1, 1, 1], [1, 2, 2], [1, 1, 0], [1, 2, 1], [3, 3, 0]], np.uint8).reshape(5, 3, 1, 1)
    result = simulate(model, batch)
    assert [step > 0 for step in result.diverged_step] == [False, True, False, True, False]
    for body in (1, 3):
        assert_nothing_after(result, batch, body)
    steps = range(result.tracks["tip"].shape[1])
    for body in range(5):
        alone = model.simulate(batch[[body]], np.zeros((1, 3, 1, 1)), steps)
        assert alone.diverged_step[0] == result.diverged_step[body]
        for name, track in alone.tracks.items():
            assert np.array_equal(track[0], result.tracks[name][body], equal_nan=True)


@pytest.mark.parametrize("self_collision", [False, True])
@pytest.mark.parametrize("fluid_drag", [0.0, 1.0])
def test_divergence_after_the_last_sample_is_reported_only_for_the_whole_body(
    small_model: ModelMaker, fluid_drag: float, self_collision: bool
) -> None:
    options: dict[str, Any] = {
        "gravity": -9.81,
        "slow_damping": 0.0,
        "duration": 1.0,
        "largest_distance": 1.0,
    }
    options |= {"fluid_drag": fluid_drag, "self_collision": self_collision}
    for samples in ([0], [0, 5]):
        whole = small_model((1, 1, 2), whole_body=True, **options)
        result = whole.simulate(COLUMN, np.zeros(COLUMN.shape), samples)
        assert result.diverged_step[0] > 5
        assert all(np.isfinite(track).all() for track in result.tracks.values())
        usual = small_model((1, 1, 2), **options).simulate(COLUMN, np.zeros(COLUMN.shape), samples)
        assert usual.diverged_step.tolist() == [0]
        assert all(np.array_equal(track, result.tracks[name]) for name, track in usual.tracks.items())
