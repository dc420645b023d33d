"""Names of configurations."""

from __future__ import annotations

import pytest
from hypothesis import given, strategies as st

from evoframe import load_config
from evoframe.config.labels import label_of
from evoframe.config.layers import Layer


@pytest.mark.parametrize(
    ("overrides", "label"),
    [
        ([], "paper"),
        (["aggregator=hm", "collaboration.n=5"], "paper-hm-n5"),
        (["aggregator=gm", "aggregator=hm"], "paper-hm"),
        (["run.seed=3", "executor.workers=2"], "paper"),
        (["run.generations=3", "collaboration=worst"], "paper-generations3-worst"),
        (["populations.controller.size=10"], "paper-size10"),
        (["simulator.self_collision=false"], "paper-self_collisionFalse"),
        (["aggregator={name='wm', weights=[0.75, 0.25]}"], "paper-wm-weights-0.75-0.25"),
        (
            [f"populations.controller.evolver.node_{name}=0.1" for name in ("add", "delete")] * 9,
            "paper-node_add0.1-node_delete0.1",
        ),
        (
            [f"simulator.{name}=0.1" for name in ("largest_strain", "slow_damping", "bond_damping", "ramp")],
            "paper",
        ),
    ],
)
def test_a_label_has_what_was_set(overrides: list[str], label: str) -> None:
    assert load_config("paper", overrides=overrides).label == label


@given(st.text(min_size=1), st.text() | st.integers() | st.lists(st.floats()))
def test_a_label_is_a_short_name_of_a_directory(key: str, value: object) -> None:
    label = label_of("folder/mine.toml", [Layer("--set", {"simulator": {key: value}})])
    assert label.startswith("mine")
    assert "/" not in label
    assert len(label) <= 60
