"""Batches of designs: each as if it were alone, whatever the others are."""

from __future__ import annotations

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
def test_a_batch_of_many_canvases_is_its_members_in_order(rows: list[list[int]]) -> None:
    designs, record = [bar(*row) for row in rows], Record(("tip", "voxels"), every=0.01)
    together = simulate(VoxSettings(), designs, record)
    alone = [simulate(VoxSettings(), [design], record)[0] for design in designs]
    assert len(together) == len(designs)
    assert all(same_outcome(one, other) for one, other in zip(together, alone, strict=True))


def test_settings_simulate_as_the_simulator_that_has_them() -> None:
    [own], [offered] = simulate(VoxSettings(), [bar(1, 3)], PAPER), Vox().simulate([bar(1, 3)], PAPER)
    assert same_outcome(own, offered)


def test_a_palette_may_be_the_built_in_materials() -> None:
    palette = (soft(1), soft(3, expansion_coefficient=0.01))
    record = Record(("tip", "energy"))
    [own], [built_in] = (v.simulate([bar(1, 3, 3)], record) for v in (Vox(palette=palette), Vox()))
    for track in record.tracks:
        assert (own.tracks[track] == built_in.tracks[track]).all()


def test_only_the_codes_of_a_palette_are_simulated() -> None:
    vox = Vox(palette=(soft(200), soft(7)))
    assert vox.simulate([bar(200, 7)], Record(("tip",)))[0].diverged_at is None
    with pytest.raises(InputError, match=r"^material has the code 1; codes: 0 empty, 7, 200$"):
        vox.simulate([bar(1, 7)], Record(("tip",)))


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


def test_an_empty_body_counts_as_diverged_before_the_first_step() -> None:
    empty = Design({"morphology": np.zeros((4, 3, 3), np.uint8), "controller": np.zeros((4, 3, 3))})
    [outcome] = Vox().simulate([empty], PAPER)
    assert outcome.diverged_at == 0
    assert outcome.tracks["tip"].shape == (0, 3)


@pytest.mark.parametrize(
    ("roles", "message"),
    [
        (
            {"morphology": np.ones((2, 2), np.uint8)},
            r"morphology is uint8\[2, 2\]; expected uint8\[X, Y, Z\]",
        ),
        ({"morphology": np.ones((4, 3, 3))}, "morphology is float64"),
        (
            {"controller": np.zeros((3, 3, 3))},
            r"controller is float64\[3, 3, 3\]; expected float64\[4, 3, 3\]",
        ),
        ({"morphology": np.full((4, 3, 3), 7, np.uint8)}, "material has the code 7; codes: 0 empty"),
        ({"morphology": np.full((4, 3, 3), 3, np.uint8), "controller": np.full((4, 3, 3), np.nan)}, "phase"),
    ],
)
def test_what_is_no_design_is_refused(roles: dict[str, Any], message: str) -> None:
    body = Design({"morphology": np.ones((4, 3, 3), np.uint8), "controller": np.ones((4, 3, 3))})
    with pytest.raises(InputError, match=message):
        Vox().simulate([Design({**body.roles, **roles})], PAPER)
