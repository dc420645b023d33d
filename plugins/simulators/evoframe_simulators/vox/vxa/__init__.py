"""VXA files of VoxCAD and the old Voxelyze engine, interpreted like the fork ``reconfigurable_organisms``.

Files of evosoro are interpreted as in that fork (see :mod:`.vxa.schema`). Evosoro's engine ``_voxcad`` caps
the size of a voxel at 1 + ``GrowthAmplitude`` of the nominal one, so that exported bodies expand only in the
fork and in evosoro's ``_voxcad_land_water``.
"""

from evoframe_simulators.vox.vxa.file import VxaFile
from evoframe_simulators.vox.vxa.reading import read_vxa
from evoframe_simulators.vox.vxa.writing import left_out, write_vxa

__all__ = ["VxaFile", "left_out", "read_vxa", "write_vxa"]
