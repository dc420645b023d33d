"""Built-in simulators: ``vox``, which simulates voxel bodies with libvox, and ``functions``, without physics.

Each simulator has its own package. :mod:`.files` and :mod:`.npz`, which read untrusted files, are shared.
"""

from collections.abc import Mapping

from evoframe import Simulator, hookimpl
from evoframe_simulators.functions import Functions
from evoframe_simulators.vox import FixedRegion, PaletteMaterial, Vox, VoxSettings

__all__ = ["FixedRegion", "Functions", "PaletteMaterial", "Vox", "VoxSettings", "evoframe_simulators"]


@hookimpl
def evoframe_simulators() -> Mapping[str, type[Simulator]]:
    """Register the simulators ``functions`` and ``vox``."""
    return {"functions": Functions, "vox": Vox}
