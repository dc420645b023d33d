"""Tests of parts of messages: suggestions, values found, and causes."""

from __future__ import annotations

import json
import re
from typing import Any

import pytest
from hypothesis import given, strategies as st

from evoframe import InputError
from evoframe.messages import (
    cause_of,
    found,
    full_text,
    quantity,
    suggestion,
    unit_factor,
    unit_name,
)

KNOWN = ["aggregator", "executor", "simulator"]
words = st.text("abcdef", min_size=1, max_size=6)


def quoted(text: str) -> list[str]:
    return re.findall("'([^']*)'", text)


@pytest.mark.parametrize(
    ("word", "label", "meant", "listed"),
    [
        ("agregator", "", "aggregator", False),
        ("agregator", "keys", "aggregator", True),
        ("zzz", "keys", "", True),
        ("zzz", "", "", False),
    ],
)
def test_an_unknown_word_is_answered_with_close_and_valid_words(
    word: str, label: str, meant: str, listed: bool
) -> None:
    end = suggestion(word, iter(KNOWN), label)
    assert quoted(end) == ([meant] if meant else [])
    assert end.endswith("keys: aggregator, executor, simulator") == listed
    assert end == "" or end.startswith("; ")


def test_an_empty_list_of_valid_words_is_stated() -> None:
    assert suggestion("hm", [], "installed").endswith("installed: none")


@given(words, st.lists(words, unique=True, max_size=6))
def test_only_valid_words_are_suggested_and_a_valid_word_is_itself(word: str, known: list[str]) -> None:
    meant = quoted(suggestion(word, known))
    assert len(meant) <= 1
    assert set(meant) <= set(known)
    if word in known:
        assert meant == [word]


@pytest.mark.parametrize(
    ("value", "text"),
    [(True, "true"), (2.5, "2.5"), ("größer", '"größer"'), ([1, "a"], '[1, "a"]'), (None, "null")],
)
def test_a_value_is_shown_in_the_notation_of_configuration_files(value: Any, text: str) -> None:
    assert found(value) == text


def test_a_value_unknown_to_json_is_shown_as_text() -> None:
    assert json.loads(found({"when": 1 + 2j})) == {"when": "(1+2j)"}


def test_notes_follow_an_error_line_by_line() -> None:
    error = InputError("there is no file")
    assert full_text(error) == "there is no file"
    error.add_note("look elsewhere")
    error.add_note("or create one")
    assert full_text(error) == "there is no file\n  look elsewhere\n  or create one"


def test_a_cause_has_its_type_unless_it_is_an_error_of_evoframe() -> None:
    assert cause_of(InputError("there is no file")) == "there is no file"
    assert cause_of(KeyError("pivot")) == "KeyError: 'pivot'"


@pytest.mark.parametrize(
    ("value", "unit", "text"),
    [
        (0.003781337982330435, "m", "3.781 mm"),
        (-0.0, "m", "0 mm"),
        (2.0, "J", "2 J"),
        (2.0, "", "2"),
        (12345.678, "", "1.235e+04"),
    ],
)
def test_a_quantity_has_significant_digits_and_a_unit(value: float, unit: str, text: str) -> None:
    assert quantity(value, unit) == text


@given(st.floats(-1e6, 1e6))
def test_a_length_in_meters_is_shown_in_millimeters(value: float) -> None:
    number, unit = quantity(value, "m", digits=17).split()
    assert unit == unit_name("m") == "mm"
    assert float(number) == pytest.approx(value * unit_factor("m"))
