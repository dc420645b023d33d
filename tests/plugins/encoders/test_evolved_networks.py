"""The encoders with networks evolved by neat-python."""

import math
from typing import Any

import numpy as np
import pytest

from evoframe import Design
from evoframe_encoders import CppnController, CppnMorphology
from evoframe_evolvers import Neat, RandomSearch

EVOLVERS = [Neat(node_add=0.8, node_delete=0.05), RandomSearch(mutations=40, node_delete=0.05)]


def networks(evolver: Any, inputs: int, outputs: int, turns: int) -> list[Any]:
    rng = np.random.default_rng(0)
    run = evolver.start(inputs, outputs, 25, rng)
    found = []
    for _ in range(turns):
        genomes = run.ask()
        run.tell(rng.normal(size=25), {})
        found += [run.express(genome) for genome in genomes]
    return found


@pytest.mark.parametrize("evolver", EVOLVERS)
def test_every_genome_gives_a_body_and_a_controller(evolver: Any) -> None:
    bodies, controllers = networks(evolver, 3, 2, 8), networks(evolver, 4, 1, 8)
    seen = set()
    for draw_body, draw_offsets in zip(bodies, controllers, strict=True):
        body = CppnMorphology().decode(draw_body, Design())
        roles = CppnController().decode(draw_offsets, body).roles
        codes, offsets = roles["morphology"], roles["controller"]
        assert (codes[[0, -1]] == 1).all()
        assert set(np.unique(codes)) <= {0, 1, 3}
        assert np.isfinite(offsets).all()
        assert (np.abs(offsets) <= 2 * math.pi).all()
        seen.add((codes.tobytes(), offsets.tobytes()))
    assert len(seen) > len(bodies) // 4  # many genomes give full or empty bodies, but not all of them


@pytest.mark.parametrize("evolver", EVOLVERS)
def test_a_body_does_not_depend_on_the_number_of_voxels_evaluated_at_once(evolver: Any) -> None:
    for network in networks(evolver, 3, 2, 2):
        together = CppnMorphology().decode(network, Design()).roles["morphology"]
        one_by_one = CppnMorphology().decode(_apart(network), Design()).roles["morphology"]
        assert (together == one_by_one).all()


def _apart(network: Any) -> Any:
    return lambda points: np.concatenate([network(point[None]) for point in points])
