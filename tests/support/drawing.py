"""Networks for tests of encoders, without an evolver."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

Points = NDArray[np.float64]


def network_of(inputs: int, outputs: int, seed: int, scale: float) -> Callable[[Points], Points]:
    """Return a network that adds in the same order for one point and for many."""
    rng = np.random.default_rng(seed)
    weights, bias = rng.normal(size=(inputs, outputs)), rng.normal(size=outputs)

    def network(points: Points) -> Points:
        assert points.dtype == np.float64
        assert points.shape[1:] == (inputs,)
        total: Points = bias + sum(points[:, i : i + 1] * weights[i] for i in range(inputs))
        return scale * total

    return network


def point_of(index: tuple[int, ...], canvas: tuple[int, ...], normalized: bool) -> list[float]:
    """Return the coordinates of a voxel as the input of a network."""
    if not normalized:
        return [float(i) for i in index]
    return [float(np.linspace(-1, 1, n)[i]) if n > 1 else 0.0 for i, n in zip(index, canvas, strict=True)]
