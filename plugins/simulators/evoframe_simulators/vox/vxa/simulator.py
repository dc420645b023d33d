"""Section ``Simulator`` of a VXA file: integration, damping, collisions, and the end of the simulation."""

from __future__ import annotations

import math
from collections.abc import Collection
from typing import Any

from evoframe import InputError
from evoframe_simulators.vox.materials import round_to_single
from evoframe_simulators.vox.vxa.dialects import Engine
from evoframe_simulators.vox.vxa.document import shorten
from evoframe_simulators.vox.vxa.faults import Faults
from evoframe_simulators.vox.vxa.sections import Section, parse_number

__all__ = ["FALLING_CODE", "read_collisions", "read_integration", "read_stop"]

FALLING_CODE = 7
"""Position in the palette of the material that must not touch the floor, in the fork."""

_HORIZON_SYSTEMS = (2, 3)  # equivalent in the engine
_PERIODS = 3  # of the temperature, even if it is constant
_DURATIONS = (2, _PERIODS)
_MOST_COUNTED_STEPS = 10**12


def read_integration(simulator: Section) -> dict[str, Any]:
    """Return step size and damping; without the section of damping the engine has other defaults."""
    damping = simulator.get("Damping")
    return {
        "time_step_fraction": simulator.get("Integration").number("DtFrac", 0.9),
        "bond_damping": damping.number("BondDampingZ", 0.1),
        "collision_damping": damping.number("ColDampingZ", 1.0),
        "slow_damping": damping.number("SlowDampingZ", 1.0 if simulator.find("Damping") else 0.001),
    }


def read_collisions(simulator: Section, engine: Engine, faults: Faults) -> dict[str, Any]:
    """Return the options of collisions between voxels."""
    section = simulator.get("Collisions")
    if engine is Engine.VOXCRAFT:
        attaching = simulator.get("AttachDetach")
        return {"self_collision": bool(attaching.whole("EnableCollision", 1, most=1))}
    if not section.flag("SelfColEnabled"):
        return {"self_collision": False}
    system = section.whole("ColSystem", 3, most=3)
    if system not in _HORIZON_SYSTEMS:
        faults.unsupported(section.at("ColSystem"), shorten(str(system)), "expected 3")
    return {"self_collision": True, "collision_horizon": section.number("CollisionHorizon", 2.0)}


def read_stop(
    simulator: Section,
    environment: Section,
    engine: Engine,
    faults: Faults,
    given: Collection[str] = (),
) -> tuple[dict[str, Any], int | None]:
    """Return start and duration as options, and the number of steps if the file sets that instead.

    The duration is missing if the file does not end by itself. An end of another kind is a fault, unless the
    options *given* by the user contain the duration.

    Raises:
        InputError: The number of steps is too large, or a value is not a number.
    """
    section = simulator.get("StopCondition")
    options: dict[str, Any] = {}
    if engine is not Engine.VOXCRAFT:
        options["start_time"] = start = section.number("InitCmTime", 0.0)
        if section.number("ActuationStartTime", 0.0) > start:
            late = section.text("ActuationStartTime") or ""
            faults.unsupported(section.at("ActuationStartTime"), shorten(late), "later than InitCmTime")
    elif (formula := section.find("StopConditionFormula")) is not None:
        return {} if "duration" in given else {"duration": _duration_of(formula, faults)}, None
    kind = section.whole("StopConditionType", 0, most=6)
    if kind == 0:
        return options, None
    if kind == 1:  # the engine rounds the number and makes one step more
        return options, _counted(section)
    if kind not in _DURATIONS:
        if "duration" not in given:
            why = "expected a number of steps (1), a time (2) or temperature periods (3)"
            faults.unsupported(section.at("StopConditionType"), shorten(str(kind)), why)
        return options, None
    duration = section.number("StopConditionValue", 0.0, above=0.0)
    if kind == _PERIODS:
        duration *= round_to_single(environment.get("Thermal").number("TempPeriod", 0.1, above=0.0))
    elif engine is Engine.FORK and environment.flag("FallingProhibited"):
        options["falling_code"] = FALLING_CODE  # only with this kind of end
    return {**options, "duration": duration}, None


def _counted(section: Section) -> int:
    counted = section.number("StopConditionValue", 0.0, least=0.0)
    if counted > _MOST_COUNTED_STEPS:
        raise InputError(
            f"found {counted:g} steps, expected at most {_MOST_COUNTED_STEPS:g}",
            key=section.at("StopConditionValue"),
        )
    return math.floor(counted + 0.5) + 1


def _duration_of(formula: Section, faults: Faults) -> float:
    """Return the time at which the formula ``t - TIME`` becomes positive."""
    parts = [(str(part.tag), str(part.text or "").strip()) for part in formula.get("mtSUB").element]
    if len(formula.element) == 1 and [tag for tag, _ in parts] == ["mtVAR", "mtCONST"]:
        (_, name), (_, constant) = parts
        time = parse_number(constant)
        if name == "t" and time is not None and time > 0.0:
            return time
    text = " ".join(str(text).strip() for text in formula.element.itertext() if str(text).strip())
    faults.unsupported(formula.place, shorten(text), "expected the time t minus a constant")
    return 0.0
