"""Length and number of time steps, and effects of shorter ones (docs/physics.md, section 3)."""

import math
from collections.abc import Callable
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from evoframe_libvox import FIX_ALL, Material, Model

ModelMaker = Callable[..., Model]
MaterialMaker = Callable[..., Material]
Follow = Callable[..., dict[str, NDArray[np.float64]]]
L = 0.05
PAIR = np.ones((1, 2, 1, 1), np.uint8)


def engine_time_step(fraction: float, stiffness_per_mass: float) -> float:
    return fraction / (2 * 3.1415926 * math.sqrt(stiffness_per_mass))


def harmonic(a: float, b: float) -> float:
    return 2 * a * b / (a + b)


def test_time_step_follows_the_stiffest_lightest_bond(
    small_model: ModelMaker, material: MaterialMaker
) -> None:
    soft, hard = material(), material(youngs_modulus=5e7, density=2e5)
    model = small_model((3, 1, 1), palette={1: soft, 2: hard}, time_step_fraction=0.7)
    bodies = np.array([[1, 1, 0], [1, 2, 0], [2, 2, 1]], np.uint8).reshape(3, 3, 1, 1)
    light, heavy = 2e5 * L**3, 1e6 * L**3
    bonds = (5e6 * L / heavy, harmonic(5e6, 5e7) * L / light, 5e7 * L / light)
    expected = [engine_time_step(0.7, k) for k in bonds]
    dt, steps = model.time_steps(bodies)
    assert dt == pytest.approx(expected, rel=1e-14)
    assert steps.tolist() == [math.floor(0.1 / h) + 1 for h in expected]


def test_body_without_bonds_lacks_the_edge_in_its_time_step(small_model: ModelMaker) -> None:
    model = small_model((2, 2, 1))
    diagonal = np.array([1, 0, 0, 1], np.uint8).reshape(1, 2, 2, 1)
    assert model.time_steps(diagonal)[0] == pytest.approx(engine_time_step(0.9, 5e6 / 125.0), rel=1e-14)


def test_clamped_neighbors_have_no_bond(small_model: ModelMaker) -> None:
    model = small_model((2, 1, 1), fixed=[FIX_ALL, FIX_ALL])
    assert model.time_steps(PAIR)[0] == pytest.approx(engine_time_step(0.9, 5e6 / 125.0), rel=1e-14)


@pytest.mark.parametrize("held", [0, FIX_ALL - 1, FIX_ALL - 8])
def test_neighbors_that_can_move_have_a_bond(small_model: ModelMaker, held: int) -> None:
    model = small_model((2, 1, 1), fixed=[FIX_ALL, held])
    assert model.time_steps(PAIR)[0] == pytest.approx(engine_time_step(0.9, 5e6 * L / 125.0), rel=1e-14)


# ---- substeps


@pytest.mark.parametrize("substeps", [2, 3, 7, 1000])
def test_substeps_divide_each_step(small_model: ModelMaker, substeps: int) -> None:
    dt, steps = small_model((2, 1, 1)).time_steps(PAIR)
    shorter, more = small_model((2, 1, 1), substeps=substeps).time_steps(PAIR)
    assert shorter[0] == dt[0] / substeps
    assert more[0] == steps[0] * substeps


def test_substeps_converge_to_first_order(small_model: ModelMaker, follow: Follow) -> None:
    """For a bar that bends under its weight, half the step has half the error at a given time."""

    def tip(substeps: int) -> NDArray[np.float64]:
        options: dict[str, Any] = {"gravity": -0.5, "duration": 0.3, "substeps": substeps}
        model = small_model((4, 1, 1), fixed=[FIX_ALL, 0, 0, 0], **options)
        end: NDArray[np.float64] = follow(model, steps=[60 * substeps], tracks=["tip"])["tip"][0]
        return end

    exact = tip(512)
    errors = [float(np.abs(tip(n) - exact).max()) for n in (4, 8, 16, 32)]
    assert errors[0] < 1e-2 * L
    for coarse, fine in pairwise(errors):
        assert 1.8 < coarse / fine < 2.3


# ---- step limit


def test_a_body_may_have_the_maximum_number_of_steps(small_model: ModelMaker) -> None:
    steps = int(small_model((2, 1, 1), substeps=3).time_steps(PAIR)[1][0])
    assert small_model((2, 1, 1), substeps=3, step_limit=steps).time_steps(PAIR)[1][0] == steps
    with pytest.raises(ValueError, match=r"step_limit.* \(body 0\)"):
        small_model((2, 1, 1), substeps=3, step_limit=steps - 1).time_steps(PAIR)


def test_the_step_limit_names_the_body_and_nothing_is_simulated(
    small_model: ModelMaker, material: MaterialMaker
) -> None:
    """A stiff body requires ten times as many steps as the others in its batch."""
    model = small_model((2, 1, 1), palette={1: material(), 2: material(youngs_modulus=5e8)}, step_limit=40)
    batch = np.array([[1, 1], [1, 1], [2, 2], [1, 1]], np.uint8).reshape(4, 2, 1, 1)
    for call in (model.time_steps, lambda bodies: model.simulate(bodies, np.zeros(bodies.shape), [0])):
        with pytest.raises(ValueError, match=r"step_limit.* \(body 2\)"):
            call(batch)
    assert (model.time_steps(batch[:2])[1] < 40).all()


def test_the_default_limit_prevents_endless_simulations(small_model: ModelMaker) -> None:
    with pytest.raises(ValueError, match="step_limit"):
        small_model((2, 1, 1), duration=1e6).time_steps(PAIR)


# ---- steps at times


def test_steps_at_returns_the_first_step_that_reaches_a_time(
    small_model: ModelMaker, material: MaterialMaker
) -> None:
    model = small_model((2, 1, 1), palette={1: material(), 2: material(youngs_modulus=5e7)}, substeps=2)
    bodies = np.array([[1, 1], [2, 2]], np.uint8).reshape(2, 2, 1, 1)
    dt, _ = model.time_steps(bodies)
    times = [0.0, 1e-9, 0.0171, 0.05, 0.1]
    steps = model.steps_at(bodies, times)
    assert steps.dtype == np.int64
    assert (steps * dt[:, None] >= np.array(times) * (1 - 1e-11)).all()
    assert ((steps - 1) * dt[:, None] < times).all()
    assert model.simulate(bodies, np.zeros(bodies.shape), steps).tracks["tip"].shape == (2, 5, 3)


def test_a_multiple_of_the_time_step_is_reached_exactly(small_model: ModelMaker) -> None:
    model = small_model((2, 1, 1), duration=5.0)
    dt, steps = model.time_steps(PAIR)
    wanted = np.arange(steps[0])
    assert model.steps_at(PAIR, wanted * dt[0])[0].tolist() == wanted.tolist()


@pytest.mark.parametrize("time", [-1e-9, 0.1000001, float("nan"), float("inf")])
def test_times_beyond_the_duration(small_model: ModelMaker, time: float) -> None:
    with pytest.raises(ValueError, match=rf"^times .* 0\.1 s, got {time}$"):
        small_model((2, 1, 1)).steps_at(PAIR, [0.0, time])
