import numpy as np
import pytest
from cppns import LIMIT, NEAT, PAPER, Gene
from hypothesis import given, strategies as st
from numpy.typing import NDArray

from evoframe_libcppn import ACTIVATIONS, CppnNetwork

# Table of the paper that evoframe reproduces.
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

EDGES = [0.0, 5e-324, -5e-324, 1e-300, 1.0, -1.0, 3.4, -3.4, 12.0, 24.0, 60.0, -60.0, 745.2, -745.2, 1e50]


def values(name: str, z: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the values of an activation from a network with a single node."""
    return CppnNetwork(1, 1, {0: Gene(name)}, [(-1, 0, 1.0)])(z[:, None])[:, 0]


def dense() -> NDArray[np.float64]:
    rng = np.random.default_rng(0)
    signs = rng.choice([-1.0, 1.0], 5_000)
    spread = signs * 10.0 ** rng.uniform(-330, 60, 5_000)
    return np.concatenate([EDGES, rng.normal(size=5_000), rng.uniform(-80, 80, 5_000), spread])


def test_activations_are_the_23_of_the_paper() -> None:
    assert list(ACTIVATIONS) == NAMES == list(PAPER)
    assert len(ACTIVATIONS) == 23


@pytest.mark.parametrize("name", NAMES)
def test_each_equals_neat_python_bit_for_bit(name: str) -> None:
    z = dense()
    assert values(name, z).tolist() == [NEAT[name](number) for number in z.tolist()]


@pytest.mark.parametrize("name", NAMES)
@given(z=st.floats())
def test_each_equals_its_formula_bit_for_bit(name: str, z: float) -> None:
    value = values(name, np.array([z]))
    expected = PAPER[name](0.0 + z)  # a sum starts with 0.0, so that -0.0 becomes 0.0
    assert value.tobytes() == np.float64(expected).tobytes()
    assert np.isfinite(value).all()
    assert np.abs(value).max() <= LIMIT


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
        ("identity", np.nan, 0.0),
        ("identity", -np.inf, -LIMIT),
        ("identity", 1e51, LIMIT),
    ],
)
def test_formulas_of_the_papers_table(name: str, z: float, value: float) -> None:
    assert values(name, np.array([z]))[0] == value
