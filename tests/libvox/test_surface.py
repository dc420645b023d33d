"""The surface of the paper's engine in a fluid, against the law of docs/physics.md, section 7, in Python."""

from collections.abc import Callable, Iterator
from itertools import product
from typing import Any

import numpy as np
from hypothesis import HealthCheck, assume, given, settings, strategies as st
from hypothesis.extra import numpy as arrays
from numpy.typing import NDArray

from evoframe_libvox import Material, Model

Vectors = NDArray[np.float64]
ModelMaker = Callable[..., Model]
MaterialMaker = Callable[..., Material]
Follow = Callable[..., dict[str, NDArray[np.float64]]]
L, G, DRAG = 0.05, -9.81, 3e4
RHO0 = float(np.float32(L)) / L
NO_ROTATION = 56
MODULI = {1: 2e5, 2: 8e5}
CANVAS = (3, 2, 2)
Cell = tuple[int, int, int]


def beside(cell: Cell, axis: int, way: int) -> Cell:
    x, y, z = (c + way * (a == axis) for a, c in enumerate(cell))
    return x, y, z


def reaches(body: NDArray[np.uint8], positions: Vectors, step: int) -> Iterator[tuple[Cell, Vectors]]:
    """Yield the reach of each voxel below and above along each axis, ``[axis, side]``, from its bonds."""
    rest = L * (RHO0 if step else 1.0)  # sizes lag by one step
    for cell in map(tuple, np.argwhere(body)):
        reach = np.full((3, 2), L / 2)
        for axis, side in product(range(3), range(2)):
            other = beside(cell, axis, 2 * side - 1)
            if not all(0 <= c < n for c, n in zip(other, body.shape, strict=True)) or not body[other]:
                continue
            apart = np.delete(np.abs(positions[other] - positions[cell]), axis).sum()
            along = abs(positions[other][axis] - positions[cell][axis])
            assume(apart / along < 0.05)  # the small frame
            own, far = MODULI[body[cell]], MODULI[body[other]]
            reach[axis, side] += 2 * far / (own + far) * (along - rest) / 2
        yield cell, reach


def corners(body: NDArray[np.uint8], positions: Vectors, reach: dict[Cell, Vectors]) -> dict[Cell, Vectors]:
    """Return the corners of the surface by lattice point: means over all voxels around it."""
    around: dict[Cell, list[Vectors]] = {}
    for cell, own in reach.items():
        for sides in product(range(2), repeat=3):
            offset = [(2 * side - 1) * own[axis, side] for axis, side in enumerate(sides)]
            point: Any = tuple(c + side for c, side in zip(cell, sides, strict=True))
            around.setdefault(point, []).append(positions[cell] + offset)
    return {point: np.mean(those, axis=0) for point, those in around.items()}


def drag_on(body: NDArray[np.uint8], cell: Cell, velocity: Vectors, points: dict[Cell, Vectors]) -> Vectors:
    """Return the force on a voxel, N."""
    force = np.zeros(3)
    for axis, side in product(range(3), range(2)):
        other = beside(cell, axis, 2 * side - 1)
        if all(0 <= c < n for c, n in zip(other, body.shape, strict=True)) and body[other]:
            continue
        first, second = (axis + 1) % 3, (axis + 2) % 3
        start: Any = np.array(cell) + side * np.eye(3, dtype=int)[axis]
        steps = [0 * start, np.eye(3, dtype=int)[first], np.eye(3, dtype=int)[second]]
        quad = [points[tuple(start + step)] for step in (steps[0], steps[1], steps[1] + steps[2], steps[2])]
        for a, b, c in ((0, 1, 2), (0, 2, 3)):
            normal = (2 * side - 1) * np.cross(quad[b] - quad[a], quad[c] - quad[a])
            area = float(np.linalg.norm(normal)) / 2
            against = float(velocity @ normal) / (2 * area)
            if against > 0:
                force -= DRAG * area * against**2 * normal / (2 * area)
    return force


@given(
    body=arrays.arrays(np.uint8, CANVAS, elements=st.sampled_from([0, 1, 2, 2])),
)
@settings(suppress_health_check=[HealthCheck.function_scoped_fixture], max_examples=30)
def test_the_total_momentum_changes_by_weight_and_drag(
    small_model: ModelMaker, material: MaterialMaker, follow: Follow, body: NDArray[np.uint8]
) -> None:
    """Of soft voxels of two stiffnesses that do not turn; bonds and their dampers cancel."""
    body[0, 0, 0] = 1
    palette = {code: material(youngs_modulus=modulus) for code, modulus in MODULI.items()}
    model = small_model(
        CANVAS,
        palette=palette,
        fixed=np.full(CANVAS, NO_ROTATION),
        gravity=G,
        fluid_drag=DRAG,
        slow_damping=0.0,
        bond_damping=0.0,
        self_collision=False,
        duration=0.5,
    )
    track = follow(model, body, tracks=["voxels", "momentum"])
    voxels, momentum = track["voxels"], track["momentum"][:, :3]
    dt, mass = float(model.time_steps(body[None])[0][0]), 1e6 * L**3
    reach = {cell: np.full((3, 2), L / 2) for cell, _ in reaches(body, voxels[0], 0)}
    for n in range(1, 20):
        velocities = (voxels[n] - voxels[n - 1]) / dt
        points = corners(body, voxels[n], reach)
        drag = sum(drag_on(body, cell, velocities[cell], points) for cell in reach)
        weight = np.array([0.0, 0.0, mass * G * len(reach)])
        change = (momentum[n + 1] - momentum[n]) / dt
        assert np.abs(change - weight - drag).max() < 1e-6 * mass * abs(G)
        reach = dict(reaches(body, voxels[n], n))
