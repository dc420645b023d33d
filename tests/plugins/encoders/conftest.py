"""Networks of all kinds, without an evolver: an encoder never sees a genome."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

Points = NDArray[np.float64]


def _network(inputs: int, outputs: int, seed: int, scale: float) -> Callable[[Points], Points]:
    """Return a network that adds in the same order for one point as for many."""
    rng = np.random.default_rng(seed)
    weights, bias = rng.normal(size=(inputs, outputs)), rng.normal(size=outputs)

    def network(points: Points) -> Points:
        assert points.dtype == np.float64
        assert points.shape[1:] == (inputs,)
        total = bias + sum(points[:, i : i + 1] * weights[i] for i in range(inputs))
        return scale * total

    return network


@pytest.fixture(scope="session")
def network() -> Any:
    return _network
