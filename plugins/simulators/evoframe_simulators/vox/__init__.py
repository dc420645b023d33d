"""The simulator ``vox``: the Python face of the voxel solver libvox.

From the bottom up: :mod:`.limits`, :mod:`.materials` and :mod:`.regions` say what an option may be,
:mod:`.settings` has all options as one value, :mod:`.models` gives the solver's view of them,
:mod:`.simulation` simulates batches, :mod:`.geometry`, :mod:`.verification` and :mod:`.vxa` stand on that,
and :mod:`.simulator` has the component that is offered to the core.
"""

from evoframe_simulators.vox.materials import PaletteMaterial
from evoframe_simulators.vox.models import clocks_of, model_of, possible_clocks
from evoframe_simulators.vox.regions import FixedRegion, fixed_mask
from evoframe_simulators.vox.settings import VoxSettings, materials_of
from evoframe_simulators.vox.simulation import simulate
from evoframe_simulators.vox.simulator import Vox

__all__ = [
    "FixedRegion",
    "PaletteMaterial",
    "Vox",
    "VoxSettings",
    "clocks_of",
    "fixed_mask",
    "materials_of",
    "model_of",
    "possible_clocks",
    "simulate",
]
