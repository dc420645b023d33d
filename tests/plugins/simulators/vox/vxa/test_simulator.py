"""Section of the simulator: defaults of missing tags and sections, and the end of the simulation."""

from __future__ import annotations

from collections.abc import Collection
from typing import Any

import numpy as np
import pytest
from lxml import etree

from evoframe import InputError
from evoframe_simulators.vox.vxa.dialects import Engine
from evoframe_simulators.vox.vxa.faults import Faults
from evoframe_simulators.vox.vxa.sections import Section
from evoframe_simulators.vox.vxa.simulator import read_collisions, read_integration, read_stop

NAMES = ("Simulator", "Environment")


def section(name: str, text: str) -> Section:
    return Section(etree.fromstring(f"<{name}>{text}</{name}>"), name)


def stop(
    text: str, environment: str = "", engine: Engine = Engine.FORK, given: Collection[str] = ()
) -> tuple[dict[str, Any], int | None, Faults]:
    faults = Faults()
    simulator = section("Simulator", f"<StopCondition>{text}</StopCondition>")
    return *read_stop(simulator, section("Environment", environment), engine, faults, given), faults


def kind(number: int, value: float) -> str:
    return f"<StopConditionType>{number}</StopConditionType><StopConditionValue>{value}</StopConditionValue>"


FORMULA = "<StopConditionFormula>{}</StopConditionFormula>"
TIME = "<mtSUB><mtVAR> t\n</mtVAR><mtCONST>1.5</mtCONST></mtSUB>"


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("", (0.9, 0.1, 1.0, 0.001)),
        ("<Integration/><Damping/>", (0.9, 0.1, 1.0, 1.0)),
        (
            "<Integration><DtFrac>0.5</DtFrac></Integration><Damping><SlowDampingZ>0</SlowDampingZ></Damping>",
            (0.5, 0.1, 1.0, 0.0),
        ),
    ],
)
def test_a_missing_section_has_other_defaults_than_missing_tags(
    text: str, expected: tuple[float, ...]
) -> None:
    options = read_integration(section("Simulator", text))
    names = ("time_step_fraction", "bond_damping", "collision_damping", "slow_damping")
    assert options == dict(zip(names, expected, strict=True))


@pytest.mark.parametrize(
    ("text", "engine", "expected"),
    [
        ("", Engine.FORK, {"self_collision": False}),
        ("<SelfColEnabled>0</SelfColEnabled>", Engine.FORK, {"self_collision": False}),
        (
            "<SelfColEnabled>1</SelfColEnabled>",
            Engine.EVOSORO_LAND,
            {"self_collision": True, "collision_horizon": 2.0},
        ),
        (
            "<SelfColEnabled>1</SelfColEnabled><CollisionHorizon>6.5</CollisionHorizon>",
            Engine.FORK,
            {"self_collision": True, "collision_horizon": 6.5},
        ),
        ("<SelfColEnabled>0</SelfColEnabled>", Engine.VOXCRAFT, {"self_collision": True}),
    ],
)
def test_collisions(text: str, engine: Engine, expected: dict[str, Any]) -> None:
    simulator = section("Simulator", f"<Collisions>{text}</Collisions>")
    assert read_collisions(simulator, engine, Faults()) == expected


def test_collisions_of_voxcraft_have_their_own_tag() -> None:
    off = section("Simulator", "<AttachDetach><EnableCollision>0</EnableCollision></AttachDetach>")
    assert read_collisions(off, Engine.VOXCRAFT, Faults()) == {"self_collision": False}


@pytest.mark.parametrize("text", ["", kind(0, 5.0), "<StopConditionValue>5</StopConditionValue>"])
def test_a_simulation_without_an_end_has_no_duration(text: str) -> None:
    options, steps, faults = stop(text)
    assert (options, steps) == ({"start_time": 0.0}, None)
    faults.check()


def test_a_time_a_number_of_periods_and_a_number_of_steps_end_it() -> None:
    period = "<Thermal><TempPeriod>0.1</TempPeriod></Thermal>"
    assert stop(kind(2, 0.5))[0]["duration"] == 0.5
    assert stop(kind(3, 2), period)[0]["duration"] == 2 * float(np.float32(0.1))
    assert stop(kind(3, 2))[0]["duration"] == 2 * float(np.float32(0.1))
    assert stop(kind(1, 7.4))[:2] == ({"start_time": 0.0}, 8)


def test_a_number_of_steps_without_end_is_refused() -> None:
    with pytest.raises(InputError, match=r"found 1e\+13 steps, expected at most 1e\+12") as caught:
        stop(kind(1, 1e13))
    assert caught.value.key == "Simulator/StopCondition/StopConditionValue"


@pytest.mark.parametrize("number", [4, 5, 6])
def test_ends_by_energy_are_not_simulated(number: int) -> None:
    with pytest.raises(InputError) as caught:
        stop(kind(number, 1))[2].check()
    assert caught.value.key == "Simulator/StopCondition/StopConditionType"
    assert stop(kind(number, 1), given=["duration"]) == ({"start_time": 0.0}, None, Faults())


@pytest.mark.parametrize(
    ("number", "engine", "code"),
    [
        (2, Engine.FORK, 7),
        (3, Engine.FORK, None),
        (1, Engine.FORK, None),
        (2, Engine.EVOSORO_WATER, None),
        (2, Engine.VOXCRAFT, None),
    ],
)
def test_falling_is_prohibited_by_the_fork_in_a_given_time(
    number: int, engine: Engine, code: int | None
) -> None:
    options, _, _ = stop(kind(number, 1), "<FallingProhibited>1</FallingProhibited>", engine)
    assert options.get("falling_code") == code


def test_voxcraft_starts_at_time_0_and_ends_by_a_formula() -> None:
    start = "<InitCmTime>0.5</InitCmTime>"
    assert stop(start + kind(2, 3) + FORMULA.format(TIME), engine=Engine.VOXCRAFT)[:2] == (
        {"duration": 1.5},
        None,
    )
    assert stop(start + kind(2, 3), engine=Engine.VOXCRAFT)[0] == {"duration": 3.0}


@pytest.mark.parametrize(
    "formula",
    [
        "",
        "<mtSUB/>",
        "<mtSUB><mtVAR>x</mtVAR><mtCONST>1</mtCONST></mtSUB>",
        "<mtSUB><mtCONST>1</mtCONST><mtVAR>t</mtVAR></mtSUB>",
        "<mtSUB><mtVAR>t</mtVAR><mtCONST>-1</mtCONST></mtSUB>",
        "<mtSUB><mtVAR>t</mtVAR><mtCONST>soon</mtCONST></mtSUB>",
        f"{TIME}<mtADD/>",
        "<mtADD><mtVAR>t</mtVAR><mtCONST>1</mtCONST></mtADD>",
    ],
)
def test_other_formulas_are_not_simulated(formula: str) -> None:
    _, _, faults = stop(FORMULA.format(formula), engine=Engine.VOXCRAFT)
    with pytest.raises(InputError) as caught:
        faults.check()
    assert caught.value.key == "Simulator/StopCondition/StopConditionFormula"
    given = stop(FORMULA.format(formula), engine=Engine.VOXCRAFT, given=["duration"])
    assert given == ({}, None, Faults())
