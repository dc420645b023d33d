"""Tests of units: meters are shown as millimeters, other units unchanged."""

from __future__ import annotations

import pandas as pd
import pytest
from hypothesis import given, strategies as st

from evoframe.analysis.data.units import axis_title, in_unit
from evoframe.messages import quantity, unit_factor


@given(st.floats(-1e6, 1e6))
def test_a_value_is_shown_in_its_unit(value: float) -> None:
    for unit, shown in (("m", "mm"), ("kg", "kg"), ("", "")):
        number, _, name = quantity(value, unit).partition(" ")
        assert float(number) == pytest.approx(value * unit_factor(unit), rel=1e-3)
        assert name == shown


@pytest.mark.parametrize(("unit", "title"), [("m", "score (mm)"), ("", "score"), ("N", "score (N)")])
def test_an_axis_names_the_shown_unit(unit: str, title: str) -> None:
    assert axis_title("score", unit) == title


def test_columns_are_converted_and_named() -> None:
    table = pd.DataFrame({"name": ["a", "b"], "median": [0.005, None]})
    shown = in_unit(table, ["median"], "m")
    assert list(shown.columns) == ["name", "median (mm)"]
    assert shown["median (mm)"][0] == 5.0
    assert pd.isna(shown["median (mm)"][1])
    assert in_unit(table, ["median"], "N").columns[1] == "median (N)"
    assert in_unit(table, ["median"], "").equals(table)
