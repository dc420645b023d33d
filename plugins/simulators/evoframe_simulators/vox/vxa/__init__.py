"""VXA: files of VoxCAD and the old Voxelyze engine, as the fork ``reconfigurable_organisms`` reads them.

Evosoro's files are read as that fork would read them (see :mod:`.vxa.schema`). Of its own
engines ``_voxcad`` caps the size of a voxel at 1 + ``GrowthAmplitude`` of the nominal one, so that what is
written here expands only in the fork and in ``_voxcad_land_water``.
"""

from evoframe_simulators.vox.vxa.file import VxaFile
from evoframe_simulators.vox.vxa.reading import read_vxa
from evoframe_simulators.vox.vxa.writing import left_out, write_vxa

__all__ = ["VxaFile", "left_out", "read_vxa", "write_vxa"]
