"""Limits and validators of options."""

from __future__ import annotations

import re
from typing import Any

import attrs
import numpy as np
import pytest
from bars import soft
from hypothesis import given, strategies as st

import evoframe_libvox as libvox
from evoframe_simulators import VoxSettings
from evoframe_simulators.vox import limits

PROPERTIES = (
    *("youngs_modulus", "poisson_ratio", "density", "expansion_coefficient"),
    *("static_friction", "dynamic_friction"),
)
SETTINGS = (
    *("duration", "voxel_size", "time_step_fraction", "substeps", "step_limit"),
    *("start_time", "ramp", "gravity", "floor_slope", "fluid_drag"),
    *("smallest_size", "largest_size", "falling_code"),
    *("collision_envelope", "collision_horizon", "collision_damping", "contact_damping"),
    *("bond_damping", "slow_damping", "largest_strain", "largest_distance"),
)


def holder(validator: Any) -> Any:
    """Return a class with one validated value."""
    return attrs.make_class("Holder", {"value": attrs.field(validator=validator)})


@st.composite
def spans(draw: st.DrawFn) -> libvox.Range:
    lower, upper = draw(st.floats(-1e9, 0.0) | st.just(-np.inf)), draw(st.floats(0.0, 1e9) | st.just(np.inf))
    return libvox.Range(
        lower=lower,
        upper=upper,
        lower_included=bool(np.isfinite(lower)) and draw(st.booleans()),
        upper_included=bool(np.isfinite(upper)) and draw(st.booleans()),
        whole=draw(st.booleans()),
        words="in (LOWER, UPPER)",
    )


@given(span=spans(), data=st.data())
def test_a_value_is_accepted_if_and_only_if_it_is_in_the_range(
    span: libvox.Range, data: st.DataObject
) -> None:
    holding = holder(limits.InRange(span))
    value = data.draw(st.floats() | st.integers() | st.sampled_from([span.lower, span.upper]))
    if value in span:
        assert holding(value).value == value
    else:
        with pytest.raises(ValueError, match=r"^'value' .*in \(LOWER, UPPER\): "):
            holding(value)


@pytest.mark.parametrize(
    ("validator", "accepted", "rejected"),
    [
        (limits.VALID_SETTING["duration"], [5e-324, 1e9], [0.0, -1.0, np.nan, 1.1e9]),
        (limits.VALID_SETTING["fluid_drag"], [0.0, 1e308], [-5e-324, np.nan, np.inf]),
        (limits.VALID_SETTING["step_limit"], [1, 2**60], [0, 1.5]),
        (limits.VALID_PROPERTY["poisson_ratio"], [0.0, 0.5], [-1e-9, 0.501, np.nan]),
        (limits.check_finite, [(0.0, 1e308)], [(np.inf,), (0.0, np.nan)]),
        (limits.check_distinct, [(), ("x", "y")], [("x", "y", "x")]),
        (limits.check_printable, ["", "Größe é"], ["a\nb", "\x07"]),
    ],
)
def test_validators(validator: Any, accepted: list[Any], rejected: list[Any]) -> None:
    holding = holder(validator)
    for value in accepted:
        assert holding(value).value == value
    for value in rejected:
        with pytest.raises(ValueError, match="'value'"):
            holding(value)


def ends_of(span: libvox.Range) -> tuple[list[Any], list[Any]]:
    """Return numbers at the bounds of a range, and the nearest ones outside."""
    inside: list[Any] = [1] if span.whole else [0.25]
    outside: list[Any] = [] if span.whole else [np.nan]
    for end, included, away in (
        (span.lower, span.lower_included, -np.inf),
        (span.upper, span.upper_included, np.inf),
    ):
        if np.isfinite(end) and span.whole:
            inside.append(int(end))
            outside.append(int(end) + (1 if away > 0 else -1))
        elif np.isfinite(end):
            beyond = float(np.nextafter(end, away))
            inside.append(end if included else float(np.nextafter(end, -away)))
            outside.append(beyond if included else end)
        elif not span.whole:
            outside.append(end)
    return [value for value in inside if value in span], outside


OTHER_NAMES = {"collision_damping": "floor_damping", "expansion_coefficient": "expansion"}
SPANS = {
    **{name: libvox.PROPERTY_RANGES[OTHER_NAMES.get(name, name)] for name in PROPERTIES},
    **{name: libvox.SETTING_RANGES[OTHER_NAMES.get(name, name)] for name in SETTINGS},
}


@pytest.mark.parametrize("option", SPANS)
def test_the_solver_has_the_same_bounds(option: str) -> None:
    inside, outside = ends_of(SPANS[option])
    name = OTHER_NAMES.get(option, option)

    def model(value: Any) -> libvox.Model:
        material = {"youngs_modulus": 5e6, "poisson_ratio": 0.3, "density": 1e6, "expansion": 0.0}
        settings = {"voxel_size": 0.05, "duration": 0.07, "temperature_amplitude": 1.0, "period": 1.0}
        (material if option in PROPERTIES else settings)[name] = value
        return libvox.Model(
            (1, 1, 1),
            {1: libvox.Material(**material)},
            libvox.Settings(**settings),  # type: ignore[arg-type] # step_limit and substeps are whole
            np.zeros((1, 1, 1), np.uint8),
        )

    for value in inside:
        assert getattr(VoxSettings(**{option: value}), option) == value
        assert model(value)
    for value in outside:
        with pytest.raises(ValueError, match=f"^'{option}' .*{re.escape(SPANS[option].words)}: "):
            VoxSettings(**{option: value})
        with pytest.raises(ValueError, match=rf"^{name}.*{re.escape(SPANS[option].words)}"):
            model(value)


def test_every_range_of_the_solver_has_its_option() -> None:
    derived = {"temperature_amplitude", "period", "collision_list_factor"}
    assert {OTHER_NAMES.get(name, name) for name in SETTINGS} == {*libvox.SETTING_RANGES} - derived
    assert {OTHER_NAMES.get(name, name) for name in PROPERTIES} == {*libvox.PROPERTY_RANGES}


@pytest.mark.parametrize("name", PROPERTIES)
def test_a_material_of_a_palette_has_the_same_bounds(name: str) -> None:
    inside, outside = ends_of(SPANS[name])
    for value in inside:
        assert getattr(soft(1, **{name: value}), name) == value
    for value in outside:
        with pytest.raises(ValueError, match=f"^'{name}' .*{re.escape(SPANS[name].words)}: "):
            soft(1, **{name: value})


@given(st.floats(0, limits.MOST_CYCLES))
def test_offsets_within_the_limit_have_a_fraction_in_single_precision(cycles: float) -> None:
    assert np.spacing(np.float32(cycles)) < 0.1
