"""Files of VoxCAD and the programs around the old Voxelyze engine: VXA, VXC and VXD.

Programs read the same tags by different rules (:mod:`.dialects`). Exported files have the rules of the
paper's engine, the fork ``reconfigurable_organisms``; evosoro's engine ``_voxcad`` limits the size of a voxel
to the nominal one, so that exported bodies expand only in the fork and in evosoro's ``_voxcad_land_water``.
"""

from evoframe_simulators.vox.vxa.assembling import SUFFIXES
from evoframe_simulators.vox.vxa.dialects import DIALECTS
from evoframe_simulators.vox.vxa.file import VxaFile
from evoframe_simulators.vox.vxa.reading import read_vxa
from evoframe_simulators.vox.vxa.writing import left_out, write_vxa

__all__ = ["DIALECTS", "SUFFIXES", "VxaFile", "left_out", "read_vxa", "write_vxa"]
