"""Section ``Environment`` of a VXA file: gravity, floor, fluid and temperature."""

from __future__ import annotations

from typing import Any

from evoframe_simulators.vox.materials import round_to_single
from evoframe_simulators.vox.vxa.dialects import Engine
from evoframe_simulators.vox.vxa.sections import Section

__all__ = ["is_under_water", "read_surroundings", "read_thermal"]


def is_under_water(environment: Section) -> bool:
    """Return whether a file asks for a fluid."""
    return environment.flag("FluidEnvironment")


def read_surroundings(environment: Section, engine: Engine) -> dict[str, Any]:
    """Return gravity, floor and fluid; without the section of gravity the engine has both."""
    section, given = environment.get("Gravity"), environment.find("Gravity") is not None
    weight, floor = (
        bool(section.whole(tag, 0 if given else 1, most=1)) for tag in ("GravEnabled", "FloorEnabled")
    )
    if engine is Engine.VOXCRAFT:
        floor = bool(section.whole("FloorEnabled", 1, most=1))
    water = is_under_water(environment) and engine is not Engine.VOXCRAFT
    if water and engine is Engine.EVOSORO_WATER:
        weight = floor = False
    options: dict[str, Any] = {
        "gravity": section.number("GravAcc", -9.81) if weight else 0.0,
        "floor": floor,
        "floor_slope": section.number("FloorSlope", 0.0) if floor and engine is Engine.FORK else 0.0,
    }
    if water:
        options["fluid_drag"] = environment.number("AggregateDragCoefficient", 0.0)
    return options


def read_thermal(environment: Section, engine: Engine) -> dict[str, Any]:
    """Return the temperature options; without actuation the amplitude equals the base."""
    section = environment.get("Thermal")
    enabled = section.flag("TempEnabled") if environment.find("Thermal") else True
    base = section.number("TempBase", 25.0)
    if section.text("TempAmplitude") is None:
        highest = section.number("TempAmp", base)
    else:
        swing = section.number("TempAmplitude", 0.0)
        # The engine holds the swing in single precision. If adding the base would round it, drop the base.
        base = base if round_to_single(base + swing - base) == round_to_single(swing) else 0.0
        highest = base + swing
    if engine is Engine.VOXCRAFT:
        enabled = section.flag("VaryTempEnabled")  # the only flag that its actuation looks at
    if not enabled or highest == base:
        return {"temperature_base": base, "temperature_amplitude": base}
    period = section.number("TempPeriod", 0.1, above=0.0)
    return {"temperature_base": base, "temperature_amplitude": highest, "frequency": 1.0 / period}
