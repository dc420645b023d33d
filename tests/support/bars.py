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


def torn() -> Design:
    """Return a long bar whose clamped end, far from the tip, is torn apart if ``largest_strain`` is 0.14.

    Contractions start with a jump there, and smoothly near the tip.
    """
    cells, phase = np.ones((40, 1, 2), np.uint8), np.zeros((40, 1, 2))
    cells[1:5], phase[1:5] = 3, 0.25
    cells[30:, :, 1] = 3
    return Design({"morphology": cells, "controller": phase})


def bar(*codes: int) -> Design:
    """Return a row of voxels along x with all offsets 0."""
    cells = np.array(codes, np.uint8).reshape(-1, 1, 1)
    return Design({"morphology": cells, "controller": np.zeros(cells.shape)})
