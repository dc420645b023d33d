"""The built-in objectives: displacements of an actuator or a walker."""

from collections.abc import Mapping

from evoframe import Objective, hookimpl
from evoframe_objectives.displacement import FaceYz, TipDz, TipYz
from evoframe_objectives.settled import FacePeak, Travel

__all__ = ["FacePeak", "FaceYz", "TipDz", "TipYz", "Travel", "evoframe_objectives"]


@hookimpl
def evoframe_objectives() -> Mapping[str, type[Objective]]:
    """Register the displacements of the actuator, and the distance that a free body travels."""
    return {
        "face-peak": FacePeak,
        "face-yz": FaceYz,
        "tip-dz": TipDz,
        "tip-yz": TipYz,
        "travel": Travel,
    }
