"""Built-in simulators: currently ``vox``, voxel actuators on libvox.

Each simulator has its own package. :mod:`.files` and :mod:`.npz`, which read untrusted files, are shared.
"""

from collections.abc import Mapping

from evoframe import Simulator, hookimpl
from evoframe_simulators.vox import FixedRegion, PaletteMaterial, Vox, VoxSettings

__all__ = ["FixedRegion", "PaletteMaterial", "Vox", "VoxSettings", "evoframe_simulators"]


@hookimpl
def evoframe_simulators() -> Mapping[str, type[Simulator]]:
    """Offer ``vox``."""
    return {"vox": Vox}
