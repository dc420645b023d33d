"""A voxel with many contacts: all dampers and frictions together never add energy."""

from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings, strategies as st
from numpy.typing import NDArray

from evoframe_libvox import FIX_ALL, Material, Model, Settings

L = 0.05
CANVAS = (5, 5, 3)
PALETTE = {1: Material(5e6, 0.35, 1e6, 0.0, 1.0, 0.5), 2: Material(5e6, 0.35, 1e6, 0.0, 5.0, 5.0)}


def bed(code: int) -> tuple[NDArray[np.uint8], NDArray[np.uint8]]:
    """Return a bed of 25 clamped voxels with one above its center and a gap, and the fixed cells."""
    body, fixed = np.zeros(CANVAS, np.uint8), np.zeros(CANVAS, np.uint8)
    body[:, :, 0] = code
    fixed[:, :, 0] = FIX_ALL
    body[2, 2, 2] = code
    return body, fixed


def energies(body: Any, fixed: Any, **changes: Any) -> NDArray[np.float64]:
    """Return the kinetic energy after every step, with a weight that presses the voxel into the bed."""
    options: dict[str, Any] = {
        "voxel_size": L,
        "duration": 2.0,
        "temperature_amplitude": 0.0,
        "period": 1.0,
        "gravity": -9.81,
        "slow_damping": 0.0,
        "complete_contacts": True,
        "collision_envelope": 2.0,
    }
    model = Model(CANVAS, PALETTE, Settings(**(options | changes)), fixed)
    [steps] = model.time_steps(body[None])[1]
    tracks = model.simulate(body[None], np.zeros((1, *CANVAS)), range(int(steps) + 1), ["energy"]).tracks
    energy: NDArray[np.float64] = tracks["energy"][0, :, 1]
    return energy


@pytest.mark.parametrize("code", [1, 2])
@pytest.mark.parametrize("substeps", [1, 4])
def test_a_pressed_voxel_comes_to_rest(code: int, substeps: int) -> None:
    body, fixed = bed(code)
    damped = energies(body, fixed, contact_damping=1.0, contact_friction=True, substeps=substeps)
    assert np.isfinite(damped).all()
    assert damped.max() > 0.5  # J, while falling
    assert damped[-1] < 1e-12 * damped.max()


@given(st.floats(0.5, 1000.0), st.booleans(), st.sampled_from([1.0, 1.5, 2.0]))
@settings(deadline=None)
def test_it_never_gains_more_energy_than_its_weight_supplies(
    damping: float, rubs: bool, envelope: float
) -> None:
    body, fixed = bed(2)
    options = {"contact_friction": rubs, "collision_envelope": envelope, "duration": 0.5}
    damped = energies(body, fixed, contact_damping=damping, **options)
    assert damped.max() <= 125.0 * 9.81 * 2 * L  # J, for a fall through the gap
    assert damped[-1] < damped.max()


@pytest.mark.parametrize("damping", [4.0, 12.0, 100.0])
def test_strong_damping_does_not_repel(damping: float) -> None:
    """An unlimited damper would add energy in a step."""
    body, fixed = bed(1)
    rebound = energies(body, fixed, contact_damping=damping, gravity=-1.0, collision_envelope=1.0)
    fall = int(np.argmax(rebound))
    assert rebound[fall:].max() == rebound[fall]
    assert rebound[-1] < 0.01 * rebound[fall]
