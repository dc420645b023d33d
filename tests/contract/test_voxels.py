"""Tests of roles and material codes, which encoders and simulators share."""

from __future__ import annotations

import numpy as np

import evoframe
from evoframe.contract.voxels import CONTRACTILE, CONTROLLER, EMPTY, MORPHOLOGY, PASSIVE
from evoframe_simulators import Vox


def test_empty_is_zero_and_codes_are_unique() -> None:
    assert not np.full((2, 2, 2), EMPTY, np.uint8).any()
    assert len({EMPTY, PASSIVE, CONTRACTILE}) == 3


def test_the_populations_of_the_paper_provide_the_roles_of_its_simulator() -> None:
    config = evoframe.load_config("paper")
    provided = [population.encoder.component.provides for population in config.populations.values()]
    assert provided == [(MORPHOLOGY,), (CONTROLLER,)]
    assert set(config.simulator.component.requires) == {MORPHOLOGY, CONTROLLER}


def test_only_contractile_voxels_move() -> None:
    assert movement(PASSIVE) < 1e-4 * movement(CONTRACTILE)


def movement(code: int) -> float:
    """Return the largest displacement of the points of a bar of one material."""
    cells = np.full((4, 1, 1), code, np.uint8)
    vox = Vox(duration=0.05)
    design = evoframe.Design({MORPHOLOGY: cells, CONTROLLER: np.zeros(cells.shape)})
    [outcome] = vox.simulate([design], evoframe.Record(tracks=vox.tracks))
    return max(float(np.ptp(track, axis=0).max()) for track in outcome.tracks.values())
