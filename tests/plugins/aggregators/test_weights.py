import itertools
import math
from typing import Any, get_args

import numpy as np
import pytest
from hypothesis import given, strategies as st

from evoframe_aggregators.weights import (
    GENERATORS,
    PAPER_WEIGHTS,
    GeneratorName,
    generated_weights,
    require_weights,
)

NAMES = list(GENERATORS)
WITH_PARAMETER = [name for name in NAMES if GENERATORS[name].parameter is not None]
COUNTS = st.integers(1, 30)


def residuals(name: Any, parameter: float | None = None) -> np.ndarray[Any, np.dtype[np.float64]]:
    """Return the differences of generated weights from the paper's table, one for each of its 27 weights."""
    return np.concatenate(
        [np.subtract(generated_weights(name, n, parameter), weights) for n, weights in PAPER_WEIGHTS.items()]
    )


def rms(values: Any) -> float:
    return math.sqrt(np.square(values).mean())


def test_the_table_is_that_of_the_paper() -> None:
    assert dict(PAPER_WEIGHTS) == {
        2: (0.6, 0.4),
        3: (0.5, 0.3, 0.2),
        5: (0.4, 0.3, 0.15, 0.1, 0.05),
        7: (0.35, 0.25, 0.15, 0.12, 0.07, 0.04, 0.02),
        10: (0.3, 0.2, 0.15, 0.12, 0.08, 0.05, 0.04, 0.03, 0.02, 0.01),
    }


def test_every_generator_has_a_name() -> None:
    assert tuple(GENERATORS) == get_args(GeneratorName)


@given(st.sampled_from(NAMES), COUNTS, st.floats(0, 1e300) | st.floats(0, 4))
def test_weights_are_shares_of_a_whole(name: GeneratorName, n: int, parameter: float) -> None:
    weights = generated_weights(name, n, parameter)
    assert len(weights) == n
    require_weights(None, None, weights)


@given(st.sampled_from(NAMES), COUNTS)
def test_a_better_score_never_weighs_less_by_default(name: GeneratorName, n: int) -> None:
    weights = generated_weights(name, n)
    assert all(better >= worse for better, worse in itertools.pairwise(weights))
    assert n == 1 or weights[0] > weights[-1]


@pytest.mark.parametrize(
    ("name", "parameter", "weights"),
    [
        ("geometric", 0.5, [4 / 7, 2 / 7, 1 / 7]),
        ("geometric", 2.0, [1 / 7, 2 / 7, 4 / 7]),
        ("geometric", 0.0, [1, 0, 0]),
        ("geometric", 1.0, [1 / 3, 1 / 3, 1 / 3]),
        ("geometric", 1e300, [0, 1e-300, 1]),
        ("rank-reciprocal", 1.0, [6 / 11, 3 / 11, 2 / 11]),
        ("rank-reciprocal", 2.0, [36 / 49, 9 / 49, 4 / 49]),
        ("rank-exponent", 1.0, [3 / 6, 2 / 6, 1 / 6]),
        ("rank-exponent", 2.0, [9 / 14, 4 / 14, 1 / 14]),
        ("rank-exponent", 0.0, [1 / 3, 1 / 3, 1 / 3]),
        ("quantifier", 1.0, [1 / 3, 1 / 3, 1 / 3]),
        ("quantifier", 2.0, [1 / 9, 3 / 9, 5 / 9]),
        ("quantifier", 0.0, [1, 0, 0]),
        ("centroid", None, [11 / 18, 5 / 18, 2 / 18]),
    ],
)
def test_weights_of_three_scores(name: GeneratorName, parameter: float, weights: list[float]) -> None:
    assert generated_weights(name, 3, parameter) == pytest.approx(weights, rel=1e-14)


@pytest.mark.parametrize(
    ("name", "best", "largest", "mean"),
    [
        ("geometric", 0.6676, 0.0442, 0.0175),
        ("rank-reciprocal", 0.8642, 0.0791, 0.0317),
        ("rank-exponent", 1.1621, 0.1051, 0.0438),
        ("quantifier", 0.5808, 0.1054, 0.0482),
        ("centroid", None, 0.15, 0.0519),
    ],
)
class TestTheTableOfTheDocstring:
    def test_has_the_residuals(self, name: Any, best: float, largest: float, mean: float) -> None:
        found = residuals(name, best)
        assert len(found) == 27
        assert np.abs(found).max() == pytest.approx(largest, abs=6e-5)
        assert rms(found) == pytest.approx(mean, abs=6e-5)

    def test_has_the_best_parameters(self, name: Any, best: float, largest: float, mean: float) -> None:
        if best is not None:
            grid = best + np.linspace(-0.3, 0.3, 601)
            assert rms(residuals(name, best)) <= min(rms(residuals(name, each)) for each in grid) + 1e-8


def test_geometric_is_closest_to_the_paper_in_the_mean_and_at_worst() -> None:
    ours = residuals("geometric")
    for name in set(NAMES) - {"geometric"}:
        best = min((residuals(name, each) for each in np.linspace(0.01, 3, 300)), key=rms)
        assert rms(ours) < 0.6 * rms(best)
        smallest = min(np.abs(residuals(name, each)).max() for each in np.linspace(0.01, 3, 300))
        assert np.abs(ours).max() < 0.6 * smallest


def test_geometric_is_the_paper_s_table_for_two() -> None:
    assert generated_weights("geometric", 2) == pytest.approx(PAPER_WEIGHTS[2], rel=1e-15)


@pytest.mark.parametrize(
    ("weights", "problem"),
    [
        ((), "found none"),
        ((0.5, 0.4), "sum 0.9"),
        ((0.5, 0.5 + 1e-11), "sum 1.00000000001"),
        ((1.5, -0.5), "non-negative .* -0.5"),
        ((math.nan, 1.0), "non-negative .* nan"),
        ((math.inf, 0.0), "sum inf"),
        ("geometrik", "geometric, .*, found geometrik"),
    ],
)
def test_invalid_weights_are_refused(weights: Any, problem: str) -> None:
    with pytest.raises(ValueError, match=f"{problem}$"):
        require_weights(None, None, weights)
