"""The built-in objectives: how far the free end of an actuator moves."""

from collections.abc import Mapping

from evoframe import Objective, hookimpl
from evoframe_objectives.displacement import FaceYz, TipDz, TipYz

__all__ = ["FaceYz", "TipDz", "TipYz", "evoframe_objectives"]


@hookimpl
def evoframe_objectives() -> Mapping[str, type[Objective]]:
    """Offer the displacements of paper.md, "The simulation of one pair"."""
    return {"face-yz": FaceYz, "tip-dz": TipDz, "tip-yz": TipYz}
