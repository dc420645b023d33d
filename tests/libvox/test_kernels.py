"""Agreement of all kernels: the fast ones bit for bit, the scalar reference up to rounding."""

from collections.abc import Callable
from typing import Any, get_args

import numpy as np
import pytest
from hypothesis import given, strategies as st
from hypothesis.extra import numpy as arrays
from numpy.typing import NDArray

from evoframe_libvox import FIX_ALL, KERNELS, Material, Model, Result, Settings, Track

Bytes = NDArray[np.uint8]
SettingsMaker = Callable[..., Settings]
ModelMaker = Callable[..., Model]
FAST = KERNELS[1:]
TRACKS: tuple[Track, ...] = get_args(Track)
L = 0.05

# Materials with equal bonds, and materials with different bonds.
ALIKE = {1: Material(5e6, 0.35, 1e6, 0.0, 1.0, 0.5), 3: Material(5e6, 0.35, 1e6, 0.01, 1.0, 0.5)}
DIFFERENT = ALIKE | {3: Material(1e6, 0.2, 5e5, -0.02, 0.3, 0.1), 7: Material(2e7, 0.45, 3e6, 0.03, 0.1, 0.1)}


@st.composite
def bodies(draw: st.DrawFn, codes: list[int]) -> tuple[Bytes, NDArray[np.float64], Bytes]:
    """Draw materials, phases in cycles and fixed degrees of freedom as arrays over one canvas."""
    canvas = draw(st.tuples(st.integers(1, 7), st.integers(1, 5), st.integers(1, 5)))
    body = draw(arrays.arrays(np.uint8, canvas, elements=st.sampled_from([0, *codes, *codes])))
    body[-1, 0, 0] = codes[0]
    cycles = st.integers(-40, 40).map(lambda n: n / 16)
    phase = draw(arrays.arrays(np.float64, canvas, elements=cycles))
    held = draw(st.sampled_from(["nothing", "slab", "in part"]))
    fixed = np.zeros(canvas, np.uint8)
    if held == "slab":
        fixed[0] = FIX_ALL
    elif held == "in part":
        fixed = draw(arrays.arrays(np.uint8, canvas, elements=st.sampled_from([0, 0, 0, 4, 7, 56, 63])))
    return body, phase, fixed


surroundings = st.fixed_dictionaries(
    {},
    optional={
        "gravity": st.sampled_from([-9.81, 2.0]),
        "floor": st.booleans(),
        "floor_slope": st.sampled_from([0.0, 5.0]),
        "fluid_drag": st.sampled_from([0.0, 700.0]),
        "fluid_by_size": st.booleans(),
        "falling_code": st.sampled_from([0, 1]),
        "smallest_size": st.sampled_from([0.1, 0.95]),
        "largest_size": st.sampled_from([1.0, 1.05, 3.0]),
        "size_clamp": st.booleans(),
        "start_time": st.sampled_from([0.0, 0.01]),
        "ramp": st.sampled_from([0.0, 0.02]),
        "substeps": st.sampled_from([1, 2]),
        "bond_damping": st.sampled_from([0.2, 1.0]),
        "slow_damping": st.sampled_from([0.0, 0.05]),
        "contact_damping": st.sampled_from([0.0, 0.5]),
        "contact_friction": st.booleans(),
        "complete_contacts": st.booleans(),
        "self_collision": st.booleans(),
        "collision_horizon": st.sampled_from([1.3, 2.0, 3.0]),
        "temperature_amplitude": st.sampled_from([5.0, 14.4714242553]),
    },
)

cases = st.one_of(
    st.tuples(st.just(ALIKE), bodies([1, 3]), surroundings),
    st.tuples(st.just(DIFFERENT), bodies([1, 3, 7]), surroundings),
)
Case = tuple[dict[int, Material], tuple[Bytes, NDArray[np.float64], Bytes], dict[str, Any]]


def simulated(case: Case, settings: SettingsMaker, **how: Any) -> Result:
    palette, (body, phase, fixed), options = case
    x, y, z = body.shape
    model = Model((x, y, z), palette, settings(**{"duration": 0.05} | options), fixed, **how)
    return model.simulate(body[None], phase[None], range(int(model.time_steps(body[None])[1][0])), TRACKS)


def assert_same(a: Result, b: Result) -> None:
    assert np.array_equal(a.diverged_step, b.diverged_step)
    for track in TRACKS:
        assert np.array_equal(a.tracks[track], b.tracks[track], equal_nan=True), track


@given(cases)
def test_fast_kernels_return_the_same_bits(small_settings: SettingsMaker, case: Case) -> None:
    first = simulated(case, small_settings, kernel=FAST[0])
    for kernel in FAST[1:]:
        assert_same(first, simulated(case, small_settings, kernel=kernel))


@given(cases)
def test_the_fast_kernel_agrees_with_the_reference(small_settings: SettingsMaker, case: Case) -> None:
    """Within 1e-9 edges after 15 to 30 steps, far less than the effect of any rule."""
    reference = simulated(case, small_settings, kernel="scalar")
    fast = simulated(case, small_settings, kernel=FAST[-1])
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


@given(cases)
def test_a_body_does_not_depend_on_the_previous_one(small_settings: SettingsMaker, case: Case) -> None:
    """Compare a batch of alternating bodies and controllers with each one alone in a new model."""
    palette, (body, phase, fixed), options = case
    x, y, z = body.shape
    other = np.where(body, body[::-1], 0).astype(np.uint8)
    other[-1, 0, 0] = body[-1, 0, 0]
    batch, phases = np.stack([body, body, other, body]), np.stack([phase, -phase, phase, phase])

    def model() -> Model:
        return Model((x, y, z), palette, small_settings(**{"duration": 0.05} | options), fixed)

    steps = model().time_steps(batch)[1].min()
    together = model().simulate(batch, phases, [0, steps], TRACKS)
    for i in range(4):
        alone = model().simulate(batch[i : i + 1], phases[i : i + 1], [0, steps], TRACKS)
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
