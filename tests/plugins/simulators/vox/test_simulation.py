"""Simulation of batches of designs: the same outcomes as one design at a time."""

from __future__ import annotations

import re
from typing import Any

import numpy as np
import pytest
from bars import bar, soft
from hypothesis import given, settings, strategies as st

from evoframe import Design, InputError, Record
from evoframe.testing.laws import same_outcome
from evoframe_simulators import Vox, VoxSettings
from evoframe_simulators.vox.simulation import simulate

PAPER = Record(("tip",), every=0.01, samples=(0, 5))

codes = st.lists(st.sampled_from([0, 1, 3]), min_size=1, max_size=4)


@settings(max_examples=25)
@given(rows=st.lists(codes, max_size=5))
def test_a_batch_with_many_canvases_has_the_outcomes_of_its_designs_in_order(rows: list[list[int]]) -> None:
    designs, record = [bar(*row) for row in rows], Record(("tip", "voxels"), every=0.01)
    together = simulate(VoxSettings(), designs, record)
    alone = [simulate(VoxSettings(), [design], record)[0] for design in designs]
    assert len(together) == len(designs)
    assert all(same_outcome(one, other) for one, other in zip(together, alone, strict=True))


def test_settings_and_a_simulator_with_these_settings_agree() -> None:
    [own], [offered] = simulate(VoxSettings(), [bar(1, 3)], PAPER), Vox().simulate([bar(1, 3)], PAPER)
    assert same_outcome(own, offered)


def test_a_palette_can_reproduce_the_built_in_materials() -> None:
    palette = (soft(1), soft(3, expansion_coefficient=0.01))
    record = Record(("tip", "energy"))
    [own], [built_in] = (v.simulate([bar(1, 3, 3)], record) for v in (Vox(palette=palette), Vox()))
    for track in record.tracks:
        assert (own.tracks[track] == built_in.tracks[track]).all()


def test_only_the_codes_of_a_palette_are_simulated() -> None:
    vox = Vox(palette=(soft(200), soft(7)))
    assert vox.simulate([bar(200, 7)], Record(("tip",)))[0].diverged_at is None
    with pytest.raises(InputError, match=r"code 1; .* 0 empty, 7, 200$") as caught:
        vox.simulate([bar(1, 7)], Record(("tip",)))
    assert caught.value.key == "material"


def test_bodies_of_one_batch_may_have_different_time_steps() -> None:
    vox = Vox(palette=(soft(1), soft(2, youngs_modulus=5e7, expansion_coefficient=0.01)))
    bodies = [bar(1, 1), bar(2, 2), bar(1, 2), bar(2, 1)]
    for record in (Record(("tip",)), Record(("tip",), every=0.02, samples=(0, 1), initial=True)):
        together = vox.simulate(bodies, record)
        assert len({outcome.times[-1] for outcome in together}) == 3
        for body, outcome in zip(bodies, together, strict=True):
            [alone] = vox.simulate([body], record)
            assert (alone.steps == outcome.steps).all()
            assert (alone.tracks["tip"] == outcome.tracks["tip"]).all()


def test_an_empty_body_counts_as_diverged_at_step_0() -> None:
    empty = Design({"morphology": np.zeros((4, 3, 3), np.uint8), "controller": np.zeros((4, 3, 3))})
    [outcome] = Vox().simulate([empty], PAPER)
    assert outcome.diverged_at == 0
    assert outcome.tracks["tip"].shape == (0, 3)


@pytest.mark.parametrize(
    ("roles", "key", "problem"),
    [
        (
            {"morphology": np.ones((2, 2), np.uint8)},
            "morphology",
            r" uint8\[2, 2\], .* uint8\[X, Y, Z\]",
        ),
        ({"morphology": np.ones((4, 3, 3))}, "morphology", "float64"),
        (
            {"controller": np.zeros((3, 3, 3))},
            "controller",
            r" float64\[3, 3, 3\], .* float64\[4, 3, 3\]",
        ),
        ({"morphology": np.full((4, 3, 3), 7, np.uint8)}, "material", "code 7; .* 0 empty"),
        (
            {"morphology": np.full((4, 3, 3), 3, np.uint8), "controller": np.full((4, 3, 3), np.nan)},
            "",
            "phase",
        ),
    ],
)
def test_an_invalid_design_is_rejected(roles: dict[str, Any], key: str, problem: str) -> None:
    body = Design({"morphology": np.ones((4, 3, 3), np.uint8), "controller": np.ones((4, 3, 3))})
    with pytest.raises(InputError) as caught:
        Vox().simulate([Design({**body.roles, **roles})], PAPER)
    assert caught.value.key == key
    assert re.search(problem, caught.value.problem)
