"""The names of the built-in encoders, and their optional capabilities."""

from __future__ import annotations

import pytest

from evoframe import Encoder, SupportsInputNames, SupportsOutputNames
from evoframe_encoders import CppnController, CppnMorphology, CppnVoxels, Vector, evoframe_encoders


def test_they_are_registered_by_name() -> None:
    assert evoframe_encoders() == {
        "cppn-controller": CppnController,
        "cppn-morphology": CppnMorphology,
        "cppn-voxels": CppnVoxels,
        "vector": Vector,
    }


@pytest.mark.parametrize("component", [CppnMorphology(), CppnController(), Vector("x"), Vector("x", 3)])
def test_each_names_its_inputs_and_outputs(component: Encoder) -> None:
    assert isinstance(component, SupportsInputNames)
    assert isinstance(component, SupportsOutputNames)
    assert len(component.input_names) == component.inputs
    assert len(component.output_names) == component.outputs
