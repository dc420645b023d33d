"""Built-in simulators: currently ``vox``, which simulates voxel bodies with libvox.

Each simulator has its own package. :mod:`.files` and :mod:`.npz`, which read untrusted files, are shared.
"""

from collections.abc import Mapping

from evoframe import Simulator, hookimpl
from evoframe_simulators.vox import FixedRegion, PaletteMaterial, Vox, VoxSettings

__all__ = ["FixedRegion", "PaletteMaterial", "Vox", "VoxSettings", "evoframe_simulators"]


@hookimpl
def evoframe_simulators() -> Mapping[str, type[Simulator]]:
    """Register the simulator ``vox``."""
    return {"vox": Vox}
