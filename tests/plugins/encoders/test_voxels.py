from typing import Any

import numpy as np
from hypothesis import given, strategies as st

from evoframe import Design, Network
from evoframe.testing import EncoderContract
from evoframe.testing.laws import random_network
from evoframe_encoders import CppnController, CppnMorphology, CppnVoxels


class TestContract(EncoderContract):
    component = CppnVoxels(CppnMorphology(canvas=(5, 4, 3)))


class TestContractOfAnOpenCanvas(EncoderContract):
    component = CppnVoxels(
        CppnMorphology(canvas=(4, 1, 3), enclosure=False, normalized_coordinates=True, connected=True)
    )


@given(seed=st.integers(0, 2**32 - 1), normalized=st.booleans())
def test_it_decodes_as_both_encoders_would(seed: int, normalized: bool) -> None:
    body = CppnMorphology(canvas=(5, 4, 3), normalized_coordinates=normalized)
    network = random_network(3, 3, seed, 2.0)
    decoded = CppnVoxels(body).decode(network, Design())
    apart = body.decode(part(network, slice(0, 2)), Design())
    offsets = CppnController(normalized_coordinates=normalized)
    apart = offsets.decode(part(network, slice(2, 3)), apart)
    for role in ("morphology", "controller"):
        assert np.array_equal(decoded.roles[role], apart.roles[role])


def part(network: Network, outputs: slice) -> Any:
    """Return some outputs of a network, which ignores the material."""
    return lambda points: network(np.ascontiguousarray(points[:, :3]))[:, outputs]
