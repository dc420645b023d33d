"""The list of contact candidates: complete with ``complete_contacts``, compared with all pairs in every step.

Bodies whose voxels share only edges and corners have no bonds. Only contacts, weight and the floor act on
them, so that their equations are short.
"""

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from hypothesis import given, strategies as st
from hypothesis.extra import numpy as arrays
from numpy.typing import NDArray

from evoframe_libvox import Material, Model

ModelMaker = Callable[..., Model]
Follow = Callable[..., dict[str, NDArray[np.float64]]]
Floats = NDArray[np.float64]
L = 0.05
STEPS = 40
PALETTE = {
    1: Material(5e6, 0.35, 1e6, 0.02, 0.0, 0.3),
    2: Material(5e6, 0.35, 1e6, -0.02, 0.0, 0.1),
    3: Material(2e7, 0.35, 4e6, 0.01, 0.0, 0.0),
    4: Material(5e6, 0.35, 1e6, 0.0),
}


class Particles:
    """Voxels without bonds, with a check of every pair in every step."""

    def __init__(self, model: Model, body: NDArray[np.uint8], phase: Floats) -> None:
        self.s = model.settings
        cells = np.argwhere(body.transpose(2, 1, 0))[:, ::-1]
        self.of = [PALETTE[code] for code in body[tuple(cells.T)]]
        self.phase = phase[tuple(cells.T)].astype(np.float32).astype(float)
        self.at = L * (cells + 0.5)
        self.mass = np.array([m.density * L**3 for m in self.of])
        self.modulus = np.array([m.youngs_modulus for m in self.of])
        self.speed, self.rate = np.zeros_like(self.at), np.zeros_like(self.at)
        self.size, self.time = np.full(len(cells), L), 0.0
        self.friction = np.array([m.dynamic_friction for m in self.of])
        self.drag = 2 * np.sqrt(self.mass * self.modulus * L)
        self.dt = 0.9 / (2 * 3.1415926 * math.sqrt((self.modulus / self.mass).max()))

    def contacts(self) -> tuple[Floats, Floats]:
        """Return the sums of contact forces and torques for each voxel."""
        i, j = np.triu_indices(len(self.at), 1)
        apart = self.at[j] - self.at[i]
        distance = np.linalg.norm(apart, axis=1)
        overlap = self.s.collision_envelope * (self.size[i] + self.size[j]) / 2 - distance
        i, j, apart, distance, overlap = (a[overlap > 0.0] for a in (i, j, apart, distance, overlap))
        towards, lever = apart / distance[:, None], apart / 2
        stiffness = 2 * L / (1 / self.modulus[i] + 1 / self.modulus[j])
        lightness = 1 / self.mass[i] + 1 / self.mass[j]
        passing = self.speed[j] - self.speed[i] - np.cross(self.rate[i] + self.rate[j], lever)
        parting = (passing * towards).sum(axis=1)
        count = np.bincount(np.concatenate([i, j]), minlength=len(self.at))
        sharing = self.dt * np.maximum(
            count[i], count[j]
        )  # all contacts together at most stop the motion in a step
        damper = np.minimum(
            self.s.contact_damping * 2 * np.sqrt(stiffness / lightness), 1 / (sharing * lightness)
        )
        push = np.maximum(0.0, stiffness * overlap - damper * parting)
        force = push[:, None] * towards
        if self.s.contact_friction:
            sliding = passing - parting[:, None] * towards
            slide = np.linalg.norm(sliding, axis=1)
            stops = slide / (sharing * lightness * (1 + 6 * (distance / 2 / L) ** 2))
            brake = np.minimum((self.friction[i] + self.friction[j]) / 2 * push, stops)
            force -= (brake / np.where(slide > 0.0, slide, 1.0))[:, None] * sliding
        total, torque = np.zeros_like(self.at), np.zeros_like(self.at)
        np.add.at(total, j, force)
        np.subtract.at(total, i, force)
        for end in (i, j):
            np.subtract.at(torque, end, np.cross(lever, force))
        return total, torque

    def floor(self, force: Floats) -> Floats:
        """Return the force of the floor; lateral speeds of sticking voxels are set to zero."""
        deep = np.maximum(0.0, self.size / 2 - self.at[:, 2])
        push = 2 * self.modulus * L * deep
        added = np.zeros_like(force)
        added[:, 2] = np.where(deep > 0.0, push - self.s.floor_damping * self.drag * self.speed[:, 2], 0.0)
        slide = np.linalg.norm(self.speed[:, :2], axis=1)
        stops = (deep > 0.0) & (slide > 0.0) & (self.friction * push * self.dt >= self.mass * slide)
        slides = (deep > 0.0) & (slide > 0.0) & ~stops
        brake = self.friction * push / np.where(slide > 0.0, slide, 1.0)
        added[slides, :2] = -(brake[:, None] * self.speed[:, :2])[slides]
        added[stops, :2] = -force[stops, :2]
        self.speed[stops, :2] = 0.0
        return added

    def loads(self) -> tuple[Floats, Floats]:
        force, torque = self.contacts()
        force -= (self.s.slow_damping * self.drag)[:, None] * self.speed
        force[:, 2] += self.mass * self.s.gravity
        return force + self.floor(force) if self.s.floor else force, torque

    def step(self) -> None:
        force, torque = self.loads()
        self.speed += self.dt * force / self.mass[:, None]
        self.at += self.dt * self.speed
        inertia = self.mass * L**2 / 6
        keep = 1 - self.dt * 10 * self.s.slow_damping * 2 * np.sqrt(inertia * self.modulus * L**3) / inertia
        self.rate = (self.rate + self.dt * torque / inertia[:, None]) * keep[:, None]
        strain = np.array([m.expansion for m in self.of]) * self.s.temperature_amplitude
        cycles = self.time / self.s.period + self.phase
        self.size = L * (float(np.float32(L)) / L + strain * np.sin(6.283185005187988 * cycles))
        self.time += self.dt

    def follow(self, steps: int) -> Floats:
        """Return the positions at the start and after each step, ``[step, voxel, xyz]``, m."""
        rows = [self.at.copy()]
        for _ in range(steps):
            self.step()
            rows.append(self.at.copy())
        return np.array(rows)


def off(model: Model, follow: Follow, body: NDArray[np.uint8], phase: Floats, steps: int = STEPS) -> float:
    """Return the difference between solver and particles, lattice edges."""
    voxels = follow(model, body, phase, range(steps + 1), ["voxels"])["voxels"]
    order = voxels.transpose(0, 3, 2, 1, 4)[:, body.transpose(2, 1, 0) > 0]
    return float(np.abs(order - Particles(model, body, phase).follow(steps)).max() / L)


@st.composite
def loose_bodies(draw: st.DrawFn) -> tuple[NDArray[np.uint8], Floats]:
    """Draw voxels without common faces, and their phases."""
    canvas = draw(st.tuples(*(st.integers(1, 3),) * 3))
    odd = np.indices(canvas).sum(axis=0) % 2
    body = draw(arrays.arrays(np.uint8, canvas, elements=st.integers(0, 3))) * (odd == 0)
    body[0, 0, 0] = 1
    cycles = st.integers(-32, 32).map(lambda n: n / 32)
    return body.astype(np.uint8), draw(arrays.arrays(np.float64, canvas, elements=cycles))


surroundings = st.fixed_dictionaries(
    {
        "collision_envelope": st.sampled_from([1.0, 1.3, 1.5, 2.0]),
        "collision_horizon": st.sampled_from([1.0, 1.3, 2.0, 4.0]),
        "collision_list_factor": st.sampled_from([1.0, 2.0]),
        "contact_damping": st.sampled_from([0.0, 0.0, 0.3, 10.0]),
        "contact_friction": st.booleans(),
        "gravity": st.sampled_from([0.0, -9.81, -100.0]),
        "floor": st.booleans(),
        "slow_damping": st.sampled_from([0.0, 0.01]),
        "period": st.sampled_from([0.05, 0.25]),
    }
)


@given(body=loose_bodies(), options=surroundings)
def test_a_complete_list_contains_all_contacts(
    small_model: ModelMaker, follow: Follow, body: tuple[NDArray[np.uint8], Floats], options: dict[str, Any]
) -> None:
    model = small_model(body[0].shape, palette=PALETTE, complete_contacts=True, **options)
    assert off(model, follow, *body) < 1e-10


@pytest.mark.parametrize("horizon", [1.0, 2.0, 4.0])
@pytest.mark.parametrize("gap", [3, 4, 5, 6])
def test_a_complete_list_allows_for_motion_of_both_voxels(
    small_model: ModelMaker, follow: Follow, horizon: float, gap: int
) -> None:
    """Two voxels that start too close to others fly towards each other from both ends of the canvas."""
    body = np.zeros((gap + 3, 2, 1), np.uint8)
    body[[0, 1, gap + 1, gap + 2], [0, 1, 1, 0], 0] = 4
    alone = {4: PALETTE[4]}  # no other material that grows and lengthens the list
    options = {"collision_envelope": 2.0, "collision_horizon": horizon, "slow_damping": 0.0, "duration": 0.3}
    model = small_model(body.shape, palette=alone, complete_contacts=True, **options)
    steps = int(model.time_steps(body[None])[1][0])
    assert off(model, follow, body, np.zeros(body.shape), steps) < 1e-9
    places = follow(model, body, tracks=["voxels"])["voxels"]
    between = places[:, gap + 1, 1, 0, 0] - places[:, 1, 1, 0, 0]
    assert between.min() < 2 * L
    assert between[-1] > between.min()


# ---- the engine's list


@pytest.mark.parametrize(
    "options",
    [
        pytest.param({"collision_horizon": 1.0}, id="its reach is shorter than the envelope"),
        pytest.param(
            {"collision_horizon": 1.9, "collision_envelope": 2.0, "gravity": -100.0}, id="it is late"
        ),
    ],
)
def test_the_engines_list_may_miss_contacts(
    small_model: ModelMaker, follow: Follow, options: dict[str, Any]
) -> None:
    rng = np.random.default_rng(8)
    body = (rng.integers(1, 4, (3, 3, 3)) * (np.indices((3, 3, 3)).sum(axis=0) % 2)).astype(np.uint8)
    phase = rng.uniform(-1.0, 1.0, body.shape)
    complete = small_model(body.shape, palette=PALETTE, complete_contacts=True, **options)
    published = small_model(body.shape, palette=PALETTE, **options)
    assert off(complete, follow, body, phase) < 1e-10
    assert off(published, follow, body, phase) > 1e-4


def test_the_engines_list_depends_on_the_size_of_the_first_voxel(
    small_model: ModelMaker, follow: Follow
) -> None:
    """Of two falling voxels, so that the list is rebuilt, one has shrunk and the other has grown into it."""
    body = np.diag([2, 1]).astype(np.uint8)[..., None]
    options = {"palette": PALETTE, "period": 0.1, "temperature_amplitude": 25.0, "gravity": -100.0}
    lists = {}
    for order, cells in (("shrunk first", body), ("grown first", body[::-1, ::-1])):
        model = small_model((2, 2, 1), **options, collision_envelope=1.42)
        lists[order] = off(model, follow, np.ascontiguousarray(cells), np.zeros((2, 2, 1)))
    assert lists["grown first"] < 1e-10
    assert lists["shrunk first"] > 1e-6


def test_voxels_within_a_few_bonds_never_collide(small_model: ModelMaker, follow: Follow) -> None:
    """With any list, four voxels within three bonds of each other have no contacts."""
    model = small_model((2, 2, 1), complete_contacts=True, collision_envelope=2.0)
    voxels = follow(model, [[1, 1], [1, 0]], tracks=["voxels"])["voxels"]
    free = small_model((2, 2, 1), self_collision=False)
    assert np.array_equal(voxels, follow(free, [[1, 1], [1, 0]])["voxels"], equal_nan=True)
