"""Strict reading of values from sections, and the keys of errors."""

from __future__ import annotations

import math
import re
from typing import Any

import pytest
from hypothesis import given, strategies as st
from lxml import etree

from evoframe import InputError
from evoframe_simulators.vox.vxa.sections import Section, parse_number


def section(text: str, place: str = "A/B") -> Section:
    return Section(etree.fromstring(f"<S>{text}</S>"), place)


@given(st.floats(allow_nan=False, allow_infinity=False))
def test_a_written_number_is_read_exactly(value: float) -> None:
    assert parse_number(repr(value)) == value
    assert section(f"<X> {value!r}\n</X>").number("X", 0.0) == value


@given(st.text(max_size=8))
def test_other_texts_are_not_numbers(text: str) -> None:
    found = parse_number(text)
    assert found is None or (math.isfinite(found) and re.fullmatch(r"[-+0-9.eE]+", text))


@pytest.mark.parametrize(
    "text", ["", "nan", "inf", "1e999", "0x1", "1_0", "1,5", "٣", "1 2", "--1", "e3", "."]
)
def test_numbers_of_python_but_not_of_the_engine_are_rejected(text: str) -> None:
    assert parse_number(text) is None


@pytest.mark.parametrize(
    ("text", "bounds", "problem"),
    [
        ("<X>a</X>", {}, r"number, found 'a'$"),
        ("<X/>", {}, r"number, found ''$"),
        ("<X>-1</X>", {"least": 0.0}, r"at least 0, found '-1'$"),
        ("<X>0</X>", {"above": 0.0}, r"above 0, found '0'$"),
        ("", {"above": 0.0}, r"above 0, found nothing$"),
        ("<X><Y/></X>", {}, r"found tags"),
        ("<X>1</X><X>1</X>", {}, r"2 times"),
    ],
)
def test_the_error_for_a_number_out_of_range_has_its_key(text: str, bounds: Any, problem: str) -> None:
    with pytest.raises(InputError, match=problem) as caught:
        section(text).number("X", 0.0, **bounds)
    assert caught.value.key == "A/B/X"


@given(value=st.integers(-5, 15), form=st.sampled_from(["{}", "{}.0", "{}e0"]))
def test_an_integer_is_accepted_within_its_bounds(value: int, form: str) -> None:
    found = section(f"<X>{form.format(value)}</X>")
    if 1 <= value <= 9:
        assert found.whole("X", least=1, most=9) == value
    else:
        with pytest.raises(InputError, match=rf"1 to 9, found '{value}") as caught:
            found.whole("X", least=1, most=9)
        assert caught.value.key == "A/B/X"


def test_a_missing_number_is_the_default() -> None:
    assert section("").whole("X", 4) == 4
    assert section("").number("X", 0.5) == 0.5
    assert section("").flag("X") is False
    with pytest.raises(InputError, match="missing") as caught:
        section("").whole("X")
    assert caught.value.key == "A/B/X"


@pytest.mark.parametrize(("text", "expected"), [("1", True), ("0", False), ("1.0", True)])
def test_flags(text: str, expected: bool) -> None:
    assert section(f"<X>{text}</X>").flag("X") is expected


def test_sections_know_their_place() -> None:
    root = Section(etree.fromstring("<S><X><Y/></X><Z/><Z/></S>"), "")
    assert root.need("X").need("Y").place == "X/Y"
    assert [found.place for found in root.all("Z")] == ["Z 1", "Z 2"]
    assert root.count("Z") == 2
    assert root.find("W") is None
    assert (root.get("W").place, len(root.get("W").element)) == ("W", 0)
    assert root.get("X").need("Y").place == "X/Y"
    with pytest.raises(InputError, match="missing") as caught:
        root.need("X").need("W")
    assert caught.value.key == "X/W"
