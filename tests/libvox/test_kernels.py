"""Agreement of all kernels: the fast ones bit for bit, the scalar reference up to rounding."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from soft_bodies import EDGE as L, TRACKS, Case, assert_same, cases

from evoframe_libvox import KERNELS, Material, Model, Result

ModelMaker = Callable[..., Model]
FAST = KERNELS[1:]


def simulated(case: Case, kernel: str) -> Result:
    return case.simulate(range(case.steps()), kernel=kernel)


@given(cases())
def test_fast_kernels_return_the_same_bits(case: Case) -> None:
    first = simulated(case, FAST[0])
    for kernel in FAST[1:]:
        assert_same(first, simulated(case, kernel))


@given(cases())
def test_the_fast_kernel_agrees_with_the_reference(case: Case) -> None:
    """Within 1e-9 edges after 15 to 30 steps, far less than the effect of any rule."""
    reference, fast = simulated(case, "scalar"), simulated(case, FAST[-1])
    assert np.array_equal(reference.diverged_step, fast.diverged_step)
    for track in ("tip", "face", "body", "voxels"):
        off = np.abs(fast.tracks[track] - reference.tracks[track])
        assert np.nanmax(off, initial=0.0) < 1e-9 * L


@pytest.mark.parametrize("kernel", KERNELS)
def test_divergence_in_the_last_step_is_reported(small_model: ModelMaker, kernel: str) -> None:
    """Gravity moves a voxel beyond the limit in the last of 22 steps."""
    fall = dict[str, Any](gravity=-9.81, duration=0.07, slow_damping=0.0, kernel=kernel, whole_body=True)
    body, phase = np.ones((1, 2, 1, 1), np.uint8), np.zeros((1, 2, 1, 1))
    z = small_model((2, 1, 1), **fall).simulate(body, phase, range(23), ["tip"]).tracks["tip"][0, :, 2]
    way = np.abs(z - z[0])
    limit = (way[21] + way[22]) / 2 / (2 * L)
    result = small_model((2, 1, 1), **fall, largest_distance=limit).simulate(body, phase, [21], ["tip"])
    assert result.diverged_step.tolist() == [22]
    assert np.isfinite(result.tracks["tip"]).all()


@pytest.mark.parametrize("kernel", [KERNELS[0], KERNELS[-1]])
@pytest.mark.parametrize(
    "changes",
    [
        {"slow_damping": 0.4},
        {"slow_damping": 3.0},
        {"bond_damping": 3.0},
        {"bond_damping": 12.0, "slow_damping": 0.0},
        {"largest_strain": 0.05},
        {"gravity": -20.0, "largest_distance": 0.1},
    ],
    ids=str,
)
def test_the_step_of_divergence_does_not_depend_on_the_duration(
    small_model: ModelMaker, kernel: str, changes: dict[str, float]
) -> None:
    """Spins that slow damping increases, dampers that are too strong for the step, and tight limits."""
    rng = np.random.default_rng(1)
    body, phase = np.full((1, 3, 3, 2), 3, np.uint8), rng.uniform(-1.0, 1.0, (1, 3, 3, 2))
    long = small_model((3, 3, 2), duration=4.0, kernel=kernel, whole_body=True, **changes)
    [diverged] = long.simulate(body, phase, [0], []).diverged_step.tolist()
    assert diverged > 1
    dt = long.time_steps(body)[0][0]
    brief = small_model((3, 3, 2), duration=(diverged - 0.5) * dt, kernel=kernel, whole_body=True, **changes)
    assert brief.time_steps(body)[1].tolist() == [diverged]
    assert brief.simulate(body, phase, [0], []).diverged_step.tolist() == [diverged]


@pytest.mark.parametrize("seed", [0, 1, 2])
def test_bonds_that_turn_by_more_than_half_a_turn(small_model: ModelMaker, seed: int) -> None:
    """Rotations approach quaternions with cosine -1, which count as no rotation; no kernel may return NaN."""
    canvas = (2, 1, 3)
    settings = small_model(
        canvas,
        period=0.02,
        ramp=0.02,
        duration=1.0,
        temperature_amplitude=14.5,
        gravity=-9.81,
        time_step_fraction=1.0,
        bond_damping=1.5,
        slow_damping=0.25,
        self_collision=False,
        largest_strain=10.0,
    ).settings
    fixed = np.array([0, 0, 7, 63, 7, 63], np.uint8).reshape(canvas)
    phase = np.random.default_rng(seed).uniform(-1.0, 1.0, (1, *canvas))
    for kernel in KERNELS:
        model = Model(canvas, {1: Material(5e6, 0.35, 1e6, 0.01)}, settings, fixed, kernel=kernel)
        result = model.simulate(np.ones((1, *canvas), np.uint8), phase, [280], ["voxels"])
        assert result.diverged_step.tolist() == [0]
        assert np.isfinite(result.tracks["voxels"]).all()


@given(cases())
def test_a_body_does_not_depend_on_the_previous_one(case: Case) -> None:
    """Compare a batch of alternating bodies and controllers with each one alone in a new model."""
    body, phase = case.body, case.phase
    other = np.where(body, body[::-1], 0).astype(np.uint8)
    other[-1, 0, 0] = body[-1, 0, 0]
    batch, phases = np.stack([body, body, other, body]), np.stack([phase, -phase, phase, phase])
    steps = case.model().time_steps(batch)[1].min()
    together = case.model().simulate(batch, phases, [0, steps], TRACKS)
    for i in range(4):
        alone = case.model().simulate(batch[i : i + 1], phases[i : i + 1], [0, steps], TRACKS)
        for track in TRACKS:
            assert np.array_equal(alone.tracks[track][0], together.tracks[track][i], equal_nan=True)


def test_a_kernel_can_be_chosen(small_model: ModelMaker, monkeypatch: pytest.MonkeyPatch) -> None:
    free = small_model((2, 1, 1))
    arguments = (free.canvas, free.palette, free.settings, np.zeros((2, 1, 1), np.uint8))
    monkeypatch.delenv("EVOFRAME_KERNEL", raising=False)
    assert Model(*arguments).kernel == KERNELS[-1]
    monkeypatch.setenv("EVOFRAME_KERNEL", "scalar")
    assert Model(*arguments).kernel == "scalar"
    assert Model(*arguments, kernel="generic").kernel == "generic"
    with pytest.raises(ValueError, match=r"^kernel .* scalar, .*, got abacus"):
        Model(*arguments, kernel="abacus")
    monkeypatch.setenv("EVOFRAME_KERNEL", "abacus")
    with pytest.raises(ValueError, match=r"^EVOFRAME_KERNEL .*, got abacus"):
        Model(*arguments)
