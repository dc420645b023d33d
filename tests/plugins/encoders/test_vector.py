"""The encoder ``vector``."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given, strategies as st
from numpy.typing import NDArray

from evoframe import ArrayType, Design, Network, SupportsArrayTypes
from evoframe.testing import EncoderContract
from evoframe_encoders import Vector

lists = st.lists(st.floats(-2.0, 3.0), min_size=1, max_size=5)


class TestContract(EncoderContract):
    component = Vector("x")


class TestContractOfSeveralNumbers(EncoderContract):
    component = Vector("gait", 4)

    def design(self) -> Design:
        return Design({"x": np.ones(3)})


def constant(outputs: list[float]) -> Network:
    """Return a network with the same outputs at every point."""
    return lambda points: np.tile(outputs, (len(points), 1))


def decoded(outputs: list[float]) -> NDArray[np.float64]:
    vector: NDArray[np.float64] = Vector("x", len(outputs)).decode(constant(outputs), Design()).roles["x"]
    return vector


@given(outputs=lists)
def test_a_number_from_0_to_1_is_the_output_and_others_are_clipped(outputs: list[float]) -> None:
    assert decoded(outputs).tolist() == [min(max(each, 0.0), 1.0) for each in outputs]


@given(outputs=lists)
def test_the_vector_has_the_declared_type(outputs: list[float]) -> None:
    component = Vector("x", len(outputs))
    assert isinstance(component, SupportsArrayTypes)
    assert component.array_types == {"x": ArrayType.of(decoded(outputs))}


def test_a_network_is_evaluated_at_the_same_read_only_point() -> None:
    asked: list[NDArray[np.float64]] = []

    def network(points: NDArray[np.float64]) -> NDArray[np.float64]:
        asked.append(points)
        return np.zeros((len(points), 1))

    for _ in range(2):
        Vector("x").decode(network, Design())
    first, second = asked
    assert first is second
    assert first.shape == (1, 0)
    assert not first.flags.writeable


@pytest.mark.parametrize("options", [{"role": ""}, {"role": "x", "length": 0}])
def test_impossible_options_are_refused(options: dict[str, Any]) -> None:
    with pytest.raises(ValueError, match=[*options][-1]):
        Vector(**options)
