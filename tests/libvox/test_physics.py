"""What the traces of the engine do not exercise, against the equations or a law of nature."""

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from evoframe_libvox import Material, Model, Settings

ModelMaker = Callable[..., Model]
MaterialMaker = Callable[..., Material]
L = 0.05


def engine_time_step(fraction: float, stiffness_per_mass: float) -> float:
    return fraction / (2 * 3.1415926 * math.sqrt(stiffness_per_mass))


def harmonic(a: float, b: float) -> float:
    return 2 * a * b / (a + b)


def mass(m: Material) -> float:
    return m.density * L**3


# ---- time step


def test_time_step_follows_the_stiffest_lightest_bond(
    small_model: ModelMaker, material: MaterialMaker
) -> None:
    soft, hard = material(), material(youngs_modulus=5e7, density=2e5)
    model = small_model((3, 1, 1), palette={1: soft, 2: hard}, time_step_fraction=0.7)
    bodies = np.array([[1, 1, 0], [1, 2, 0], [2, 2, 1]], np.uint8).reshape(3, 3, 1, 1)
    mixed = harmonic(5e6, 5e7) * L / mass(hard)
    expected = [engine_time_step(0.7, k) for k in (5e6 * L / mass(soft), mixed, 5e7 * L / mass(hard))]
    dt, steps = model.time_steps(bodies)
    assert dt == pytest.approx(expected, rel=1e-14)
    assert steps.tolist() == [math.floor(0.1 / h) + 1 for h in expected]


def test_body_without_bonds_lacks_the_edge_in_its_time_step(small_model: ModelMaker) -> None:
    model = small_model((2, 2, 1))
    diagonal = np.array([1, 0, 0, 1], np.uint8).reshape(1, 2, 2, 1)
    assert model.time_steps(diagonal)[0] == pytest.approx(engine_time_step(0.9, 5e6 / 125.0), rel=1e-14)


def test_neighbours_that_are_both_clamped_have_no_bond(small_model: ModelMaker) -> None:
    model = small_model((2, 1, 1), clamped=np.ones((2, 1, 1), bool))
    pair = np.ones((1, 2, 1, 1), np.uint8)
    assert model.time_steps(pair)[0] == pytest.approx(engine_time_step(0.9, 5e6 / 125.0), rel=1e-14)


def test_a_single_voxel_stays(small_model: ModelMaker) -> None:
    model = small_model((1, 1, 1))
    tip = model.simulate(np.full((1, 1, 1, 1), 3, np.uint8), np.full((1, 1, 1, 1), 0.3), range(100)).tracks[
        "tip"
    ]
    assert (tip == L / 2).all()


# ---- one bond along an axis, against its equations written out in one dimension


def size_at(time: float, phase: float, before: float, m: Material, s: Settings) -> float:
    rest = float(np.float32(L)) / L
    cycles = time / s.period + float(np.float32(phase))
    size = L * (rest + m.expansion * s.temperature_amplitude * math.sin(6.283185005187988 * cycles))
    too_small, too_large = size < 0.1 * L and size < before, size > 3.0 * L and size > before
    return before if too_small or too_large else size


def axial_pair(ends: tuple[Material, Material], phases: tuple[float, float], s: Settings, steps: int) -> Any:
    """Positions of two voxels joined by one bond after each step, and whether the bond changed its frame."""
    modulus = harmonic(ends[0].youngs_modulus, ends[1].youngs_modulus)
    k = modulus * L
    m = [mass(end) for end in ends]
    dt = engine_time_step(s.time_step_fraction, k / min(m))
    r, v, size = [L / 2, 1.5 * L], [0.0, 0.0], [L, L]
    small, switched, last, rows, time = True, False, 0.0, [list(r)], 0.0
    for step in range(steps):
        rest = (size[0] + size[1]) / 2
        distance = r[1] - r[0]
        stays_small = distance / rest <= 1.43 if small else distance / rest < 1.30
        stretch = distance - rest
        force = [k * stretch, -k * stretch]
        if stays_small == small:
            rate = (stretch - last) / dt if step else 0.0
            damping = [s.bond_damping / 2 * 2 * math.sqrt(k * mass) * rate for mass in m]
            force = [force[0] + damping[0], force[1] - damping[1]]
            last = stretch
        switched |= stays_small != small
        small = stays_small
        for i in range(2):
            drag = s.slow_damping * 2 * math.sqrt(m[i] * ends[i].youngs_modulus * L)
            v[i] += (force[i] - drag * v[i]) * dt / m[i]
            r[i] += v[i] * dt
            size[i] = size_at(time, phases[i], size[i], ends[i], s)
        time += dt
        rows.append(list(r))
    return np.array(rows), switched


PAIRS = {
    "alike": ({"expansion": 0.01}, {"expansion": 0.01}),
    "unequal masses": ({"density": 3e6}, {"density": 5e5, "expansion": 0.01}),
    "unequal stiffness": ({"youngs_modulus": 5e7, "expansion": 0.01}, {"youngs_modulus": 2e6}),
    "unequal Poisson ratios": ({"poisson_ratio": 0.0, "expansion": 0.01}, {"poisson_ratio": 0.49}),
    "negative expansion": ({"expansion": -0.01}, {"expansion": -0.02}),
    "opposite expansions": ({"expansion": 0.02}, {"expansion": -0.01, "density": 2e6}),
}


@pytest.mark.parametrize("axis", [0, 1, 2])
@pytest.mark.parametrize("pair", PAIRS)
def test_one_bond_is_a_damped_spring(
    small_model: ModelMaker, material: MaterialMaker, pair: str, axis: int
) -> None:
    ends = (material(**PAIRS[pair][0]), material(**PAIRS[pair][1]))
    assert axial_deviation(small_model, ends, (0.13, -0.21), axis) < 1e-14


@pytest.mark.parametrize("field", ["poisson_ratio", "youngs_modulus"])
def test_a_bond_has_the_harmonic_mean_of_its_ends(
    small_model: ModelMaker, material: MaterialMaker, field: str
) -> None:
    """A checkerboard of two materials, in which every bond joins both, moves as one of their mean."""
    low, high = {"poisson_ratio": (0.1, 0.4), "youngs_modulus": (4e6, 9e6)}[field]
    body = (1 + np.indices((4, 3, 3)).sum(axis=0) % 2).astype(np.uint8)[None]
    phase = np.random.default_rng(4).uniform(-1, 1, body.shape)

    def motion(of_1: float, of_2: float) -> NDArray[np.float64]:
        ends = {i: material(expansion=0.01, **{field: x}) for i, x in ((1, of_1), (2, of_2))}
        model = small_model((4, 3, 3), palette=ends, slow_damping=0.0, duration=1.0)
        track: NDArray[np.float64] = model.simulate(body, phase, range(61), ["voxels"]).tracks["voxels"]
        return track

    mixed = motion(low, high)
    mean, other = harmonic(low, high), (low + high) / 2
    assert np.abs(mixed - motion(mean, mean)).max() < 1e-12
    assert np.abs(mixed - motion(other, other)).max() > 1e-7


@pytest.mark.parametrize("amplitude", [1.5, 5.0])
def test_sizes_beyond_the_limits_are_not_taken(
    small_model: ModelMaker, material: MaterialMaker, amplitude: float
) -> None:
    ends = (material(expansion=amplitude / 14.4714242553), material(expansion=-amplitude / 14.4714242553))
    model = small_model((2, 1, 1), palette={1: ends[0], 2: ends[1]})
    sizes = [L]
    for n in range(100):
        sizes.append(size_at(n * 3.2e-3, 0.2, sizes[-1], ends[0], model.settings))
    assert min(sizes) >= 0.1 * L
    assert max(sizes) <= 3.0 * L
    assert len(set(sizes)) < 100
    assert axial_deviation(small_model, ends, (0.2, 0.4), 0) < 1e-12


def test_an_overstretched_bond_changes_its_frame(small_model: ModelMaker, material: MaterialMaker) -> None:
    ends = (material(expansion=0.06), material(density=1e7))
    model = small_model((2, 1, 1), palette={1: ends[0], 2: ends[1]}, slow_damping=0.0, bond_damping=0.2)
    _, switched = axial_pair(ends, (0.25, 0.0), model.settings, 100)
    assert switched
    assert axial_deviation(small_model, ends, (0.25, 0.0), 0, slow_damping=0.0, bond_damping=0.2) < 1e-13


def axial_deviation(
    small_model: ModelMaker,
    ends: tuple[Material, Material],
    phases: tuple[float, float],
    axis: int,
    **changes: float,
) -> float:
    """Return by how much the solver and the written-out equations differ over 100 steps, m."""
    canvas = tuple(np.roll((2, 1, 1), axis).tolist())
    model = small_model(canvas, palette={1: ends[0], 2: ends[1]}, duration=2.0, **changes)
    body = np.array([1, 2], np.uint8).reshape(1, *canvas)
    result = model.simulate(body, np.reshape(phases, body.shape), range(101), ["voxels"])
    positions = result.tracks["voxels"][0].reshape(101, 2, 3)
    expected, _ = axial_pair(ends, phases, model.settings, 100)
    assert np.abs(expected - expected[0]).max() > 1e-4
    across = np.delete(positions, axis, axis=-1)
    assert (across == L / 2).all()
    return float(np.abs(positions[..., axis] - expected).max())


# ---- contacts


def first_push(model: Model, body: NDArray[np.uint8]) -> Any:
    """Displacements after one step, in which nothing acts but contacts: sizes are still those at rest."""
    moved = model.simulate(body, np.zeros(body.shape), [0, 1], ["voxels"]).tracks["voxels"][0]
    return moved[1] - moved[0]


def test_diagonal_voxels_on_a_path_of_four_bonds_repel_at_rest(
    small_model: ModelMaker, material: MaterialMaker
) -> None:
    ends = {1: material(), 2: material(youngs_modulus=2e7, density=2e6)}
    model = small_model((2, 2, 2), palette=ends)
    body = np.ones((1, 2, 2, 2), np.uint8)
    body[0, :, :, 0] = [[0, 1], [2, 0]]
    body[0, 0, 0, 1] = 0
    dt = model.time_steps(body)[0][0]
    overlap = 1.5 * L - math.hypot(L, L)
    push = harmonic(5e6, 2e7) * L * overlap / math.sqrt(2)
    moved = first_push(model, body)
    assert moved[0, 1, 0] == pytest.approx(np.array([-1, 1, 0]) * push * dt**2 / mass(ends[1]), rel=1e-12)
    assert moved[1, 0, 0] == pytest.approx(np.array([1, -1, 0]) * push * dt**2 / mass(ends[2]), rel=1e-12)
    assert not moved[[0, 1, 1], [1, 0, 1], 1].any()
    apart = first_push(small_model((2, 2, 2), palette=ends, self_collision=False), body)
    assert not apart[body[0] > 0].any()


def test_diagonal_voxels_on_a_path_of_two_bonds_do_not_collide(small_model: ModelMaker) -> None:
    body = np.array([[1, 1], [0, 1]], np.uint8).reshape(1, 2, 2, 1)
    assert not first_push(small_model((2, 2, 1)), body)[body[0] > 0].any()


def test_paths_lead_over_existing_bonds_only(small_model: ModelMaker, material: MaterialMaker) -> None:
    """Clamped neighbours have no bond, so no path joins the free corner of a square to its opposite."""
    clamped = np.array([[1, 1], [1, 0]], bool).reshape(2, 2, 1)
    model = small_model((2, 2, 1), clamped=clamped)
    body = np.ones((1, 2, 2, 1), np.uint8)
    dt = model.time_steps(body)[0][0]
    push = 5e6 * L * (1.5 * L - math.hypot(L, L)) / math.sqrt(2)
    moved = first_push(model, body)
    assert moved[1, 1, 0] == pytest.approx(np.array([1, 1, 0]) * push * dt**2 / mass(material()), rel=1e-12)
    assert not moved[clamped].any()


# ---- conservation


@pytest.mark.parametrize("changes", [{}, {"youngs_modulus": 5e7, "poisson_ratio": 0.1}])
def test_a_free_body_keeps_its_momentum(
    small_model: ModelMaker, material: MaterialMaker, changes: dict[str, float]
) -> None:
    assert drift(small_model, material(**changes), bond_damping=1.0) < 1e-14


def test_unequal_densities_keep_it_without_bond_damping(
    small_model: ModelMaker, material: MaterialMaker
) -> None:
    assert drift(small_model, material(density=3e6), bond_damping=0.0) < 1e-14


def test_unequal_densities_lose_it_with_bond_damping(
    small_model: ModelMaker, material: MaterialMaker
) -> None:
    """Each end is damped by its own constants, in the engine as here."""
    assert drift(small_model, material(density=3e6), bond_damping=1.0) > 1e-5


def drift(small_model: ModelMaker, passive: Material, **changes: float) -> float:
    """Return how far the centre of mass of a free, moving body wanders in 60 steps, m."""
    palette = {1: passive, 3: Material(5e6, 0.35, 1e6, 0.01)}
    model = small_model((4, 3, 3), palette=palette, duration=1.0, slow_damping=0.0, **changes)
    rng = np.random.default_rng(3)
    body = rng.choice(np.array([0, 1, 3, 3], np.uint8), (1, 4, 3, 3))
    tracks = model.simulate(body, rng.uniform(-1, 1, body.shape), range(61), ["body", "tip"]).tracks
    assert np.ptp(tracks["tip"], axis=1).max() > 1e-3
    return float(np.ptp(tracks["body"], axis=1).max())


# ---- clamping


def test_clamped_voxels_stay_and_still_change_their_size(small_model: ModelMaker) -> None:
    clamped = np.array([True, False]).reshape(2, 1, 1)
    model = small_model((2, 1, 1), clamped=clamped)
    body = np.array([3, 1], np.uint8).reshape(1, 2, 1, 1)
    voxels = model.simulate(body, np.full(body.shape, 0.25), range(25), ["voxels"]).tracks["voxels"][0]
    assert (voxels[:, 0, 0, 0] == L / 2).all()
    assert voxels[:, 1, 0, 0, 0].max() > 1.5 * L * 1.02
