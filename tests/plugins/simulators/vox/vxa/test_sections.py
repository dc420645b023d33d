"""Values out of sections: strictly, and with their place in every complaint."""

from __future__ import annotations

import math
import re
from typing import Any

import pytest
from hypothesis import given, strategies as st
from lxml import etree

from evoframe import InputError
from evoframe_simulators.vox.vxa.sections import Refusals, Section, number_in


def section(text: str, place: str = "A/B") -> Section:
    return Section(etree.fromstring(f"<S>{text}</S>"), place)


@given(st.floats(allow_nan=False, allow_infinity=False))
def test_a_number_is_read_as_it_was_written(value: float) -> None:
    assert number_in(repr(value)) == value
    assert section(f"<X> {value!r}\n</X>").number("X", 0.0) == value


@given(st.text(max_size=8))
def test_other_texts_are_no_numbers(text: str) -> None:
    found = number_in(text)
    assert found is None or (math.isfinite(found) and re.fullmatch(r"[-+0-9.eE]+", text))


@pytest.mark.parametrize(
    "text", ["", "nan", "inf", "1e999", "0x1", "1_0", "1,5", "٣", "1 2", "--1", "e3", "."]
)
def test_what_python_takes_for_a_number_and_the_engine_does_not(text: str) -> None:
    assert number_in(text) is None


@pytest.mark.parametrize(
    ("text", "bounds", "message"),
    [
        ("<X>a</X>", {}, "A/B/X: expected a number, found 'a'"),
        ("<X/>", {}, "A/B/X: expected a number, found ''"),
        ("<X>-1</X>", {"least": 0.0}, "A/B/X: expected a number of at least 0, found '-1'"),
        ("<X>0</X>", {"above": 0.0}, "A/B/X: expected a number above 0, found '0'"),
        ("", {"above": 0.0}, "A/B/X: expected a number above 0, found nothing"),
        ("<X><Y/></X>", {}, "A/B/X has tags in it; expected a value"),
        ("<X>1</X><X>1</X>", {}, "A/B/X is there 2 times; expected once"),
    ],
)
def test_a_number_out_of_range_is_refused_with_its_place(text: str, bounds: Any, message: str) -> None:
    with pytest.raises(InputError) as caught:
        section(text).number("X", 0.0, **bounds)
    assert str(caught.value) == message


@given(value=st.integers(-5, 15), form=st.sampled_from(["{}", "{}.0", "{}e0"]))
def test_a_whole_number_is_accepted_within_its_ends(value: int, form: str) -> None:
    found = section(f"<X>{form.format(value)}</X>")
    if 1 <= value <= 9:
        assert found.whole("X", least=1, most=9) == value
    else:
        with pytest.raises(InputError, match=r"^A/B/X: expected a whole number from 1 to 9, found '"):
            found.whole("X", least=1, most=9)


def test_a_missing_number_is_the_default_if_there_is_one() -> None:
    assert section("").whole("X", 4) == 4
    assert section("").number("X", 0.5) == 0.5
    assert section("").flag("X") is False
    with pytest.raises(InputError, match=r"^has no A/B/X$"):
        section("").whole("X")


@pytest.mark.parametrize(("text", "expected"), [("1", True), ("0", False), ("1.0", True)])
def test_flags(text: str, expected: bool) -> None:
    assert section(f"<X>{text}</X>").flag("X") is expected


def test_sections_know_their_place() -> None:
    root = Section(etree.fromstring("<S><X><Y/></X><Z/><Z/></S>"), "")
    assert root.need("X").need("Y").place == "X/Y"
    assert [found.place for found in root.all("Z")] == ["Z 1", "Z 2"]
    assert root.count("Z") == 2
    assert root.find("W") is None
    with pytest.raises(InputError, match=r"^has no X/W, which every VXA file should have$"):
        root.need("X").need("W")


def test_refusals_make_one_message() -> None:
    refusals = Refusals()
    refusals.check()
    refusals.add("A", "'1'")
    refusals.add("B", "'2'", "why")
    with pytest.raises(InputError, match=r"^asks for what vox does not simulate: A = '1'; B = '2' \(why\)$"):
        refusals.check()
