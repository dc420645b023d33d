"""The built-in objectives: displacements of an actuator or a walker, and the value of a function."""

from collections.abc import Mapping

from evoframe import Objective, hookimpl
from evoframe_objectives.displacement import FaceYz, TipDz, TipYz
from evoframe_objectives.settled import FacePeak, Travel
from evoframe_objectives.value import Value

__all__ = ["FacePeak", "FaceYz", "TipDz", "TipYz", "Travel", "Value", "evoframe_objectives"]


@hookimpl
def evoframe_objectives() -> Mapping[str, type[Objective]]:
    """Register the displacements, the distance that a free body travels, and the value of a function."""
    return {
        "face-peak": FacePeak,
        "face-yz": FaceYz,
        "tip-dz": TipDz,
        "tip-yz": TipYz,
        "travel": Travel,
        "value": Value,
    }
