"""The built-in simulator: voxel actuators on libvox."""

from collections.abc import Mapping

from evoframe import Simulator, hookimpl
from evoframe_simulators.vox.materials import PaletteMaterial
from evoframe_simulators.vox.regions import FixedRegion
from evoframe_simulators.vox.simulator import Vox

__all__ = ["FixedRegion", "PaletteMaterial", "Vox", "evoframe_simulators"]


@hookimpl
def evoframe_simulators() -> Mapping[str, type[Simulator]]:
    """Offer ``vox``."""
    return {"vox": Vox}
