from typing import Any

import numpy as np
import pytest
from drawing import network_of, point_of
from hypothesis import given, strategies as st

from evoframe import Design
from evoframe.testing import EncoderContract
from evoframe_encoders import CppnMorphology

CANVASES = st.tuples(st.integers(1, 7), st.integers(1, 5), st.integers(1, 5))
SCALES = st.sampled_from([0.0, 1e-3, 0.1, 1.0, 1e50])
SEEDS = st.integers(0, 2**32 - 1)


class TestContract(EncoderContract):
    component = CppnMorphology()


class TestContractOfAnOpenCanvas(EncoderContract):
    component = CppnMorphology(canvas=(5, 1, 3), enclosure=False, normalized_coordinates=True)


class TestContractOfAConnectedBody(EncoderContract):
    component = CppnMorphology(canvas=(4, 3, 3), enclosure=False, connected=True)


def body_of(encoder: CppnMorphology, network: Any) -> Any:
    return encoder.decode(network, Design()).roles["morphology"]


def constant(presence: float, material: float) -> Any:
    return lambda points: np.tile([presence, material], (len(points), 1))


def one_by_one(encoder: CppnMorphology, network: Any) -> Any:
    """Decode voxel by voxel, as the paper describes."""
    body = np.zeros(encoder.canvas, dtype=np.uint8)
    for index in np.ndindex(*encoder.canvas):
        outermost = any(i in (0, n - 1) for i, n in zip(index, encoder.canvas, strict=True))
        if encoder.enclosure and outermost:
            body[index] = 1
            continue
        point = point_of(index, encoder.canvas, encoder.normalized_coordinates)
        presence, material = network(np.array([point]))[0]
        if abs(presence) >= encoder.threshold:
            body[index] = 3 if abs(material) >= encoder.threshold else 1
    return body


def test_the_defaults_are_the_papers() -> None:
    encoder = CppnMorphology()
    assert encoder == CppnMorphology((20, 8, 8), enclosure=True, threshold=0.5, normalized_coordinates=False)
    assert (encoder.inputs, encoder.outputs) == (3, 2)
    assert (encoder.requires, encoder.provides) == ((), ("morphology",))
    assert (encoder.input_names, encoder.output_names) == (("x", "y", "z"), ("presence", "material"))


ENCODERS = st.builds(
    CppnMorphology, canvas=CANVASES, enclosure=st.booleans(), normalized_coordinates=st.booleans()
)


@given(ENCODERS, SEEDS, SCALES)
def test_a_body_equals_the_one_decoded_voxel_by_voxel(
    encoder: CppnMorphology, seed: int, scale: float
) -> None:
    drawing = network_of(3, 2, seed, scale)
    assert body_of(encoder, drawing).tolist() == one_by_one(encoder, drawing).tolist()


@given(CANVASES, SEEDS, SCALES)
def test_a_body_has_the_canvas_the_codes_and_the_enclosure(canvas: Any, seed: int, scale: float) -> None:
    body = body_of(CppnMorphology(canvas), network_of(3, 2, seed, scale))
    assert body.shape == canvas
    assert body.dtype == np.uint8
    assert not body.flags.writeable
    assert set(np.unique(body)) <= {0, 1, 3}
    interior = np.zeros(canvas, dtype=bool)
    interior[1:-1, 1:-1, 1:-1] = True
    assert (body[~interior] == 1).all()


def parts_of(body: Any) -> list[set[tuple[int, ...]]]:
    """Return the parts of a body by walking from voxel to voxel through their faces."""
    left = {tuple(index) for index in np.argwhere(body).tolist()}
    parts = []
    while left:
        walk = [min(left)]
        part = set()
        while walk:
            voxel = walk.pop()
            if voxel in left:
                left.remove(voxel)
                part.add(voxel)
                steps = np.concatenate([np.eye(3, dtype=int), -np.eye(3, dtype=int)])
                walk += [tuple(step) for step in (np.array(voxel) + steps).tolist()]
        parts.append(part)
    return parts


def noise(seed: int) -> Any:
    """Return a random network that gives bodies of many small parts, unlike real networks."""
    return lambda points: np.random.default_rng(seed).normal(size=(len(points), 2), scale=0.5)


@given(CANVASES, SEEDS)
def test_the_largest_part_is_kept_unchanged(canvas: Any, seed: int) -> None:
    drawing = noise(seed)
    whole = body_of(CppnMorphology(canvas, enclosure=False), drawing)
    kept = body_of(CppnMorphology(canvas, enclosure=False, connected=True), drawing)
    largest = max(parts_of(whole), key=len, default=set())  # the first among equally large ones
    assert {tuple(index) for index in np.argwhere(kept).tolist()} == largest
    assert kept[kept > 0].tolist() == whole[kept > 0].tolist()
    assert not kept.flags.writeable


@pytest.mark.parametrize(
    ("presence", "material", "code"),
    [
        (0.5, 0.5, 3),
        (-0.5, -0.5, 3),
        (0.5, 0.49999, 1),
        (0.49999, 9.0, 0),
        (-1e50, 0.0, 1),
        (0.0, 0.0, 0),
    ],
)
def test_presence_comes_first_and_signs_do_not_matter(presence: float, material: float, code: int) -> None:
    body = body_of(CppnMorphology(), constant(presence, material))
    assert set(np.unique(body[1:-1, 1:-1, 1:-1])) == {code}


def test_the_network_is_evaluated_in_the_interior_only_in_raw_coordinates() -> None:
    asked = []

    def network(points: Any) -> Any:
        asked.append(points)
        return np.zeros((len(points), 2))

    body_of(CppnMorphology(), network)
    (points,) = asked
    assert points.shape == (18 * 6 * 6, 3)
    assert (points.min(axis=0).tolist(), points.max(axis=0).tolist()) == ([1, 1, 1], [18, 6, 6])


def test_the_points_are_computed_once_and_cannot_be_changed() -> None:
    asked = []

    def network(points: Any) -> Any:
        asked.append(points)
        return np.zeros((len(points), 2))

    for _ in range(2):
        body_of(CppnMorphology((4, 5, 6)), network)
    assert asked[0] is asked[1]
    assert asked[0].flags.c_contiguous
    assert not asked[0].flags.writeable


def test_other_roles_of_a_design_are_kept() -> None:
    design = CppnMorphology().decode(constant(1, 1), Design({"color": np.arange(3)}))
    assert sorted(design.roles) == ["color", "morphology"]


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"canvas": (0, 8, 8)}, r"'canvas' .*three .*: \(0, 8, 8\)$"),
        ({"canvas": (8, 8)}, r"'canvas' .*three .*: \(8, 8\)$"),
        ({"canvas": [20, 8, 8]}, r"'canvas' .*three .*: \[20, 8, 8\]$"),
        ({"canvas": (2**12, 2**12, 2)}, r"'canvas' .*16777216 voxels: \(4096, 4096, 2\)$"),
        ({"threshold": -0.1}, "threshold"),
        ({"threshold": float("nan")}, "threshold"),
    ],
)
def test_a_bad_option_is_named(options: Any, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        CppnMorphology(**options)


@given(seed=SEEDS, enclosure=st.booleans())
def test_measures_count_voxels_that_the_network_determines(seed: int, enclosure: bool) -> None:
    encoder = CppnMorphology(canvas=(5, 4, 4), enclosure=enclosure)
    decoded = encoder.decode(network_of(3, 2, seed, 1.0), Design())
    body = decoded.roles["morphology"]
    drawn = body[1:-1, 1:-1, 1:-1] if enclosure else body
    measured = encoder.measure(decoded)
    assert measured["count-contractile"] == np.count_nonzero(body == 3)
    assert measured["filled-share"] == np.count_nonzero(drawn) / drawn.size


def test_a_canvas_without_an_interior_is_not_filled() -> None:
    encoder = CppnMorphology(canvas=(2, 2, 2))
    assert encoder.measure(Design({"morphology": np.ones((2, 2, 2), np.uint8)}))["filled-share"] == 0.0
