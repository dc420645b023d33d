"""One bond along an axis, compared with its equations in one dimension (docs/physics.md, 4 to 7)."""

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from evoframe_libvox import FIX_ALL, Material, Model, Settings

ModelMaker = Callable[..., Model]
MaterialMaker = Callable[..., Material]
Follow = Callable[..., dict[str, NDArray[np.float64]]]
L = 0.05
AMPLITUDE = 14.4714242553


def harmonic(a: float, b: float) -> float:
    return 2 * a * b / (a + b)


def mass(m: Material) -> float:
    return m.density * L**3


# ---- the equations


def size_at(time: float, phase: float, before: float, m: Material, s: Settings) -> float:
    rest = float(np.float32(L)) / L
    if time < s.start_time:
        return L * (1.0 + (rest - 1.0) * min(1.0, 2 * time / s.start_time))
    share = min(1.0, (time - s.start_time) / s.ramp) if s.ramp else 1.0
    cycles = time / s.period + float(np.float32(phase))
    strain = share * m.expansion * s.temperature_amplitude * math.sin(6.283185005187988 * cycles)
    size = L * (rest + strain)
    too_small, too_large = size < 0.1 * L and size < before, size > 3.0 * L and size > before
    return before if too_small or too_large else size


class Pair:
    """Two voxels connected by one bond along x."""

    def __init__(self, ends: tuple[Material, Material], phases: tuple[float, float], s: Settings) -> None:
        self.ends, self.phases, self.settings = ends, phases, s
        self.stiffness = harmonic(ends[0].youngs_modulus, ends[1].youngs_modulus) * L
        self.masses = [mass(end) for end in ends]
        fastest = self.stiffness / min(self.masses)
        self.dt = s.time_step_fraction / (2 * 3.1415926 * math.sqrt(fastest)) / s.substeps
        self.at, self.speed, self.size = [L / 2, 1.5 * L], [0.0, 0.0], [L, L]
        self.time, self.last, self.rates, self.small, self.switches = 0.0, 0.0, False, True, 0

    def forces(self) -> list[float]:
        rest, distance = sum(self.size) / 2, self.at[1] - self.at[0]
        small = distance / rest <= 1.43 if self.small else distance / rest < 1.30
        stretch = distance - rest
        force = [self.stiffness * stretch, -self.stiffness * stretch]
        if small == self.small:
            rate = (stretch - self.last) / self.dt if self.rates else 0.0
            share = self.settings.bond_damping / 2 * 2
            drags = [share * math.sqrt(self.stiffness * m) * rate for m in self.masses]
            force = [force[0] + drags[0], force[1] - drags[1]]
            self.last = stretch
        self.switches += small != self.small
        self.small, self.rates = small, True
        return force

    def step(self) -> None:
        force, s = self.forces(), self.settings
        for i, m in enumerate(self.masses):
            drag = s.slow_damping * 2 * math.sqrt(m * self.ends[i].youngs_modulus * L)
            self.speed[i] += (force[i] - drag * self.speed[i]) * self.dt / m
            self.at[i] += self.speed[i] * self.dt
            self.size[i] = size_at(self.time, self.phases[i], self.size[i], self.ends[i], s)
        self.time += self.dt

    def follow(self, steps: int) -> NDArray[np.float64]:
        """Return both positions at the start and after each step, m."""
        rows = [list(self.at)]
        for _ in range(steps):
            self.step()
            rows.append(list(self.at))
        return np.array(rows)


def deviation(
    small_model: ModelMaker,
    ends: tuple[Material, Material],
    phases: tuple[float, float],
    axis: int = 0,
    **changes: Any,
) -> float:
    """Return the difference between solver and equations over 100 steps, m."""
    canvas = tuple(np.roll((2, 1, 1), axis).tolist())
    model = small_model(canvas, palette={1: ends[0], 2: ends[1]}, **({"duration": 2.0} | changes))
    body = np.array([1, 2], np.uint8).reshape(1, *canvas)
    result = model.simulate(body, np.reshape(phases, body.shape), range(101), ["voxels"])
    positions = result.tracks["voxels"][0].reshape(101, 2, 3)
    expected = Pair(ends, phases, model.settings).follow(100)
    assert np.abs(expected - expected[0]).max() > 1e-4
    across = np.delete(positions, axis, axis=-1)
    assert (across == L / 2).all()
    return float(np.abs(positions[..., axis] - expected).max())


# ---- materials

PAIRS = {
    "alike": ({"expansion": 0.01}, {"expansion": 0.01}),
    "unequal masses": ({"density": 3e6}, {"density": 5e5, "expansion": 0.01}),
    "unequal stiffness": ({"youngs_modulus": 5e7, "expansion": 0.01}, {"youngs_modulus": 2e6}),
    "unequal Poisson ratios": ({"poisson_ratio": 0.0, "expansion": 0.01}, {"poisson_ratio": 0.49}),
    "negative expansion": ({"expansion": -0.01}, {"expansion": -0.02}),
    "opposite expansions": ({"expansion": 0.02}, {"expansion": -0.01, "density": 2e6}),
    "all of it": (
        {"density": 3e6, "youngs_modulus": 2e7, "poisson_ratio": 0.1, "expansion": 0.02},
        {"density": 7e5, "youngs_modulus": 3e6, "poisson_ratio": 0.4, "expansion": -0.01},
    ),
}


@pytest.mark.parametrize("axis", [0, 1, 2])
@pytest.mark.parametrize("pair", PAIRS)
def test_one_bond_is_a_damped_spring(
    small_model: ModelMaker, material: MaterialMaker, pair: str, axis: int
) -> None:
    ends = (material(**PAIRS[pair][0]), material(**PAIRS[pair][1]))
    assert deviation(small_model, ends, (0.13, -0.21), axis) < 1e-14


@pytest.mark.parametrize(
    "changes",
    [
        {"bond_damping": 0.0},
        {"bond_damping": 0.3, "slow_damping": 0.0},
        {"time_step_fraction": 0.2},
        {"substeps": 3},
        {"temperature_amplitude": -5.0, "period": 0.07},
    ],
)
def test_one_bond_follows_the_settings(
    small_model: ModelMaker, material: MaterialMaker, changes: dict[str, Any]
) -> None:
    ends = (material(density=2e6, expansion=0.01), material(youngs_modulus=2e6))
    assert deviation(small_model, ends, (0.13, 0.0), **changes) < 1e-14


@pytest.mark.parametrize("field", ["poisson_ratio", "youngs_modulus"])
def test_a_bond_has_the_harmonic_mean_stiffness_of_its_ends(
    small_model: ModelMaker, material: MaterialMaker, follow: Follow, field: str
) -> None:
    """A checkerboard of two materials, in which every bond connects both, moves like their mean."""
    low, high = {"poisson_ratio": (0.1, 0.4), "youngs_modulus": (4e6, 9e6)}[field]
    body = 1 + np.indices((4, 3, 3)).sum(axis=0) % 2
    phase = np.random.default_rng(4).uniform(-1, 1, body.shape)

    def motion(of_1: float, of_2: float) -> NDArray[np.float64]:
        ends = {i: material(expansion=0.01, **{field: x}) for i, x in ((1, of_1), (2, of_2))}
        model = small_model((4, 3, 3), palette=ends, slow_damping=0.0, duration=1.0)
        return follow(model, body, phase, range(61), ["voxels"])["voxels"]

    mixed = motion(low, high)
    mean, other = harmonic(low, high), (low + high) / 2
    assert np.abs(mixed - motion(mean, mean)).max() < 1e-12
    assert np.abs(mixed - motion(other, other)).max() > 1e-7


# ---- actuation


@pytest.mark.parametrize(
    "changes",
    [
        {"start_time": 0.1},  # not a multiple of the period: phases are absolute, so sizes jump
        {"start_time": 0.25},
        {"ramp": 0.2},
        {"ramp": 10.0},
        {"start_time": 0.08, "ramp": 0.1},
        {"start_time": 0.08, "ramp": 1e-9},
    ],
)
def test_the_actuation_starts_and_grows(
    small_model: ModelMaker, material: MaterialMaker, changes: dict[str, Any]
) -> None:
    ends = (material(expansion=0.01), material(expansion=-0.015, density=2e6))
    assert deviation(small_model, ends, (0.13, 0.4), **changes) < 1e-14


@pytest.mark.parametrize("amplitude", [1.5, 5.0])
def test_sizes_stay_within_the_limits(
    small_model: ModelMaker, material: MaterialMaker, amplitude: float
) -> None:
    ends = (material(expansion=amplitude / AMPLITUDE), material(expansion=-amplitude / AMPLITUDE))
    settings = small_model((2, 1, 1)).settings
    sizes = [L]
    for n in range(100):
        sizes.append(size_at(n * 3.2e-3, 0.2, sizes[-1], ends[0], settings))
    assert min(sizes) >= 0.1 * L
    assert max(sizes) <= 3.0 * L
    assert len(set(sizes)) < 100
    assert deviation(small_model, ends, (0.2, 0.4)) < 1e-12


def test_an_overstretched_bond_changes_its_frame(small_model: ModelMaker, material: MaterialMaker) -> None:
    ends = (material(expansion=0.06), material(density=1e7))
    model = small_model((2, 1, 1), palette={1: ends[0], 2: ends[1]}, slow_damping=0.0, bond_damping=0.2)
    pair = Pair(ends, (0.25, 0.0), model.settings)
    pair.follow(100)
    assert pair.switches > 1
    assert deviation(small_model, ends, (0.25, 0.0), slow_damping=0.0, bond_damping=0.2) < 1e-13


# ---- oscillation


def frequency(track: NDArray[np.float64], dt: float) -> float:
    """Return the angular frequency of samples x of a sine: x[n+1] + x[n-1] = 2 cos(w dt) x[n], rad/s."""
    x = track - (track.max() + track.min()) / 2
    for _ in range(3):  # the mean of both extremes is only approximately the center
        c = float(x[1:-1] @ (x[2:] + x[:-2])) / float(2 * x[1:-1] @ x[1:-1])
        x = x - float(np.mean(x[2:] + x[:-2] - 2 * c * x[1:-1])) / (2 - 2 * c)
    return math.acos(c) / dt


@pytest.mark.parametrize(
    ("densities", "held", "reduced"),
    [((1e6, 1e6), (0, 0), 0.5), ((1e6, 1e6), (FIX_ALL, 0), 1.0), ((3e6, 1e6), (0, 0), 0.75)],
    ids=["free", "one end clamped", "unequal masses"],
)
@pytest.mark.parametrize("axis", [0, 1, 2])
def test_two_voxels_oscillate_with_their_natural_period(
    small_model: ModelMaker,
    material: MaterialMaker,
    follow: Follow,
    densities: tuple[float, float],
    held: tuple[int, int],
    reduced: float,
    axis: int,
) -> None:
    """For semi-implicit Euler, cos(w dt) = 1 - (w0 dt)^2 / 2, with w0^2 = stiffness / reduced mass."""
    ends = {i + 1: material(density=rho, expansion=1e-4) for i, rho in enumerate(densities)}
    canvas = tuple(np.roll((2, 1, 1), axis).tolist())
    options = {"period": 1e9, "bond_damping": 0.0, "slow_damping": 0.0, "duration": 4.0}
    model = small_model(canvas, palette=ends, fixed=held, **options)
    body = np.reshape([1, 2], canvas)
    voxels = follow(model, body, 0.25, tracks=["voxels"])["voxels"].reshape(-1, 2, 3)[..., axis]
    dt = float(model.time_steps(body[None].astype(np.uint8))[0][0])
    distance = voxels[1:, 1] - voxels[1:, 0]
    own = math.sqrt(5e6 * L / (reduced * 1e6 * L**3))
    assert np.ptp(distance) == pytest.approx(2e-4 * AMPLITUDE * L / math.cos(own * dt / 2), rel=1e-2)
    assert frequency(distance, dt) == pytest.approx(math.acos(1 - (own * dt) ** 2 / 2) / dt, rel=1e-9)
    crossings = np.flatnonzero(np.diff(np.signbit(distance - distance.mean())))
    periods = 2 * (crossings[-1] - crossings[0]) / (len(crossings) - 1)
    assert periods * dt == pytest.approx(2 * math.pi / own, rel=1e-2)


def test_a_hanging_voxel_oscillates_about_its_equilibrium(small_model: ModelMaker, follow: Follow) -> None:
    """Below a clamped voxel, it oscillates between its start and twice the sag m g / (E L)."""
    options = {"bond_damping": 0.0, "slow_damping": 0.0, "duration": 3.0, "gravity": -0.2}
    model = small_model((1, 1, 2), fixed=[0, FIX_ALL], **options)
    z = follow(model, tracks=["voxels"])["voxels"][:, 0, 0, 0, 2]
    sag = 125.0 * 0.2 / (5e6 * L)
    assert z.min() == pytest.approx(L / 2 - 2 * sag, abs=2e-2 * sag)
    assert z.max() == pytest.approx(L / 2, abs=2e-2 * sag)
    assert (z.max() + z.min()) / 2 == pytest.approx(L / 2 - sag, abs=2e-2 * sag)


def test_the_sag_of_a_damped_chain_follows_from_its_weight(small_model: ModelMaker, follow: Follow) -> None:
    """Each bond carries the n voxels below it: n m g / (E L)."""
    n = 6
    held = [0] * (n - 1) + [FIX_ALL]
    model = small_model((1, 1, n), fixed=held, gravity=-0.2, slow_damping=0.03, duration=20.0)
    tracks = follow(model)
    settled = tracks["voxels"][-1, 0, 0, :, 2]
    rest = float(np.float32(L))
    loads = np.arange(1, n) * 125.0 * 0.2 / (5e6 * L)
    assert np.diff(settled) == pytest.approx(rest + loads, rel=1e-12)
    assert tracks["strain"][-1] == pytest.approx([loads[0] / L, loads[-1] / L], rel=1e-10)
    assert tracks["energy"][-1, 0] == pytest.approx(0.5 * 5e6 * L * (loads**2).sum(), rel=1e-10)
    assert tracks["energy"][-1, 1] < 1e-20
