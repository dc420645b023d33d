"""Tests of the units of what a run reports."""

from __future__ import annotations

from evoframe import load_config
from evoframe.contract.units import fitness_unit_of


def test_fitness_has_the_unit_of_the_scores() -> None:
    config = load_config("quick", overrides=["aggregator=max"])
    assert [fitness_unit_of(config, role) for role in config.populations] == ["m", "m"]


def test_a_credit_can_have_another_unit() -> None:
    config = load_config("quick", overrides=["populations.controller.aggregator=rank"])
    assert [fitness_unit_of(config, role) for role in config.populations] == ["m", ""]
