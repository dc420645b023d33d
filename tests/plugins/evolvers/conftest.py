"""neat-python's own networks, for comparison."""

from types import SimpleNamespace
from typing import Any

import neat
import numpy as np
import pytest
from cppns import NEAT
from neat.activations import ActivationFunctionSet
from numpy.typing import NDArray


@pytest.fixture(scope="session")
def neat_network() -> Any:
    """Return neat-python's outputs, and the largest absolute value of any node, at each point."""

    def evaluate(run: Any, genome: Any, points: NDArray[np.float64]) -> tuple[Any, Any]:
        ours = run._pool.config.genome_config
        activations = ActivationFunctionSet()
        activations.functions = dict(NEAT)
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
