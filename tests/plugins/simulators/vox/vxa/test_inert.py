"""Sections that are written although all their features are off: the schema accepts all of them."""

from __future__ import annotations

from collections.abc import Mapping

import pytest

from evoframe_simulators.vox.vxa import inert
from evoframe_simulators.vox.vxa.schema import VXA, Role, Schema


def section(*tags: str) -> Schema:
    schema = VXA
    for tag in tags:
        inner = schema[tag]
        assert isinstance(inner, Mapping)
        schema = inner
    return schema


def assert_off(values: Mapping[str, float], schema: Schema) -> None:
    for tag, value in values.items():
        role = schema[tag]
        assert role is Role.IDLE or value in (0, role), tag


@pytest.mark.parametrize(
    ("values", "schema"),
    [
        (inert.FEATURES, section("Simulator", "Features")),
        (inert.CHANGES, section("Simulator")),
        (inert.GROWTH, section("Environment")),
        (inert.TASKS, section("Environment")),
    ],
)
def test_values_mean_off(values: Mapping[str, float], schema: Schema) -> None:
    assert values
    assert_off(values, schema)


@pytest.mark.parametrize("controller", inert.CONTROLLERS)
def test_controllers_are_off(controller: str) -> None:
    if section("Environment")[controller] is not Role.IDLE:
        assert_off(inert.CONTROLLERS[controller], section("Environment", controller))


def test_the_unused_material_is_passive() -> None:
    assert inert.UNUSED.expansion_coefficient == 0.0
