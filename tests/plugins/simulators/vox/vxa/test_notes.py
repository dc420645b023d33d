"""Notes on the reading of a file, and questions that only the user can answer."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from evoframe import FileContents, FileOptions, InputError
from evoframe_simulators import Vox

PRACTICE = Path(__file__).parents[4] / "data" / "vxa" / "practice"
WATER = "<FluidEnvironment>1</FluidEnvironment><AggregateDragCoefficient>750</AggregateDragCoefficient>"
NO_WEIGHT = {"<GravEnabled>1<": "<GravEnabled>0<"}
NO_FLOOR = {"<FloorEnabled>1<": "<FloorEnabled>0<"}

Write = Callable[..., Path]


@pytest.fixture
def walker(tmp_path: Path) -> Write:
    """Write a walker whose tags do not tell the dialect, with more tags in its environment, and changes."""

    def write(more: str = "", changes: dict[str, str] | None = None) -> Path:
        text = (PRACTICE / "walker_ascii.vxa").read_text().replace("</Environment>", f"{more}</Environment>")
        for old, new in (changes or {}).items():
            assert old in text
            text = text.replace(old, new)
        path = tmp_path / "walker.vxa"
        path.write_text(text)
        return path

    return write


def contents(path: Path, dialect: str = "", **settings: object) -> FileContents:
    found = Vox.interpret(path, FileOptions(dialect, settings=settings))
    assert found is not None
    return found


class TestQuestion:
    """Weight and floor under water."""

    def test_names_the_option_and_both_answers(self, walker: Write) -> None:
        with pytest.raises(InputError, match=r"--dialect fork .*--dialect evosoro") as caught:
            contents(walker(WATER))
        assert caught.value.key == "Environment/FluidEnvironment"

    @pytest.mark.parametrize(("dialect", "floor"), [("fork", True), ("evosoro", False)])
    def test_is_answered_by_the_option(self, walker: Write, dialect: str, floor: bool) -> None:
        found = contents(walker(WATER), dialect)
        assert (found.dialect, found.settings["floor"]) == (dialect, floor)
        assert found.settings["gravity"] == (-9.81 if floor else 0.0)

    @pytest.mark.parametrize(
        ("more", "floor"),
        [("<ContractOnly>0</ContractOnly>", True), ("<SaveTraces>0</SaveTraces>", False)],
    )
    def test_is_answered_by_a_tag(self, walker: Write, more: str, floor: bool) -> None:
        assert contents(walker(WATER + more)).settings["floor"] is floor

    def test_is_answered_by_overrides(self, walker: Write) -> None:
        found = contents(walker(WATER), gravity=0.0, floor=False)
        assert (found.settings["gravity"], found.settings["floor"]) == (0.0, False)
        with pytest.raises(InputError):
            contents(walker(WATER), gravity=0.0)

    def test_is_not_asked_if_the_answer_does_not_matter(self, walker: Write) -> None:
        assert contents(walker(WATER, {**NO_WEIGHT, **NO_FLOOR})).settings["fluid_drag"] == 750.0
        assert contents(walker(WATER.replace(">1<", ">0<"))).settings["floor"] is True


@pytest.mark.parametrize(
    ("more", "dialect", "words"),
    [
        ("", "", ["fork", "assumed", "evosoro limits sizes to 1"]),
        ("<GrowthAmplitude>0.5</GrowthAmplitude>", "", ["assumed"]),
        ("<ContractOnly>0</ContractOnly>", "", ["fork", "has Environment/ContractOnly"]),
        ("", "evosoro", ["evosoro", "_voxcad", "chosen"]),
        (WATER, "evosoro", ["_voxcad_land_water"]),
        ("<StickyFloor>1</StickyFloor>", "fork", ["Environment/StickyFloor = 1 has no effect"]),
        ("<ContractOnly>1</ContractOnly>", "evosoro", ["Environment/ContractOnly = 1 has no effect"]),
        (
            "<GrowthAmplitude>9</GrowthAmplitude><ExpandOnly>1</ExpandOnly>",
            "evosoro",
            ["ExpandOnly = 1 has no"],
        ),
    ],
)
def test_notes_say_which_rules_were_used_and_why(
    walker: Write, more: str, dialect: str, words: list[str]
) -> None:
    notes = "\n".join(contents(walker(more), dialect).notes)
    assert all(word in notes for word in words), notes


def test_a_slope_is_lost_in_evosoro(walker: Write) -> None:
    slope = {"<GravAcc>": "<FloorSlope>5</FloorSlope><GravAcc>"}
    assert "has no slope" in "\n".join(contents(walker("", slope)).notes)
    assert "Environment/Gravity/FloorSlope = 5 has no effect" in "\n".join(
        contents(walker("", slope), "evosoro").notes
    )


def test_a_temperature_that_should_be_constant_is_noted(walker: Write) -> None:
    path = walker("", {"<VaryTempEnabled>1<": "<VaryTempEnabled>0<"})
    assert any("VaryTempEnabled" in note for note in contents(path).notes)
    assert not any("VaryTempEnabled" in note for note in contents(walker()).notes)


def test_laws_of_voxcraft_that_vox_lacks_are_noted(walker: Write) -> None:
    path = walker("", {"<Simulator>": "<Simulator><EnableExpansion>1</EnableExpansion>"})
    found = contents(path)
    assert found.dialect == "voxcraft"
    assert any("voxcraft-sim" in note and "friction" in note for note in found.notes)


def test_sizes_are_capped_in_files_of_evosoro(walker: Write) -> None:
    settings = contents(walker("<SaveTraces>0</SaveTraces>")).settings
    assert (settings["largest_size"], settings["size_rule"]) == (1.0, "hold")
