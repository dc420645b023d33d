from collections.abc import Callable, Mapping

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from evoframe_evolvers.activations import ACTIVATIONS, LIMIT, guard

Functions = Mapping[str, Callable[[float], float]]

# The table of the paper that evoframe reproduces.
NAMES = [
    "sigmoid",
    "tanh",
    "sin",
    "softplus",
    "gauss",
    "relu",
    "elu",
    "lelu",
    "selu",
    "identity",
    "clamped",
    "inv",
    "log",
    "exp",
    "abs",
    "hat",
    "square",
    "cube",
    "neg_abs",
    "neg_square",
    "sqrt_abs",
    "neg_sqrt_abs",
    "neg_sin",
]

EDGES = [0.0, -0.0, 5e-324, -5e-324, 1e-300, 1.0, -1.0, 3.4, -3.4, 12.0, 24.0, 60.0, -60.0, 745.2, -745.2]


def dense() -> NDArray[np.float64]:
    rng = np.random.default_rng(0)
    signs = rng.choice([-1.0, 1.0], 20_000)
    return np.concatenate(
        [
            EDGES,
            [LIMIT, -LIMIT],
            rng.normal(size=20_000),
            rng.uniform(-80, 80, 20_000),
            signs * 10.0 ** rng.uniform(-50, 50, 20_000),
        ]
    )


def ulps(ours: NDArray[np.float64], theirs: NDArray[np.float64]) -> float:
    return float((np.abs(ours - theirs) / np.spacing(np.abs(theirs))).max())


def test_there_are_the_papers_23() -> None:
    assert list(ACTIVATIONS) == NAMES
    assert len(ACTIVATIONS) == 23


@pytest.mark.parametrize("name", NAMES)
def test_each_is_neat_pythons_within_4_ulp(name: str, neat_activations: Functions) -> None:
    z = dense()
    theirs = np.array([neat_activations[name](value) for value in z.tolist()])
    assert ulps(ACTIVATIONS[name](z), theirs) <= 4


@pytest.mark.parametrize("name", NAMES)
@given(z=st.floats(-LIMIT, LIMIT))
def test_each_is_neat_pythons_bit_for_bit(name: str, z: float, neat_activations: Functions) -> None:
    assert ACTIVATIONS[name](np.array([z]))[0] == neat_activations[name](z)


@pytest.mark.parametrize("name", NAMES)
@given(z=st.lists(st.floats(), max_size=8))
def test_each_is_finite_whatever_comes_in(name: str, z: list[float]) -> None:
    values = ACTIVATIONS[name](np.array(z, dtype=np.float64))
    assert values.shape == (len(z),)
    assert np.isfinite(values).all()
    assert (np.abs(values) <= LIMIT).all()


@pytest.mark.parametrize("name", NAMES)
def test_a_point_does_not_depend_on_the_others(name: str) -> None:
    z = dense()[::50]
    together = ACTIVATIONS[name](z)
    apart = np.concatenate([ACTIVATIONS[name](z[i : i + 1]) for i in range(len(z))])
    assert together.tobytes() == apart.tobytes()
    assert ACTIVATIONS[name](z.reshape(-1, 1)).tobytes() == together.tobytes()


@pytest.mark.parametrize(
    ("name", "z", "value"),
    [
        ("sqrt_abs", -4.0, 2.0),
        ("neg_sqrt_abs", -4.0, -2.0),
        ("neg_square", 3.0, -9.0),
        ("neg_abs", -3.0, -3.0),
        ("neg_sin", 1.0, -0.8414709848078965),  # not scaled by 5
        ("sin", 1.0, -0.9589242746631385),
        ("inv", 0.0, 0.0),
        ("inv", 5e-324, LIMIT),
        ("cube", -1e50, -LIMIT),
        ("log", -1.0, -16.11809565095832),
        ("hat", 0.25, 0.75),
    ],
)
def test_formulas_of_the_papers_table(name: str, z: float, value: float) -> None:
    assert ACTIVATIONS[name](np.array([z]))[0] == value


def test_the_guard_clamps_and_replaces_nan() -> None:
    guarded = guard(np.array([np.nan, np.inf, -np.inf, 1e51, 2.0]))
    assert guarded.tolist() == [0.0, LIMIT, -LIMIT, LIMIT, 2.0]
