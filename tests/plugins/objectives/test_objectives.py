"""The names of the built-in objectives, and their optional capabilities."""

from __future__ import annotations

import pytest

from evoframe import Objective, SupportsUnit
from evoframe_objectives import FacePeak, FaceYz, TipDz, TipYz, Travel, evoframe_objectives


def test_they_are_registered_by_name() -> None:
    assert evoframe_objectives() == {
        "face-peak": FacePeak,
        "face-yz": FaceYz,
        "tip-dz": TipDz,
        "tip-yz": TipYz,
        "travel": Travel,
    }


@pytest.mark.parametrize("objective", evoframe_objectives().values())
def test_each_scores_in_meters(objective: type[Objective]) -> None:
    component = objective()
    assert isinstance(component, SupportsUnit)
    assert component.unit == "m"
