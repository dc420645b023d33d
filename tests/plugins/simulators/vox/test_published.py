"""Published bodies, and random controllers for robustness."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, strategies as st

from evoframe import Design, InputError, measure_robustness
from evoframe_simulators import Vox

PAPER = Path(__file__).parents[3] / "data" / "paper_preset.npz"


def test_bodies_equal_the_inputs_of_the_authors_engine() -> None:
    with np.load(PAPER) as data:
        given = {
            label.removeprefix("published ").removesuffix(", zero offsets"): material
            for label, material in zip(data["label"].tolist(), data["material"], strict=True)
            if label.startswith("published ") and label.endswith(", zero offsets")
        }
    bodies = dict(Vox().published())
    assert sorted(bodies) == sorted(given) == ["AFPO", "HyperNEAT", "NEAT"]
    for label, design in bodies.items():
        assert np.array_equal(design.roles["morphology"], given[label])
        assert not design.roles["controller"].any()


def test_medians_with_random_offsets_agree_with_the_paper() -> None:
    """Compare with docs/experiment.md, "The simulation of a pair", which used 60 other sets of offsets."""
    found = measure_robustness(published=True, controllers=60)
    medians = dict(
        zip([body.label for body in found.setting.bodies], np.median(found.scores, axis=0), strict=True)
    )
    expected = {"AFPO": 0.00139, "NEAT": 0.00259, "HyperNEAT": 0.00255}
    assert medians == {name: pytest.approx(median, rel=0.25) for name, median in expected.items()}
    assert medians["AFPO"] < min(medians["NEAT"], medians["HyperNEAT"])
    assert found.diverged == ()


@given(st.integers(0, 2**32), st.tuples(*[st.integers(1, 6)] * 3))
def test_offsets_of_every_cell_are_within_two_cycles(seed: int, canvas: tuple[int, int, int]) -> None:
    body = Design({"morphology": np.zeros(canvas, np.uint8), "controller": np.zeros(canvas)})
    full = body.with_role("morphology", np.full(canvas, 3, np.uint8))
    drawn, same = (
        Vox().random_controller(design, np.random.default_rng(seed)).roles["controller"]
        for design in (body, full)
    )
    assert drawn.shape == canvas
    assert drawn.dtype == np.float64
    assert (np.abs(drawn) <= 2 * math.pi).all()
    assert np.array_equal(drawn, same)


def test_offsets_are_uniformly_distributed() -> None:
    canvas = (20, 20, 20)
    body = Design({"morphology": np.ones(canvas, np.uint8), "controller": np.zeros(canvas)})
    offsets = Vox().random_controller(body, np.random.default_rng(1)).roles["controller"]
    counts, _ = np.histogram(offsets, bins=8, range=(-2 * math.pi, 2 * math.pi))
    assert counts == pytest.approx(np.full(8, 1000), abs=150)


def test_a_design_without_a_body_is_rejected() -> None:
    flat = Design({"morphology": np.ones((3, 3), np.uint8), "controller": np.zeros((3, 3))})
    with pytest.raises(InputError, match=r"uint8\[3, 3\]") as caught:
        Vox().random_controller(flat, np.random.default_rng(1))
    assert caught.value.key == "morphology"
