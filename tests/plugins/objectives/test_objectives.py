"""The names of the built-in objectives, and their optional capabilities."""

from __future__ import annotations

import pytest

from evoframe import Objective, SupportsUnit
from evoframe_objectives import FacePeak, FaceYz, TipDz, TipYz, Travel, Value, evoframe_objectives


def test_they_are_registered_by_name() -> None:
    assert evoframe_objectives() == {
        "face-peak": FacePeak,
        "face-yz": FaceYz,
        "tip-dz": TipDz,
        "tip-yz": TipYz,
        "travel": Travel,
        "value": Value,
    }


@pytest.mark.parametrize("objective", [FacePeak, FaceYz, TipDz, TipYz, Travel])
def test_each_displacement_is_in_meters(objective: type[Objective]) -> None:
    component = objective()
    assert isinstance(component, SupportsUnit)
    assert component.unit == "m"


def test_the_value_of_a_function_has_no_unit() -> None:
    assert not isinstance(Value(), SupportsUnit)
