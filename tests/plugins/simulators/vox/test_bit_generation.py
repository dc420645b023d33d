"""The bits of results: a change of one of them requires a new bit generation."""

from __future__ import annotations

import hashlib

import numpy as np
import pytest

from evoframe import CONTROLLER, MORPHOLOGY, Design, Record, load_config
from evoframe_simulators import Vox

# Generation -> preset -> digest of the positions of all voxels, with every kernel but the scalar one. If one
# changes, raise `Vox.bit_generation`, give the new digests, and name the change in CHANGELOG.md.
DIGESTS: dict[int, dict[str, str]] = {
    2: {"paper": "28e759399c8e3725", "bending": "28280cde6a12cda7", "locomotion": "ce108afc267bed16"},
}
STEPS = {"paper": (0, 9, 19), "bending": (0, 99, 499), "locomotion": (0, 99, 499)}


def woven_design(canvas: tuple[int, int, int]) -> Design:
    """Return a design with voids, both materials and different offsets, all from whole numbers."""
    x, y, z = np.indices(canvas)
    solid = np.where((x + 2 * y + 3 * z) % 5 < 2, 1, 3)
    body = np.where((3 * x + 5 * y + 7 * z) % 11 == 0, 0, solid).astype(np.uint8)
    body[-1, -1, -1] = 3
    return Design({MORPHOLOGY: body, CONTROLLER: ((x + 3 * y + 5 * z) % 16 - 8) / 16})


@pytest.mark.parametrize("preset", STEPS)
def test_a_generation_has_these_bits(monkeypatch: pytest.MonkeyPatch, preset: str) -> None:
    monkeypatch.setenv("EVOFRAME_KERNEL", "generic")
    simulator = load_config(preset).simulator.component
    record = Record(("voxels",), samples=STEPS[preset])
    [outcome] = simulator.simulate([woven_design((6, 5, 4))], record)
    assert outcome.diverged_at is None
    found = hashlib.sha256(outcome.tracks["voxels"].astype("<f8").tobytes()).hexdigest()
    assert found[:16] == DIGESTS[Vox.bit_generation][preset]
