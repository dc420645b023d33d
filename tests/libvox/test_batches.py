"""Results of a body do not depend on other bodies, threads, samples or tracks."""

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
from numpy.typing import NDArray

from evoframe_libvox import FIX_ALL, Model, Result

ModelMaker = Callable[..., Model]
Bodies = tuple[NDArray[np.uint8], NDArray[np.float64]]
CANVAS = (4, 3, 3)


@pytest.fixture(scope="module")
def bodies() -> Bodies:
    rng = np.random.default_rng(1)
    material = rng.choice(np.array([0, 1, 3], np.uint8), size=(12, *CANVAS))
    material[:, 0, 0, 0] = 1
    return material, rng.uniform(-1.0, 1.0, material.shape)


@pytest.fixture
def model(small_model: ModelMaker) -> Model:
    fixed = np.zeros(CANVAS, np.uint8)
    fixed[0] = FIX_ALL
    return small_model(CANVAS, fixed=fixed)


def same(a: Result, b: Result) -> bool:
    """Return whether two results are equal, bit for bit."""
    tracks = a.tracks.keys() == b.tracks.keys() and all(
        np.array_equal(a.tracks[name], b.tracks[name], equal_nan=True) for name in a.tracks
    )
    ends = np.array_equal(a.diverged_step, b.diverged_step) and np.array_equal(a.repeated, b.repeated)
    return tracks and ends


def part(result: Result, bodies: slice) -> Result:
    tracks = {name: track[bodies] for name, track in result.tracks.items()}
    return Result(tracks, result.diverged_step[bodies], result.repeated[bodies])


def test_a_batch_equals_its_members(model: Model, bodies: Bodies) -> None:
    material, phase = bodies
    batch = model.simulate(material, phase, range(20))
    for i in range(len(material)):
        one = slice(i, i + 1)
        assert same(part(batch, one), model.simulate(material[one], phase[one], range(20)))


def test_threads_get_the_same_results(model: Model, bodies: Bodies) -> None:
    material, phase = bodies
    alone = model.simulate(material, phase, range(20))
    with ThreadPoolExecutor(8) as pool:
        jobs = [pool.submit(model.simulate, material, phase, range(20)) for _ in range(40)]
        assert all(same(alone, job.result()) for job in jobs)


def test_sampling_more_changes_nothing(model: Model, bodies: Bodies) -> None:
    every = model.simulate(*bodies, range(20))
    few = model.simulate(*bodies, [3, 17], ["face"])
    assert few.tracks.keys() == {"face"}
    assert np.array_equal(few.tracks["face"], every.tracks["face"][:, [3, 17]])
    assert model.simulate(*bodies, [], []).tracks == {}


def test_each_body_may_have_its_own_samples(model: Model, bodies: Bodies) -> None:
    every = model.simulate(*bodies, range(20))
    rng = np.random.default_rng(3)
    steps = np.array([np.sort(rng.choice(20, 5, replace=False)) for _ in range(len(bodies[0]))])
    own = model.simulate(*bodies, steps)
    for name, track in own.tracks.items():
        expected = np.stack([all_of[at] for all_of, at in zip(every.tracks[name], steps, strict=True)])
        assert np.array_equal(track, expected, equal_nan=True)
    assert np.array_equal(own.diverged_step, every.diverged_step)


def test_the_order_of_a_batch_does_not_matter(model: Model, bodies: Bodies) -> None:
    order = np.random.default_rng(4).permutation(len(bodies[0]))
    plain = model.simulate(*bodies, range(20))
    shuffled = model.simulate(bodies[0][order], bodies[1][order], range(20))
    expected = {name: track[order] for name, track in plain.tracks.items()}
    assert same(shuffled, Result(expected, plain.diverged_step[order], plain.repeated[order]))


def test_phases_of_cells_that_do_not_expand_do_not_matter(model: Model, bodies: Bodies) -> None:
    material, phase = bodies
    other = np.where(material == 3, phase, np.nan)
    assert same(model.simulate(material, phase, range(20)), model.simulate(material, other, range(20)))


def test_sample_0_is_the_initial_state(model: Model, bodies: Bodies) -> None:
    material, phase = bodies
    start = model.simulate(material, phase, [0]).tracks["voxels"][:, 0]
    lattice = 0.05 * (np.moveaxis(np.indices(CANVAS), 0, -1) + 0.5)
    assert np.allclose(start[material > 0], np.broadcast_to(lattice, start.shape)[material > 0], rtol=1e-15)
    assert np.isnan(start[material == 0]).all()


def test_tracks_agree_with_their_definitions(model: Model, small_model: ModelMaker) -> None:
    material = np.zeros((1, *CANVAS), np.uint8)
    material[0, :3, 1, 1] = (1, 3, 1)
    material[0, 2, 0, 2] = 3  # the last in cell order, and one of two at the largest x
    tracks = model.simulate(material, np.zeros(material.shape), [0, 9]).tracks
    voxels = tracks["voxels"][0]
    assert np.array_equal(tracks["tip"][0], voxels[:, 2, 0, 2])
    assert np.allclose(tracks["face"][0], (voxels[:, 2, 1, 1] + voxels[:, 2, 0, 2]) / 2, rtol=1e-14)
    assert np.allclose(tracks["body"][0], np.nanmean(voxels, axis=(1, 2, 3)), rtol=1e-14)


def test_means_are_weighted_with_mass(small_model: ModelMaker, material: Callable[..., object]) -> None:
    model = small_model((1, 1, 3), palette={1: material(), 2: material(density=3e6)})
    start = model.simulate(np.array([[[[1, 2, 0]]]], np.uint8), np.zeros((1, 1, 1, 3)), [0]).tracks
    assert start["body"][0, 0, 2] == pytest.approx((0.025 + 3 * 0.075) / 4)
    assert start["face"][0, 0, 2] == start["body"][0, 0, 2]


def test_an_empty_batch_is_allowed(model: Model) -> None:
    nothing = np.zeros((0, *CANVAS))
    result = model.simulate(nothing.astype(np.uint8), nothing, [0, 1])
    assert result.tracks["voxels"].shape == (0, 2, *CANVAS, 3)
    assert result.diverged_step.shape == result.repeated.shape == (0,)


def test_divergence_is_reported_and_does_not_affect_others(
    small_model: ModelMaker, material: Callable[..., object], palette: dict[int, object]
) -> None:
    # Slow damping depends on a voxel's own stiffness, the time step on its bonds, limited by soft neighbors.
    model = small_model((4, 1, 1), palette=palette | {7: material(youngs_modulus=5e14)})
    sane = np.array([1, 3, 0, 0], np.uint8).reshape(1, 4, 1, 1)
    wild = np.array([3, 7, 1, 0], np.uint8).reshape(1, 4, 1, 1)
    batch = np.concatenate([sane, wild, sane])
    phase = np.full(batch.shape, 0.1)
    steps = int(model.time_steps(batch)[1].min())
    result = model.simulate(batch, phase, range(steps + 1))
    at = result.diverged_step[1]
    assert result.diverged_step[[0, 2]].tolist() == [0, 0]
    assert 0 < at <= steps
    for name, track in result.tracks.items():
        occupied = track[1][:, wild[0] > 0] if name == "voxels" else track[1]
        assert np.isfinite(occupied[:at]).all()
        assert np.isnan(occupied[at:]).all()
    alone = model.simulate(sane, phase[:1], range(steps + 1))
    assert same(part(result, slice(0, 1)), alone)
    assert same(part(result, slice(2, 3)), alone)


def test_a_voxel_that_moves_too_far_has_diverged(small_model: ModelMaker) -> None:
    # Two voxels without a bond and damping, diagonal and thus within reach of each other.
    model = small_model((2, 2, 1), duration=100.0, slow_damping=0.0)
    material = np.array([[1, 0], [0, 1]], np.uint8).reshape(1, 2, 2, 1)
    steps = int(model.time_steps(material)[1][0])
    result = model.simulate(material, np.zeros(material.shape), [0, 1, steps], ["tip", "body"])
    at = int(result.diverged_step[0])
    assert 0 < at < steps
    last = model.simulate(material, np.zeros(material.shape), [at - 1], ["tip"]).tracks["tip"][0, 0]
    way = np.linalg.norm(last - [0.075, 0.075, 0.025])
    assert way == pytest.approx(100 * 2 * 0.05, rel=1e-3)
    assert way <= 100 * 2 * 0.05
