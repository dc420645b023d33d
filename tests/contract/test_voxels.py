"""Roles and codes: encoders and simulators mean the same by them."""

from __future__ import annotations

import numpy as np

import evoframe
from evoframe.contract.voxels import CONTRACTILE, CONTROLLER, EMPTY, MORPHOLOGY, PASSIVE
from evoframe_simulators import Vox


def test_nothing_is_what_an_array_is_made_of() -> None:
    assert not np.full((2, 2, 2), EMPTY, np.uint8).any()
    assert len({EMPTY, PASSIVE, CONTRACTILE}) == 3


def test_the_populations_of_the_paper_give_what_its_simulator_needs() -> None:
    config = evoframe.load_config("paper")
    provided = [population.encoder.component.provides for population in config.populations.values()]
    assert provided == [(MORPHOLOGY,), (CONTROLLER,)]
    assert set(config.simulator.component.requires) == {MORPHOLOGY, CONTROLLER}


def test_contractile_voxels_move_and_passive_ones_rest() -> None:
    assert movement(PASSIVE) < 1e-4 * movement(CONTRACTILE)


def movement(code: int) -> float:
    """Return how far the points of a bar of one material come from where they were."""
    cells = np.full((4, 1, 1), code, np.uint8)
    vox = Vox(duration=0.05)
    design = evoframe.Design({MORPHOLOGY: cells, CONTROLLER: np.zeros(cells.shape)})
    [outcome] = vox.simulate([design], evoframe.Record(tracks=vox.tracks))
    return max(float(np.ptp(track, axis=0).max()) for track in outcome.tracks.values())
