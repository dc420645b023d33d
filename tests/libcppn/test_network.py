from concurrent.futures import ThreadPoolExecutor
from typing import Any, TypeAlias

import numpy as np
import pytest
from cppns import Gene, evaluate
from hypothesis import given, strategies as st
from hypothesis.extra import numpy as hnp
from numpy.typing import NDArray

from evoframe_libcppn import ACTIVATIONS, CppnNetwork, Link

Drawn: TypeAlias = tuple[int, int, dict[int, Gene], list[Link]]
"""Inputs, outputs, nodes, links."""

BLOCK = 128  # number of points that the library computes at a time

EXTREMES = [0.0, -0.0, 1.0, 1e-310, 1e60, -1e300, np.inf, -np.inf, np.nan]
NUMBERS = st.floats(-30, 30) | st.sampled_from(EXTREMES)


@st.composite
def drawn_networks(draw: st.DrawFn) -> Drawn:
    """Draw networks with hidden nodes, constants, dead ends and duplicate links."""
    inputs, outputs = draw(st.integers(1, 4)), draw(st.integers(1, 3))
    hidden = draw(st.lists(st.integers(outputs, 2**63 - 1), max_size=8, unique=True))
    ids = draw(st.permutations([*range(outputs), *hidden]))  # links lead only to later nodes
    ends = [(source, target) for k, target in enumerate(ids) for source in (*range(-inputs, 0), *ids[:k])]
    links = draw(st.lists(st.tuples(st.sampled_from(ends), NUMBERS), max_size=25))
    genes = st.builds(Gene, st.sampled_from(ACTIVATIONS), NUMBERS, st.just(1.0) | NUMBERS)
    nodes = {node: draw(genes) for node in draw(st.permutations(ids))}
    return inputs, outputs, nodes, [(source, target, weight) for (source, target), weight in links]


def points_for(inputs: int, n: int = 3 * BLOCK) -> NDArray[np.float64]:
    rng = np.random.default_rng(0)
    return np.concatenate([rng.normal(size=(n - n // 3, inputs)), rng.choice(EXTREMES, (n // 3, inputs))])


def chain(*activations: str) -> CppnNetwork:
    """Return a network with a chain of nodes; the last one is the output."""
    ids = [*range(1, len(activations)), 0]
    nodes = {node: Gene(name) for node, name in zip(ids, activations, strict=True)}
    links = [(source, target, 1.0) for source, target in zip([-1, *ids], ids, strict=False)]
    return CppnNetwork(1, 1, nodes, links)


@given(drawn_networks(), st.data())
def test_a_network_equals_its_definition_bit_for_bit(drawn: Drawn, data: st.DataObject) -> None:
    inputs, outputs, nodes, links = drawn
    shape = st.tuples(st.integers(0, 5), st.just(inputs))
    points = data.draw(hnp.arrays(np.float64, shape, elements=st.floats() | NUMBERS))
    values = CppnNetwork(*drawn)(points)
    expected = [evaluate(outputs, nodes, links, point) for point in points.tolist()]
    assert values.shape == (len(points), outputs)
    assert values.tobytes() == np.array(expected, dtype=np.float64).tobytes()


@given(drawn_networks(), st.integers(0, 3 * BLOCK))
def test_a_point_has_the_same_value_alone_and_among_others(drawn: Drawn, alone: int) -> None:
    network, points = CppnNetwork(*drawn), points_for(drawn[0], 3 * BLOCK + 1)
    together = network(points)
    assert np.isfinite(together).all()
    assert network(points[alone : alone + 1]).tobytes() == together[alone].tobytes()


@pytest.mark.parametrize("n", [0, 1, BLOCK - 1, BLOCK, BLOCK + 1, 2 * BLOCK, 3 * BLOCK - 1])
def test_values_do_not_depend_on_the_number_of_points(n: int) -> None:
    network, points = chain("sin", "tanh", "cube"), points_for(1)
    assert network(points[:n]).tobytes() == network(points)[:n].tobytes()


@given(drawn_networks())
def test_threads_can_share_a_network(drawn: Drawn) -> None:
    network, points = CppnNetwork(*drawn), points_for(drawn[0], 900)
    with ThreadPoolExecutor(4) as threads:
        values = {array.tobytes() for array in threads.map(network, [points] * 8)}
    assert values == {network(points).tobytes()}


@given(drawn_networks(), st.randoms(use_true_random=False))
def test_the_order_of_the_nodes_does_not_matter(drawn: Drawn, random: Any) -> None:
    inputs, outputs, nodes, links = drawn
    shuffled = list(nodes.items())
    random.shuffle(shuffled)
    points = points_for(inputs, 20)
    other = CppnNetwork(inputs, outputs, dict(shuffled), links)
    assert other(points).tobytes() == CppnNetwork(*drawn)(points).tobytes()


def test_a_node_applies_its_activation_to_bias_and_weighted_sum() -> None:
    network = CppnNetwork(2, 1, {0: Gene("identity", 0.5, 2.0)}, [(-1, 0, 3.0), (-2, 0, -1.0)])
    assert network(np.array([[1.0, 4.0], [2.0, 0.0]])).tolist() == [[0.5 + 2 * -1.0], [0.5 + 2 * 6.0]]


def test_a_node_that_does_not_depend_on_inputs_is_a_constant() -> None:
    network = CppnNetwork(1, 2, {0: Gene("square", 3.0), 1: Gene("identity")}, [(0, 1, 2.0)])
    assert network(np.zeros((3, 1))).tolist() == [[9.0, 18.0]] * 3
    assert network.evaluated_nodes == 0


@pytest.mark.parametrize("place", range(4))
def test_constants_are_added_in_their_place(place: int) -> None:
    """The position of 1e16 determines which 1.0 is lost to rounding."""
    nodes = {0: Gene("identity"), 1: Gene("identity", 1e16), 2: Gene("identity", -1e16)}
    links = [(-1, 0, 1.0), (-1, 0, 1.0)]
    links[place // 2 : place // 2] = [(1, 0, 1.0)]
    links.insert(place, (2, 0, 1.0))
    network = CppnNetwork(1, 1, nodes, links)
    assert network(np.ones((1, 1))).tolist() == [evaluate(1, nodes, links, [1.0])]
    assert network.evaluated_nodes == 1


def test_nodes_that_no_output_depends_on_are_omitted() -> None:
    nodes = {node: Gene("identity") for node in range(3)}
    network = CppnNetwork(1, 1, nodes, [(-1, 0, 1.0), (-1, 1, 1.0), (0, 2, 1.0)])
    assert network.evaluated_nodes == 1


def test_a_deep_network_is_compiled() -> None:
    assert chain(*["identity"] * 60_000)(np.array([[0.5]])).tolist() == [[0.5]]


@given(
    st.lists(st.sampled_from(["cube", "exp", "inv", "log", "neg_square", "softplus"]), min_size=1, max_size=9)
)
def test_outputs_are_finite_for_any_chain_and_input(names: list[str]) -> None:
    points = np.array([[0.0], [1e-60], [-7.0], [1e50], [-1e300], [np.inf], [-np.inf], [np.nan]])
    assert np.isfinite(chain(*names)(points)).all()


def strange(points: NDArray[np.float64]) -> dict[str, NDArray[Any]]:
    """Return the same points in several layouts and types."""
    rows = [point.tobytes() for point in points]
    unaligned = np.frombuffer(b"x" + b"".join(rows), np.uint8)[1:].view(np.float64).reshape(points.shape)
    assert not unaligned.flags.aligned
    return {
        "columns": np.asfortranarray(points),
        "every other": np.repeat(points, 2, axis=0)[::2],
        "backwards": points[::-1].copy()[::-1],
        "whole numbers": points.astype(np.int16),
        "other byte order": points.astype(">f8"),
        "unaligned": unaligned,
        "read-only": np.frombuffer(points.tobytes()).reshape(points.shape),
    }


def test_the_layout_and_type_of_the_points_do_not_matter() -> None:
    points = np.random.default_rng(0).integers(0, 20, (40, 3)).astype(np.float64)
    network = CppnNetwork(3, 1, {0: Gene("tanh")}, [(-1, 0, 0.1), (-2, 0, -0.2), (-3, 0, 0.3)])
    for name, same in strange(points).items():
        assert network(same).tobytes() == network(points).tobytes(), name


def test_the_points_are_not_changed() -> None:
    points = np.full((3, 1), 1e60)
    chain("identity")(points)
    assert (points == 1e60).all()


@pytest.mark.parametrize("shape", [(3,), (3, 2), (2, 3, 1)])
def test_points_of_another_shape_are_rejected(shape: tuple[int, ...]) -> None:
    with pytest.raises(ValueError, match=r"\(n, 1\), got \("):
        chain("sin")(np.zeros(shape))


SINE = Gene("sin")


@pytest.mark.parametrize(
    ("nodes", "links", "message"),
    [
        ({0: SINE, 5: SINE}, [(0, 5, 1.0), (5, 0, 1.0)], "cycle: node 0"),
        ({0: SINE, 5: SINE, 7: SINE}, [(5, 0, 1.0), (7, 5, 1.0), (5, 7, 1.0)], "cycle: node 5"),
        ({0: SINE}, [(0, 0, 1.0)], "cycle"),
        ({0: SINE}, [(7, 0, 1.0)], ": 7 -> 0"),
        ({0: SINE}, [(-1, 7, 1.0)], "-1 -> 7"),
        ({0: SINE}, [(-1, 0, 1.0), (-2, 0, 1.0)], "-2 -> 0"),
        ({0: SINE}, [(-1, -1, 1.0)], "-1 -> -1"),
        ({1: SINE}, [], "output node .*: 0$"),
        ({}, [], "output node .*: 0$"),
        ({0: SINE, 4: Gene("sine")}, [], "activation 'sine': node 4"),
        ({0: SINE, -1: SINE}, [], "negative: node -1"),
        ({2**63: SINE}, [], "64 bits"),
        ({0: SINE}, [(-(2**70), 0, 1.0)], "64 bits"),
        ({0: Gene("sin", 10**400)}, [], "64 bits"),
    ],
)
def test_an_invalid_network_is_rejected(nodes: Any, links: Any, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        CppnNetwork(1, 1, nodes, links)


@pytest.mark.parametrize(
    ("inputs", "outputs", "message"),
    [(0, 1, "inputs"), (-1, 1, "inputs"), (65537, 1, "inputs"), (1, 0, "outputs"), (2**70, 1, "64 bits")],
)
def test_invalid_sizes_are_rejected(inputs: int, outputs: int, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        CppnNetwork(inputs, outputs, {0: SINE}, [])
