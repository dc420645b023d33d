import math
from typing import Any

import numpy as np
from drawing import network_of, point_of
from hypothesis import given, strategies as st
from hypothesis.extra import numpy as hnp

from evoframe import Design
from evoframe.testing import EncoderContract
from evoframe_encoders import CppnController

BODIES = hnp.arrays(
    np.uint8, hnp.array_shapes(min_dims=3, max_dims=3, max_side=5), elements=st.sampled_from([0, 1, 3])
)
SCALES = st.sampled_from([0.0, 0.1, 1.0, 1e50])
SEEDS = st.integers(0, 2**32 - 1)


def some_body() -> Design:
    codes = np.random.default_rng(0).choice([0, 1, 3], size=(6, 4, 3)).astype(np.uint8)
    return Design({"morphology": codes})


class TestContract(EncoderContract):
    component = CppnController()

    def design(self) -> Design:
        return some_body()


class TestContractInNormalizedCoordinates(EncoderContract):
    component = CppnController(normalized_coordinates=True)

    def design(self) -> Design:
        return some_body()


def offsets_of(body: Any, network: Any, **options: Any) -> Any:
    return CppnController(**options).decode(network, Design({"morphology": body})).roles["controller"]


def test_the_declarations_are_the_papers() -> None:
    encoder = CppnController()
    assert (encoder.inputs, encoder.outputs) == (4, 1)
    assert (encoder.requires, encoder.provides) == (("morphology",), ("controller",))
    assert (encoder.input_names, encoder.output_names) == (("x", "y", "z", "material"), ("phase offset",))


@given(BODIES, st.booleans(), SEEDS, SCALES)
def test_offsets_equal_those_decoded_voxel_by_voxel(
    body: Any, normalized: bool, seed: int, scale: float
) -> None:
    drawing = network_of(4, 1, seed, scale)
    expected = np.zeros(body.shape)
    for index in zip(*np.nonzero(body == 3), strict=True):
        offset = drawing(np.array([[*point_of(index, body.shape, normalized), 3.0]]))[0, 0]
        expected[index] = min(max(offset, -2 * math.pi), 2 * math.pi)
    offsets = offsets_of(body, drawing, normalized_coordinates=normalized)
    assert offsets.dtype == np.float64
    assert not offsets.flags.writeable
    assert offsets.tolist() == expected.tolist()


@given(BODIES, SEEDS, SCALES)
def test_offsets_are_within_2_pi_and_0_in_voxels_that_do_not_contract(
    body: Any, seed: int, scale: float
) -> None:
    offsets = offsets_of(body, network_of(4, 1, seed, scale))
    assert (np.abs(offsets) <= 2 * math.pi).all()
    assert (offsets[body != 3] == 0.0).all()


def test_the_same_network_gives_a_different_controller_for_a_different_body() -> None:
    drawing = network_of(4, 1, 0, 0.1)
    one, other = np.full((3, 3, 3), 3, np.uint8), np.full((3, 3, 3), 3, np.uint8)
    other[1] = 1
    offsets = offsets_of(one, drawing)
    assert (offsets[1] != 0).any()
    assert (offsets_of(other, drawing)[1] == 0).all()


def test_a_body_without_contractile_voxels_has_no_offsets() -> None:
    assert not offsets_of(np.ones((2, 2, 2), np.uint8), network_of(4, 1, 0, 1.0)).any()


def test_the_inputs_are_raw_coordinates_and_the_code_of_contractile_voxels() -> None:
    asked = []

    def network(points: Any) -> Any:
        asked.append(points)
        return np.zeros((len(points), 1))

    for code in (0, 3):
        offsets_of(np.full((2, 1, 2), code, np.uint8), network)
    assert asked[0].tolist() == [[0, 0, 0, 3], [0, 0, 1, 3], [1, 0, 0, 3], [1, 0, 1, 3]]
    assert asked[0] is asked[1]  # the core evaluates a network only once at the same read-only points
    assert not asked[0].flags.writeable
