"""Dialects: told by tags that only one program writes, chosen by the user, or assumed."""

from __future__ import annotations

import pytest
from lxml import etree

from evoframe import ConfigurationError
from evoframe_simulators.vox.vxa.dialects import DIALECTS, Engine, recognize
from evoframe_simulators.vox.vxa.sections import Section


def root(text: str) -> Section:
    return Section(etree.fromstring(f"<VXA>{text}</VXA>"), "")


WATER = "<Environment><FluidEnvironment>{}</FluidEnvironment></Environment>"
EVOSORO = "<Simulator><StopCondition><AfterlifeTime>0</AfterlifeTime></StopCondition></Simulator>"
FORK = "<Environment><ContractOnly>0</ContractOnly></Environment>"
VOXCRAFT = "<GPU><HeapSize>0.1</HeapSize></GPU>"


@pytest.mark.parametrize(
    ("text", "dialect", "mark"),
    [
        (EVOSORO, "evosoro", "Simulator/StopCondition/AfterlifeTime"),
        (FORK, "fork", "Environment/ContractOnly"),
        (VOXCRAFT, "voxcraft", "GPU"),
        (EVOSORO + FORK, "fork", "Environment/ContractOnly"),  # exported by evoframe
        (VOXCRAFT + FORK, "voxcraft", "GPU"),
    ],
)
def test_tags_of_one_program_tell_the_dialect(text: str, dialect: str, mark: str) -> None:
    rules = recognize(root(text))
    assert (rules.dialect, rules.mark, rules.assumed) == (dialect, mark, False)
    assert mark in rules.described()


def test_the_fork_is_assumed_if_no_tag_tells() -> None:
    rules = recognize(root(WATER.format(1)))
    assert (rules.dialect, rules.engine, rules.assumed) == ("fork", Engine.FORK, True)


@pytest.mark.parametrize("dialect", DIALECTS)
@pytest.mark.parametrize("text", ["", EVOSORO, FORK, VOXCRAFT])
def test_the_user_decides(dialect: str, text: str) -> None:
    rules = recognize(root(text), dialect)
    assert (rules.dialect, rules.chosen, rules.assumed) == (dialect, True, False)


def test_an_unknown_dialect_is_rejected_with_the_known_ones() -> None:
    with pytest.raises(ConfigurationError, match=r"'vox'; .*fork, evosoro, voxcraft") as caught:
        recognize(root(""), "vox")
    assert caught.value.source == "--dialect"


@pytest.mark.parametrize(
    ("text", "engine"),
    [
        ("", Engine.EVOSORO_LAND),
        (WATER.format(0), Engine.EVOSORO_WATER),
        (WATER.format(1), Engine.EVOSORO_WATER),
    ],
)
def test_files_of_evosoro_with_a_tag_for_water_are_for_its_engine_with_water(
    text: str, engine: Engine
) -> None:
    assert recognize(root(text), "evosoro").engine is engine
