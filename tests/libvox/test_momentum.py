"""Conservation and dissipation of momentum and energy, and their tracks.

Forces are equal and opposite, so that a free body conserves linear momentum up to rounding if both ends of
its bonds have equal damping (docs/physics.md, 12.7). A bond's moments balance its shear only at the
length of a lattice edge (section 5: b2 L = 3 b3), so that angular momentum is conserved to second order in
the deformation.
"""

import math
from collections.abc import Callable
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from hypothesis import given, strategies as st
from numpy.typing import NDArray

from evoframe_libvox import FIX_ALL, Material, Model

ModelMaker = Callable[..., Model]
MaterialMaker = Callable[..., Material]
Follow = Callable[..., dict[str, NDArray[np.float64]]]
L = 0.05
CANVAS = (4, 3, 3)
UNDAMPED: dict[str, Any] = {"slow_damping": 0.0, "bond_damping": 0.0}
KICKED: dict[str, Any] = {"period": 1e9, "duration": 1.0}  # sizes jump in the first step and remain constant


def some_body(seed: int = 3) -> tuple[NDArray[np.uint8], NDArray[np.float64]]:
    rng = np.random.default_rng(seed)
    body = rng.choice(np.array([0, 1, 3, 3], np.uint8), CANVAS)
    body[1, 1, 1] = 3
    return body, rng.uniform(-0.25, 0.25, CANVAS)


def time_step(model: Model, body: NDArray[np.uint8]) -> float:
    return float(model.time_steps(body[None])[0][0])


# ---- linear momentum


@pytest.mark.parametrize(
    "changes",
    [{}, {"youngs_modulus": 5e7, "poisson_ratio": 0.1}, {"expansion": -0.02}],
    ids=["alike", "stiffer", "contracting"],
)
@pytest.mark.parametrize("self_collision", [False, True])
def test_a_free_body_conserves_momentum(
    small_model: ModelMaker, material: MaterialMaker, follow: Follow, changes: Any, self_collision: Any
) -> None:
    assert drift(small_model, follow, material(**changes), self_collision=self_collision) < 1e-14


def test_unequal_densities_conserve_it_without_bond_damping(
    small_model: ModelMaker, material: MaterialMaker, follow: Follow
) -> None:
    assert drift(small_model, follow, material(density=3e6), bond_damping=0.0) < 1e-14


def test_unequal_densities_lose_it_with_bond_damping(
    small_model: ModelMaker, material: MaterialMaker, follow: Follow
) -> None:
    """Each end is damped with its own constants, as in the engine."""
    assert drift(small_model, follow, material(density=3e6), bond_damping=1.0) > 1e-5


def drift(small_model: ModelMaker, follow: Follow, passive: Material, **changes: Any) -> float:
    """Return the displacement of the center of mass of a free, moving body in 60 steps, m."""
    palette = {1: passive, 3: Material(5e6, 0.35, 1e6, 0.01)}
    model = small_model(CANVAS, palette=palette, duration=1.0, slow_damping=0.0, **changes)
    body, phase = some_body()
    tracks = follow(model, body, 4 * phase, range(61))
    assert np.ptp(tracks["tip"], axis=0).max() > 1e-3
    wander = float(np.ptp(tracks["body"], axis=0).max())
    assert (np.abs(tracks["momentum"][:, :3]).max() < 1e-9) == (wander < 1e-14)
    return wander


def test_the_net_force_of_unequal_ends_is_the_difference_of_their_dampers(
    small_model: ModelMaker, material: MaterialMaker, follow: Follow
) -> None:
    """For a bond that is stretched by d in one step: sqrt(a1) (sqrt(m1) - sqrt(m2)) d / dt."""
    palette = {1: material(density=4e6), 3: material(expansion=0.01)}
    model = small_model((2, 1, 1), palette=palette, slow_damping=0.0, **KICKED)
    tracks = follow(model, [1, 3], 0.25, range(4))
    dt = time_step(model, np.array([1, 3], np.uint8).reshape(2, 1, 1))
    jump = (float(np.float32(L)) - L) + 0.144714242553 * L / 2
    left = math.sqrt(5e6 * L) * (math.sqrt(500.0) - math.sqrt(125.0)) * -jump
    assert not tracks["momentum"][1].any()
    assert tracks["momentum"][2, 0] == pytest.approx(left, rel=1e-9)
    assert dt > 0.0


# ---- angular momentum


def spins(small_model: ModelMaker, follow: Follow, amplitude: float, **changes: Any) -> tuple[float, float]:
    """Return the largest angular momentum of a kicked body, and that of its translating voxels."""
    model = small_model(CANVAS, temperature_amplitude=amplitude, **(UNDAMPED | KICKED | changes))
    body, phase = some_body()
    tracks = follow(model, body, phase)
    speed = np.diff(tracks["voxels"], axis=0)[:, body > 0] / time_step(model, body)
    flying = np.abs(np.cross(tracks["voxels"][1:, body > 0], 125.0 * speed)).sum(axis=1).max()
    return float(np.abs(tracks["momentum"][:, 3:]).max()), float(flying)


def test_angular_momentum_is_conserved_to_second_order(
    small_model: ModelMaker, follow: Follow, report: Callable[[str], None]
) -> None:
    sizes = (0.01, 0.1, 1.0)
    found = [spins(small_model, follow, size, self_collision=False) for size in sizes]
    report("angular momentum of the body against its voxels': " + ", ".join(f"{a / b:.1e}" for a, b in found))
    for (total, flying), size in zip(found, sizes, strict=True):
        assert total < 5e-3 * size * flying
    for (less, _), (more, _) in pairwise(found):
        assert more / less == pytest.approx(100.0, rel=0.2)


def test_a_stretching_chain_has_no_angular_momentum(small_model: ModelMaker, follow: Follow) -> None:
    """No torque acts on it; exact up to rounding."""
    model = small_model((6, 1, 1), **UNDAMPED, **KICKED)
    tracks = follow(model, 3, [0.1, -0.2, 0.25, 0.0, 0.05, -0.1])
    assert tracks["energy"][:, 1].max() > 1.0
    assert np.abs(tracks["momentum"][:, 3:]).max() < 1e-12


def test_contacts_conserve_it(small_model: ModelMaker, follow: Follow) -> None:
    """Their forces act along the line between two voxels."""
    body = (np.indices((3, 3, 3)).sum(axis=0) % 2 == 0).astype(np.uint8)
    tracks = follow(small_model((3, 3, 3), slow_damping=0.0), body)
    assert tracks["energy"][-1, 1] > 1.0
    assert np.abs(tracks["momentum"]).max() < 1e-11


# ---- energy


@pytest.mark.parametrize("held", [0, FIX_ALL])
def test_energy_stays_between_bounds_without_damping(
    small_model: ModelMaker, material: MaterialMaker, follow: Follow, held: int
) -> None:
    """Semi-implicit Euler conserves T + V - dt/2 v K x: the energy of a spring varies by the factor
    (1 + a) / (1 - a), a = w0 dt / 2, and does not drift.
    """
    palette = {3: material(expansion=1e-4)}
    model = small_model(
        (2, 1, 1), palette=palette, fixed=[held, 0], **UNDAMPED, **(KICKED | {"duration": 60.0})
    )
    energy = follow(model, 3, 0.25, tracks=["energy"])["energy"].sum(axis=1)[2:]
    own = math.sqrt(5e6 * L / (125.0 if held else 62.5))
    a = own * time_step(model, np.full((2, 1, 1), 3, np.uint8)) / 2
    assert energy.max() / energy.min() == pytest.approx((1 + a) / (1 - a), rel=1e-3)
    half = len(energy) // 2
    assert energy[half:].max() == pytest.approx(energy[:half].max(), rel=1e-4)
    assert energy[half:].min() == pytest.approx(energy[:half].min(), rel=1e-4)


@given(seed=st.integers(0, 1000))
def test_energy_does_not_grow_without_damping(small_model: ModelMaker, follow: Follow, seed: int) -> None:
    """A slightly kicked body oscillates at several frequencies, with peaks at several times."""
    options = UNDAMPED | KICKED | {"temperature_amplitude": 0.1, "self_collision": False, "duration": 3.0}
    body, phase = some_body(seed)
    energy = follow(small_model(CANVAS, **options), body, phase, tracks=["energy"])["energy"].sum(axis=1)[2:]
    early, late = energy[: len(energy) // 3], energy[-len(energy) // 3 :]
    assert late.max() < 1.05 * early.max()
    assert late.mean() == pytest.approx(early.mean(), rel=0.05)
    assert late.min() > 0.0


@given(seed=st.integers(0, 1000), bond=st.sampled_from([0.3, 1.0]), slow=st.sampled_from([0.0, 0.01]))
def test_damping_reduces_energy(
    small_model: ModelMaker, follow: Follow, seed: int, bond: float, slow: float
) -> None:
    """In every interval of 30 steps except the first, in which the sizes jump."""
    options: dict[str, Any] = KICKED | {"temperature_amplitude": 0.1, "self_collision": False}
    body, phase = some_body(seed)
    model = small_model(CANVAS, bond_damping=bond, slow_damping=slow, **options)
    energy = follow(model, body, phase, tracks=["energy"])["energy"].sum(axis=1)[2:302]
    peaks = energy.reshape(-1, 30).max(axis=1)
    assert (np.diff(peaks) <= 0.0).all()
    assert peaks[-1] < 0.5 * peaks[0]


# ---- tracks


def test_momentum_is_mass_times_displacement_per_step(
    small_model: ModelMaker, material: MaterialMaker, follow: Follow
) -> None:
    """Summed over voxels. A body without bonds has no spin, which also determines angular momentum."""
    palette = {1: material(density=2e6), 3: material(expansion=0.01)}
    options = {"gravity": -9.81, "floor": True, "palette": palette, "duration": 0.2}
    body, phase = some_body()
    for cells in (body, body * (np.indices(CANVAS).sum(axis=0) % 2 == 0).astype(np.uint8)):
        model = small_model(CANVAS, **options)
        tracks = follow(model, cells, phase)
        mass = np.array([0, 2e6, 0, 1e6])[cells[cells > 0]] * L**3
        places = tracks["voxels"][:, cells > 0]
        momenta = mass[:, None] * np.diff(places, axis=0) / time_step(model, cells)
        assert tracks["momentum"][0].tolist() == [0.0] * 6
        assert tracks["momentum"][1:, :3] == pytest.approx(momenta.sum(axis=1), abs=1e-9)
        turning = np.cross(places[1:], momenta).sum(axis=1)
        kinetic = 0.5 * (momenta**2 / mass[:, None]).sum(axis=(1, 2))
        if cells is body:
            assert np.abs(tracks["momentum"][1:, 3:] - turning).max() > 1e-6
            assert (tracks["energy"][1:, 1] >= kinetic - 1e-9).all()
        else:
            assert tracks["momentum"][1:, 3:] == pytest.approx(turning, abs=1e-9)
            assert tracks["energy"][1:, 1] == pytest.approx(kinetic, rel=1e-9, abs=1e-12)
            assert not tracks["energy"][:, 0].any()
            assert not tracks["strain"].any()


def test_energy_and_strain_follow_from_the_bonds(
    small_model: ModelMaker, material: MaterialMaker, follow: Follow
) -> None:
    """In a chain of three: a1 x^2 / 2 for each bond, and x relative to the lattice edge."""
    palette = {3: material(expansion=0.01)}
    model = small_model((1, 3, 1), palette=palette, duration=0.5)
    phases = np.array([0.1, -0.2, 0.3])
    tracks = follow(model, 3, phases)
    dt = time_step(model, np.full((1, 3, 1), 3, np.uint8))
    time = dt * (np.arange(1, len(tracks["tip"])) - 1)[:, None]
    cycles = time / 0.25 + phases.astype(np.float32)
    sizes = float(np.float32(L)) + 0.144714242553 * L * np.sin(6.283185005187988 * cycles)
    stretch = np.diff(tracks["voxels"][1:, 0, :, 0, 1], axis=1) - (sizes[:, 1:] + sizes[:, :-1]) / 2
    assert tracks["energy"][1:, 0] == pytest.approx(0.5 * 5e6 * L * (stretch**2).sum(axis=1), rel=1e-9)
    assert tracks["strain"][1:, 0] == pytest.approx(stretch.min(axis=1) / L, abs=1e-12)
    assert tracks["strain"][1:, 1] == pytest.approx(stretch.max(axis=1) / L, abs=1e-12)
    assert tracks["energy"][0] == pytest.approx([0.0, 0.0], abs=1e-20)


def test_the_work_of_weight_equals_the_energy_of_bending_and_turning(
    small_model: ModelMaker, follow: Follow
) -> None:
    """A bar swings under its weight without damping; the energy includes turning voxels."""
    options = {"gravity": -0.1, "time_step_fraction": 0.005, "duration": 0.3}
    tracks = follow(small_model((3, 1, 1), fixed=[FIX_ALL, 0, 0], **UNDAMPED, **options))
    work = 125.0 * 0.1 * (tracks["voxels"][0] - tracks["voxels"])[..., 2].sum(axis=(1, 2, 3))
    energy = tracks["energy"].sum(axis=1)
    assert np.abs(energy - work).max() < 2e-3 * work.max()
    assert tracks["energy"][:, 1].max() > 0.2 * work.max()


def test_a_slow_load_stores_the_work_that_it_does(small_model: ModelMaker, follow: Follow) -> None:
    """Half of force times displacement for a bar that bends under its weight: Clapeyron's theorem."""
    model = small_model((4, 1, 1), fixed=[FIX_ALL, 0, 0, 0], gravity=-0.01, duration=20.0, slow_damping=0.02)
    tracks = follow(model)
    sag = (tracks["voxels"][0] - tracks["voxels"][-1])[..., 2].sum()
    assert tracks["energy"][-1, 0] == pytest.approx(0.5 * 125.0 * 0.01 * sag, rel=1e-5)
