"""Check of all tags against the schema: only features that vox lacks are rejected."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path

import pytest
from hypothesis import given, strategies as st
from lxml import etree

from evoframe import InputError
from evoframe_simulators import Vox
from evoframe_simulators.vox.vxa import read_vxa
from evoframe_simulators.vox.vxa.checking import collect_unsupported
from evoframe_simulators.vox.vxa.faults import Faults
from evoframe_simulators.vox.vxa.schema import Role, Schema
from evoframe_simulators.vox.vxa.sections import Section

Write = Callable[..., Path]

SCHEMA: Schema = {"Read": Role.READ, "Idle": Role.IDLE, "Refused": Role.UNSUPPORTED, "Off": 0.0, "One": 1.0}
ON = {"Refused", "Off", "One", "Unknown"}


def rejected(text: str, schema: Schema = SCHEMA) -> list[str]:
    """Return the rejected tags of a section with their values, none if all are accepted."""
    faults = Faults()
    collect_unsupported(Section(etree.fromstring(f"<S>{text}</S>"), "S"), (), faults, schema)
    try:
        faults.check()
    except InputError as error:
        if error.key:
            return [f"{error.key} = {error.problem.partition(': ')[2]}"]
        return [line.strip() for line in error.problem.splitlines() if line.startswith("    ")]
    return []


@given(tags=st.lists(st.sampled_from(sorted({*SCHEMA, "Unknown"})), max_size=6))
def test_rejected_tags_are_named_in_the_order_of_the_file(tags: list[str]) -> None:
    found = rejected("".join(f"<{tag}>7</{tag}>" for tag in tags))
    assert [part.split(" = ")[0].removeprefix("S/") for part in found] == [tag for tag in tags if tag in ON]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("<Off>0.0</Off><Off/><Off>false</Off><One>1</One><One/><Unknown><A>0</A></Unknown>", ""),
        ("<Off>0.5</Off>", "S/Off = '0.5'"),
        ("<Off><A>0</A></Off>", "S/Off = '0'"),
        ("<One>0</One>", "S/One = '0'"),
        ("<Refused/>", "S/Refused = ''"),
        ("<Unknown><A>0</A><B>3</B></Unknown>", "S/Unknown = '0 3' (unknown tag)"),
    ],
)
def test_a_tag_is_accepted_only_with_the_value_for_off(text: str, expected: str) -> None:
    assert rejected(text) == ([expected] if expected else [])


@given(depth=st.integers(1, 5))
def test_a_nested_section_is_named_with_its_path(depth: int) -> None:
    text, schema = "<Off>3</Off>", SCHEMA
    for _ in range(depth):
        text, schema = f"<FRegion>{text}</FRegion>", {"FRegion": schema}
    assert isinstance(schema, Mapping)
    assert rejected(text, schema) == [f"S{'/FRegion 1' * depth}/Off = '3'"]


@pytest.mark.parametrize(
    "more",
    [
        "<Wind>0</Wind>",
        "<Wind/>",
        "<Wind><Speed>0.0</Speed><On>False</On></Wind>",
        "<!-- 3 -->",
        "<?wind 3?>",
    ],
)
def test_unknown_tags_that_are_off_are_accepted(vxa: Write, more: str) -> None:
    assert read_vxa(vxa(after={"<Environment>": more})).canvas == (6, 3, 3)


@pytest.mark.parametrize(
    ("after", "more"),
    [
        ("</GA>", "<ParentLifetime>2</ParentLifetime>"),
        ("</GA>", "<SimStop><SimStopWhat>3</SimStopWhat></SimStop>"),
        ("<Environment>", "<BallisticSlowdownFact>10</BallisticSlowdownFact>"),
        ("<Environment>", "<MaxSlowdownPermitted>0.1</MaxSlowdownPermitted>"),
        ("<Environment>", "<MinGrowthTime>0.1</MinGrowthTime>"),
        ("<Mechanical>", "<IsConductive>1</IsConductive>"),
        ("<Mechanical>", "<IsPacemaker>1</IsPacemaker>"),
        ("<Mechanical>", "<MaterialTempPhase>0.5</MaterialTempPhase>"),
        ("<LightSource>", "<X>3</X>"),
    ],
)
def test_tags_without_effect_are_accepted(vxa: Write, after: str, more: str) -> None:
    assert Vox.settings_of(vxa(after={after: more})) == Vox.settings_of(vxa())


@pytest.mark.parametrize(
    "tag",
    [
        "TiltVectorsUpdatesPerTempCycle",
        "SignalingUpdatesPerTempCycle",
        "GrowthSpeedLimit",
        "GreedyGrowth",
    ],
)
def test_values_without_effect_are_accepted(vxa: Write, tag: str) -> None:
    assert Vox.settings_of(vxa(**{tag: 4})) == Vox.settings_of(vxa())


def test_unused_materials_are_not_checked(vxa: Write) -> None:
    path = vxa()
    text = path.read_text()
    start = text.index('<Material ID="4">')
    head, tail = text[:start], text[start:]
    path.write_text(head + tail.replace("<MatModel>0<", "<MatModel>2<").replace("-0.01", "much"))
    assert [material["code"] for material in read_vxa(path).materials] == [1, 3]
