"""Section of the environment: gravity, floor, fluid and temperature by the rules of each engine."""

from __future__ import annotations

from typing import Any

import pytest
from lxml import etree

from evoframe_simulators.vox.vxa.dialects import Engine
from evoframe_simulators.vox.vxa.environment import is_under_water, read_surroundings, read_thermal
from evoframe_simulators.vox.vxa.sections import Section


def environment(text: str) -> Section:
    return Section(etree.fromstring(f"<Environment>{text}</Environment>"), "Environment")


HEAVY = (
    "<Gravity><GravEnabled>1</GravEnabled><GravAcc>-1</GravAcc><FloorEnabled>1</FloorEnabled>"
    "<FloorSlope>5</FloorSlope></Gravity>"
)
WATER = "<FluidEnvironment>1</FluidEnvironment><AggregateDragCoefficient>7</AggregateDragCoefficient>"


def surroundings(gravity: float, *, floor: bool, slope: float = 0.0, **drag: float) -> dict[str, Any]:
    return {"gravity": gravity, "floor": floor, "floor_slope": slope, **drag}


@pytest.mark.parametrize(
    ("text", "engine", "expected"),
    [
        ("", Engine.FORK, surroundings(-9.81, floor=True)),
        ("<Gravity/>", Engine.FORK, surroundings(0.0, floor=False)),
        ("<Gravity/>", Engine.EVOSORO_LAND, surroundings(0.0, floor=False)),
        ("<Gravity/>", Engine.VOXCRAFT, surroundings(0.0, floor=True)),
        ("<Gravity><GravEnabled>1</GravEnabled></Gravity>", Engine.FORK, surroundings(-9.81, floor=False)),
        (HEAVY, Engine.FORK, surroundings(-1.0, floor=True, slope=5.0)),
        (HEAVY, Engine.EVOSORO_LAND, surroundings(-1.0, floor=True)),
        (HEAVY, Engine.EVOSORO_WATER, surroundings(-1.0, floor=True)),
        (HEAVY, Engine.VOXCRAFT, surroundings(-1.0, floor=True)),
        (HEAVY + WATER, Engine.FORK, surroundings(-1.0, floor=True, slope=5.0, fluid_drag=7.0)),
        (HEAVY + WATER, Engine.EVOSORO_WATER, surroundings(0.0, floor=False, fluid_drag=7.0)),
        (HEAVY + WATER, Engine.VOXCRAFT, surroundings(-1.0, floor=True)),
    ],
)
def test_surroundings(text: str, engine: Engine, expected: dict[str, Any]) -> None:
    assert read_surroundings(environment(text), engine) == expected


@pytest.mark.parametrize(("text", "expected"), [("", False), (WATER, True), (WATER.replace("1", "0"), False)])
def test_a_flag_asks_for_a_fluid(text: str, expected: bool) -> None:
    assert is_under_water(environment(text)) is expected


ACTING = "<TempEnabled>1</TempEnabled><TempAmp>39</TempAmp>"


@pytest.mark.parametrize(
    ("text", "engine", "expected"),
    [
        ("", Engine.FORK, (25.0, 25.0, None)),
        (f"<Thermal>{ACTING}</Thermal>", Engine.FORK, (25.0, 39.0, 10.0)),
        (f"<Thermal>{ACTING}<VaryTempEnabled>0</VaryTempEnabled></Thermal>", Engine.FORK, (25.0, 39.0, 10.0)),
        (f"<Thermal>{ACTING}<TempPeriod>0.5</TempPeriod></Thermal>", Engine.EVOSORO_LAND, (25.0, 39.0, 2.0)),
        (f"<Thermal>{ACTING}<TempAmplitude>4</TempAmplitude></Thermal>", Engine.FORK, (25.0, 29.0, 10.0)),
        ("<Thermal><TempAmp>39</TempAmp></Thermal>", Engine.FORK, (25.0, 25.0, None)),
        ("<Thermal><TempEnabled>1</TempEnabled></Thermal>", Engine.FORK, (25.0, 25.0, None)),
        (f"<Thermal>{ACTING}</Thermal>", Engine.VOXCRAFT, (25.0, 25.0, None)),
        (
            f"<Thermal>{ACTING}<VaryTempEnabled>1</VaryTempEnabled></Thermal>",
            Engine.VOXCRAFT,
            (25.0, 39.0, 10.0),
        ),
    ],
)
def test_temperature(text: str, engine: Engine, expected: tuple[float | None, ...]) -> None:
    options = read_thermal(environment(text), engine)
    names = ("temperature_base", "temperature_amplitude", "frequency")
    assert tuple(options.get(name) for name in names) == expected
