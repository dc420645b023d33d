"""What encoders and simulators of voxel bodies agree on: the names of roles and the codes of materials."""

from __future__ import annotations

__all__ = ["CONTRACTILE", "CONTROLLER", "EMPTY", "MORPHOLOGY", "PASSIVE"]

MORPHOLOGY = "morphology"
"""The role of a body: ``uint8[X, Y, Z]``, material codes."""

CONTROLLER = "controller"
"""The role of a controller: ``float64[X, Y, Z]``, the phase offset of each voxel."""

EMPTY, PASSIVE, CONTRACTILE = 0, 1, 3
"""Material codes (3, not 2, is what the authors feed to the controller network and write to VXA files)."""
