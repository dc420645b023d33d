"""Variants to which `evoframe verify` compares a design."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import attrs
import numpy as np
import pytest
from bars import bar, soft
from hypothesis import given, strategies as st

from evoframe import Design, InputError, Record, Variant
from evoframe_simulators import Vox, VoxSettings
from evoframe_simulators.vox.verification import changes

PAPER = Record(("tip",), every=0.01, samples=(0, 5))
CHANGES = ["contraction off", "self collision off", "half the time step", "twice the duration"]
JITTERED = "offsets jittered by 1 %"


def published(index: int = 3) -> Design:
    with np.load(Path(__file__).parents[3] / "data" / "paper_preset.npz") as arrays:
        return Design({"morphology": arrays["material"][index], "controller": arrays["phase_cycles"][index]})


def named(variants: list[Variant], name: str) -> Variant:
    [found] = [variant for variant in variants if variant.name == name]
    return found


def outcome(variant: Variant) -> Any:
    variant.simulator.check(variant.record)
    [simulated] = variant.simulator.simulate([variant.design], variant.record)
    return simulated


@pytest.fixture(scope="module")
def variants() -> list[Variant]:
    return Vox().variants(published(), PAPER)


def test_variants_are_the_four_changes_and_ten_draws_of_jitter(variants: list[Variant]) -> None:
    assert [variant.name for variant in variants] == [*CHANGES, *[JITTERED] * 10]


def test_each_changes_one_thing(variants: list[Variant]) -> None:
    base = Vox()
    changed = {
        variant.name: {
            field.name
            for field in attrs.fields(Vox)
            if getattr(variant.simulator, field.name) != getattr(base, field.name)
        }
        for variant in variants
    }
    assert changed == {
        "contraction off": {"expansion_coefficient"},
        "self collision off": {"self_collision"},
        "half the time step": {"substeps", "step_limit"},
        "twice the duration": {"duration", "step_limit"},
        JITTERED: set(),
    }


def test_without_contraction_only_passive_motion_remains(variants: list[Variant]) -> None:
    still = outcome(named(variants, "contraction off"))
    assert still.tracks["tip"][1, 2] - still.tracks["tip"][0, 2] == pytest.approx(0.0019527, abs=5e-8)


def test_all_materials_of_a_palette_stop_contracting() -> None:
    vox = Vox(palette=(soft(1, expansion_coefficient=0.01), soft(2, expansion_coefficient=-0.01)))
    body = bar(1, 2).with_role("controller", np.ones((2, 1, 1)))
    still = named(vox.variants(body, PAPER), "contraction off").simulator
    assert isinstance(still, Vox)
    assert [material.expansion_coefficient for material in still.palette] == [0.0, 0.0]


def test_half_the_time_step_has_the_same_instants(variants: list[Variant]) -> None:
    [whole] = Vox().simulate([published()], PAPER)
    half = outcome(named(variants, "half the time step"))
    assert half.times == pytest.approx(whole.times, rel=1e-14)
    assert (half.steps == 2 * whole.steps).all()


def test_half_the_time_step_is_omitted_if_it_cannot_be_divided() -> None:
    names = [variant.name for variant in Vox(substeps=501).variants(published(), PAPER)]
    assert "half the time step" not in names
    assert set(names) == {*CHANGES, JITTERED} - {"half the time step"}


durations = st.floats(0.03, 0.3)
intervals = st.floats(0.0, 0.02)


@given(duration=durations, every=intervals, initial=st.booleans(), k=st.integers(1, 3), data=st.data())
def test_twice_the_duration_is_sampled_at_twice_the_instants(
    duration: float, every: float, initial: bool, k: int, data: st.DataObject
) -> None:
    vox = Vox(duration=duration, substeps=k)
    body = bar(1, 1)
    taken = len(vox.simulate([body], Record(("tip",), every=every))[0].steps)
    samples = tuple(sorted(data.draw(st.sets(st.integers(0, taken - 1), min_size=1))))
    record = Record(("tip",), every=every, samples=samples, initial=initial)
    [once] = vox.simulate([body], record)
    twice = outcome(named(vox.variants(body, record), "twice the duration"))
    last = (int(2 * duration / (k * once.times[-1] / once.steps[-1])) + 1) * k
    assert twice.steps.tolist() == [min(2 * step, last) for step in once.steps.tolist()]
    assert max(2 * once.steps) - last <= k  # only the very last step may lack its double


def test_the_paper_is_sampled_at_exactly_twice_its_instants(variants: list[Variant]) -> None:
    longer = outcome(named(variants, "twice the duration"))
    assert longer.steps.tolist() == [2, 42]


def test_a_record_of_all_samples_does_not_change() -> None:
    everything = Record(("tip",), every=0.01)
    assert named(Vox().variants(published(), everything), "twice the duration").record == everything


def test_a_record_with_a_required_time_remains_acceptable() -> None:
    record = attrs.evolve(PAPER, until=0.02)
    Vox().check(record)
    variant = named(Vox().variants(published(), record), "twice the duration")
    variant.simulator.check(variant.record)


def test_jitter_is_within_a_percent_and_reproducible() -> None:
    draws, repeated = (
        [v.design.roles["controller"] for v in Vox().variants(published(4), PAPER) if v.name == JITTERED]
        for _ in range(2)
    )
    offsets = published(4).roles["controller"]
    acting = offsets != 0
    for draw, same in zip(draws, repeated, strict=True):
        assert (draw == same).all()
        ratio = draw[acting] / offsets[acting] - 1
        assert 0.009 < np.abs(ratio).max() <= 0.01 + 1e-15
        assert abs(ratio.mean()) < 0.002
    assert len({draw.tobytes() for draw in draws}) == 10


def test_an_empty_body_has_variants_too() -> None:
    empty = Design({"morphology": np.zeros((2, 1, 1), np.uint8), "controller": np.zeros((2, 1, 1))})
    assert {outcome(variant).diverged_at for variant in Vox().variants(empty, PAPER)} == {0}


@pytest.mark.parametrize(
    ("morphology", "key", "problem"),
    [
        (np.ones(4, np.uint8), "morphology", r"uint8\[4\]"),
        (np.full((2, 1, 1), 9, np.uint8), "", "material code"),
    ],
)
def test_an_invalid_design_has_no_variants(morphology: Any, key: str, problem: str) -> None:
    design = Design({"morphology": morphology, "controller": np.zeros(morphology.shape)})
    with pytest.raises(InputError, match=problem) as caught:
        Vox().variants(design, PAPER)
    assert caught.value.key == key


def test_changed_settings_have_the_class_of_the_original() -> None:
    for kind in (VoxSettings, Vox):
        given = kind(frequency=2.0)
        found = [settings for _, settings, _, _ in changes(given, bar(1, 3), PAPER)]
        assert {type(settings) for settings in found} == {kind}
        assert {settings.frequency for settings in found} == {2.0}
