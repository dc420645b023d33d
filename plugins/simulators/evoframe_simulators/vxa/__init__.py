"""VXA: files of VoxCAD and the old Voxelyze engine, as ``reconfigurable_organisms`` and evosoro use them."""

from evoframe_simulators.vxa.file import VxaFile
from evoframe_simulators.vxa.reading import read_vxa
from evoframe_simulators.vxa.writing import left_out, write_vxa

__all__ = ["VxaFile", "left_out", "read_vxa", "write_vxa"]
