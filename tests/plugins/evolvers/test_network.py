import sys
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from evoframe_evolvers import Neat, RandomSearch
from evoframe_evolvers.network import Node, build_network


def voxels(inputs: int) -> Any:
    """Return points such as an encoder gives: indices of voxels, and a material code."""
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
def test_networks_are_neat_pythons(
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


def chain(*activations: str) -> Any:
    """Return a network of nodes behind each other; the last one is the output."""
    ids = [*range(1, len(activations)), 0]
    nodes = {i: Node(name, 0.0, 1.0) for i, name in zip(ids, activations, strict=True)}
    links = [(source, target, 1.0) for source, target in zip([-1, *ids], ids, strict=False)]
    return build_network(1, 1, nodes, links)


def test_a_node_is_its_activation_of_bias_and_weighted_sum() -> None:
    network = build_network(2, 1, {0: Node("identity", 0.5, 2.0)}, [(-1, 0, 3.0), (-2, 0, -1.0)])
    assert network(np.array([[1.0, 4.0], [2.0, 0.0]])).tolist() == [[0.5 + 2 * -1.0], [0.5 + 2 * 6.0]]


def test_a_node_without_inputs_is_a_constant() -> None:
    network = build_network(1, 2, {0: Node("square", 3.0, 1.0), 1: Node("identity", 0.0, 1.0)}, [(0, 1, 2.0)])
    assert network(np.zeros((3, 1))).tolist() == [[9.0, 18.0]] * 3


def test_no_points_give_no_outputs() -> None:
    assert chain("sin", "exp", "inv")(np.zeros((0, 1))).shape == (0, 1)
    assert build_network(4, 2, {0: Node("sin", 1, 1), 1: Node("log", 1, 1)}, [])(np.zeros((0, 4))).shape == (
        0,
        2,
    )


def test_nodes_that_no_output_depends_on_are_left_out() -> None:
    nodes = {i: Node("identity", 0.0, 1.0) for i in range(3)}
    network = build_network(1, 1, nodes, [(-1, 0, 1.0), (-1, 1, 1.0), (0, 2, 1.0)])
    assert [step.node for step in network.steps] == [0]


@given(
    st.lists(st.sampled_from(["cube", "exp", "inv", "log", "neg_square", "softplus"]), min_size=1, max_size=9)
)
def test_outputs_are_finite_whatever_is_chained_and_comes_in(names: list[str]) -> None:
    points = np.array([[0.0], [1e-60], [-7.0], [1e50], [-1e300], [np.inf], [-np.inf], [np.nan]])
    assert np.isfinite(chain(*names)(points)).all()


def test_huge_weights_give_finite_outputs() -> None:
    nodes = {0: Node("identity", 0.0, 1.0)}
    network = build_network(2, 1, nodes, [(-1, 0, 1e300), (-2, 0, -1e300)])
    assert np.isfinite(network(np.full((2, 2), 1e50))).all()


def test_the_points_are_left_alone() -> None:
    points = np.full((3, 1), 1e60)
    points.setflags(write=False)
    chain("identity")(points)
    assert (points == 1e60).all()


@pytest.mark.parametrize("shape", [(3,), (3, 2), (2, 3, 1)])
def test_points_of_another_shape_are_refused(shape: tuple[int, ...]) -> None:
    with pytest.raises(ValueError, match=r"expected points of shape \(n, 1\)"):
        chain("sin")(np.zeros(shape))


SINE = Node("sin", 0.0, 1.0)


@pytest.mark.parametrize(
    ("nodes", "links", "message"),
    [
        ({0: SINE, 1: SINE}, [(0, 1, 1.0), (1, 0, 1.0)], "cycle"),
        ({0: SINE}, [(0, 0, 1.0)], "cycle"),
        ({0: SINE}, [(7, 0, 1.0)], "7 -> 0"),
        ({0: SINE}, [(-1, 7, 1.0)], "-1 -> 7"),
        ({0: SINE}, [(-2, 0, 1.0)], "-2 -> 0"),
        ({1: SINE}, [], "output node 0"),
        ({0: Node("sine", 0.0, 1.0)}, [], "unknown activation 'sine'"),
    ],
)
def test_what_is_no_network_is_refused(nodes: Any, links: Any, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        build_network(1, 1, nodes, links)
