"""Small bodies and materials for the tests of ``vox``."""

from __future__ import annotations

from typing import Any

import numpy as np

from evoframe import Design
from evoframe_simulators import PaletteMaterial


def soft(code: int, **changed: Any) -> PaletteMaterial:
    """Return the paper's passive material with a code and changes."""
    options: dict[str, Any] = {
        "youngs_modulus": 5e6,
        "poisson_ratio": 0.35,
        "density": 1e6,
        "expansion_coefficient": 0.0,
    }
    return PaletteMaterial(code=code, **{**options, **changed})


def bar(*codes: int) -> Design:
    """Return a row of voxels along x with all offsets 0."""
    cells = np.array(codes, np.uint8).reshape(-1, 1, 1)
    return Design({"morphology": cells, "controller": np.zeros(cells.shape)})
