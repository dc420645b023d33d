"""Limits and validators: the ends of a range are in it, and what is refused is named."""

from __future__ import annotations

from typing import Any

import attrs
import numpy as np
import pytest
from hypothesis import given, strategies as st

import evoframe_libvox as libvox
from evoframe_simulators import VoxSettings
from evoframe_simulators.vox import limits


def holder(validator: Any) -> Any:
    """Return a class with one validated value."""
    return attrs.make_class("Holder", {"value": attrs.field(validator=validator)})


@given(ends=st.tuples(st.floats(-1e9, 1e9), st.floats(-1e9, 1e9)).map(sorted), value=st.floats(-2e9, 2e9))
def test_a_value_is_accepted_if_and_only_if_it_is_within_its_range(ends: list[float], value: float) -> None:
    least, most = ends
    within = holder(limits.within(least, most))
    assert within(least).value == least
    assert within(most).value == most
    if least <= value <= most:
        assert within(value).value == value
    else:
        with pytest.raises(ValueError, match="'value' must be"):
            within(value)


@pytest.mark.parametrize(
    ("validator", "accepted", "refused"),
    [
        (limits.POSITIVE, [5e-324, 1.0], [0.0, -1.0, np.nan]),
        (limits.NOT_NEGATIVE, [0.0, 1.0], [-5e-324, np.nan]),
        (limits.POISSON_RATIO, [0.0, 0.4999], [-1e-9, 0.5, np.nan]),
        (limits.check_finite, [(0.0, 1e308)], [(np.inf,), (0.0, np.nan)]),
        (limits.check_distinct, [(), ("x", "y")], [("x", "y", "x")]),
        (limits.check_printable, ["", "Größe é"], ["a\nb", "\x07"]),
    ],
)
def test_validators(validator: Any, accepted: list[Any], refused: list[Any]) -> None:
    holding = holder(validator)
    for value in accepted:
        assert holding(value).value == value
    for value in refused:
        with pytest.raises(ValueError, match="'value' must"):
            holding(value)


@pytest.mark.parametrize(
    ("option", "ends", "beyond"),
    [
        ("substeps", (1, limits.MOST_SUBSTEPS), (0, limits.MOST_SUBSTEPS + 1)),
        ("floor_slope", (-89.0, 89.0), (-89.001, 89.001)),
        ("collision_envelope", (1.0, 2.0), (0.999, 2.001)),
        ("collision_horizon", (1.0, 4.0), (0.999, 4.001)),
    ],
)
def test_the_solver_has_the_same_ends(option: str, ends: tuple[Any, ...], beyond: tuple[Any, ...]) -> None:
    def model(value: Any) -> libvox.Model:
        values = {option: value, "voxel_size": 0.05, "duration": 0.07}
        solver = libvox.Settings(**values, temperature_amplitude=1.0, period=1.0)
        return libvox.Model(
            (1, 1, 1), {1: libvox.Material(5e6, 0.3, 1e6, 0.0)}, solver, np.zeros((1, 1, 1), np.uint8)
        )

    for value in ends:
        assert getattr(VoxSettings(**{option: value}), option) == value
        assert model(value)
    for value in beyond:
        with pytest.raises(ValueError, match=option):
            VoxSettings(**{option: value})
        with pytest.raises(ValueError, match=option):
            model(value)


@given(st.floats(0, limits.MOST_CYCLES))
def test_offsets_within_the_limit_have_a_fraction_in_single_precision(cycles: float) -> None:
    assert np.spacing(np.float32(cycles)) < 0.1
