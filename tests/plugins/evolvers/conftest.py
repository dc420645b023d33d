"""neat-python's own functions and networks, to compare with."""

import math
from collections.abc import Callable, Mapping
from types import SimpleNamespace
from typing import Any

import neat
import numpy as np
import pytest
from neat.activations import ActivationFunctionSet
from numpy.typing import NDArray

LIMIT = 1e50

LACKING = {
    "neg_abs": lambda z: -abs(z),
    "neg_square": lambda z: -(z**2),
    "sqrt_abs": lambda z: math.sqrt(abs(z)),
    "neg_sqrt_abs": lambda z: -math.sqrt(abs(z)),
    "neg_sin": lambda z: -math.sin(z),
}
"""The formulas that neat-python has no function for."""


def clamp(value: float) -> float:
    return max(-LIMIT, min(LIMIT, value))


def guarded(function: Callable[[float], float]) -> Callable[[float], float]:
    return lambda z: clamp(function(clamp(z)))


@pytest.fixture(scope="session")
def neat_activations() -> Mapping[str, Callable[[float], float]]:
    """The 23 functions, neat-python's own where it has one, within evoframe's guard."""
    functions = {**ActivationFunctionSet().functions, **LACKING}
    return {name: guarded(function) for name, function in functions.items()}


@pytest.fixture(scope="session")
def neat_network(neat_activations: Mapping[str, Callable[[float], float]]) -> Any:
    """Return neat-python's outputs, and the largest absolute value of any node, at each point."""

    def evaluate(run: Any, genome: Any, points: NDArray[np.float64]) -> tuple[Any, Any]:
        ours = run._pool.config.genome_config
        activations = ActivationFunctionSet()
        activations.functions = dict(neat_activations)
        config = SimpleNamespace(
            genome_config=SimpleNamespace(
                input_keys=ours.input_keys,
                output_keys=ours.output_keys,
                activation_defs=activations,
                aggregation_function_defs=ours.aggregation_function_defs,
            )
        )
        network = neat.nn.FeedForwardNetwork.create(genome, config)
        outputs, largest = [], []
        for point in points.tolist():
            outputs.append(network.activate(point))
            largest.append(max(map(abs, network.values.values())))
        return np.array(outputs), np.array(largest)

    return evaluate
