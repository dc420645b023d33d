"""The simulator ``vox``, which runs the voxel solver libvox.

From the bottom up: :mod:`.limits`, :mod:`.materials` and :mod:`.regions` define the values of options,
:mod:`.settings` collects all options, :mod:`.models` translates them for the solver, :mod:`.simulation`
simulates batches, :mod:`.geometry`, :mod:`.verification` and :mod:`.vxa` build on these, and
:mod:`.simulator` contains the component that the plugin offers to the core.
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
