import sys
from typing import Any

import numpy as np
import pytest

from evoframe_evolvers import Neat, RandomSearch


def voxels(inputs: int) -> Any:
    """Return points like those of encoders (voxel indices and a material code), and extreme ones."""
    rng = np.random.default_rng(0)
    points = rng.integers(0, [20, 8, 8, 4][:inputs], size=(40, inputs)).astype(np.float64)
    return np.concatenate([points, [[0.0] * inputs, [-1e3] * inputs, [1e50] * inputs]])


def evolved(evolver: Any, inputs: int, outputs: int, seed: int, turns: int) -> Any:
    run = evolver.start(inputs, outputs, 25, np.random.default_rng(seed))
    rng = np.random.default_rng(seed)
    for _ in range(turns):
        genomes = run.ask()
        run.tell(np.array([sum(genome.size()) for genome in genomes]) + rng.normal(size=25), {})
    return run


@pytest.mark.parametrize(
    ("evolver", "turns"),
    [
        (Neat(), 1),
        (Neat(node_add=0.9, connection_add=0.9, node_delete=0.05, connection_delete=0.05), 30),
        (RandomSearch(mutations=60, node_delete=0.05, connection_delete=0.05), 1),
    ],
)
@pytest.mark.parametrize("shape", [(3, 2), (4, 1)])
@pytest.mark.parametrize("seed", range(4))
def test_networks_equal_those_of_neat_python(
    evolver: Any, turns: int, shape: tuple[int, int], seed: int, neat_network: Any
) -> None:
    run = evolved(evolver, *shape, seed, turns)
    points = voxels(shape[0])
    for genome in run.genomes():
        theirs, largest = neat_network(run, genome, points)
        deviation = np.abs(run.express(genome)(points) - theirs).max(axis=1)
        assert (deviation <= 1e-12 * largest).all()
        if sys.version_info < (3, 12):  # where sum() of neat-python adds from left to right
            assert (deviation == 0.0).all()
