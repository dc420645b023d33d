"""The built-in simulators: so far ``vox``, voxel actuators on libvox.

Each simulator has a room of its own, beside which stands what all of them need: :mod:`.files` and :mod:`.npz`
read files from anyone.
"""

from collections.abc import Mapping

from evoframe import Simulator, hookimpl
from evoframe_simulators.vox import FixedRegion, PaletteMaterial, Vox, VoxSettings

__all__ = ["FixedRegion", "PaletteMaterial", "Vox", "VoxSettings", "evoframe_simulators"]


@hookimpl
def evoframe_simulators() -> Mapping[str, type[Simulator]]:
    """Offer ``vox``."""
    return {"vox": Vox}
