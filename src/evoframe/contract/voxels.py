"""Names of roles and codes of materials that encoders and simulators of voxel bodies share."""

from __future__ import annotations

__all__ = ["CONTRACTILE", "CONTROLLER", "EMPTY", "MORPHOLOGY", "PASSIVE"]

MORPHOLOGY = "morphology"
"""Role of a body: ``uint8[X, Y, Z]``, material codes."""

CONTROLLER = "controller"
"""Role of a controller: ``float64[X, Y, Z]``, phase offset of each voxel."""

EMPTY, PASSIVE, CONTRACTILE = 0, 1, 3
"""Material codes (the paper's authors use 3, not 2, as input of the controller network and in VXA files)."""
