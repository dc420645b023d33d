"""Parts of messages: what could have been meant, what was found, and why."""

from __future__ import annotations

import json
from typing import Any

import pytest
from hypothesis import given, strategies as st

from evoframe import InputError
from evoframe.messages import cause_of, found, full_text, suggestion

KNOWN = ["aggregator", "executor", "simulator"]
words = st.text("abcdef", min_size=1, max_size=6)


@pytest.mark.parametrize(
    ("word", "label", "end"),
    [
        ("agregator", "", "; did you mean 'aggregator'?"),
        ("agregator", "keys", "; did you mean 'aggregator'? keys: aggregator, executor, simulator"),
        ("zzz", "keys", "; keys: aggregator, executor, simulator"),
        ("zzz", "", ""),
    ],
)
def test_an_unknown_word_is_answered_with_what_could_have_been_meant(word: str, label: str, end: str) -> None:
    assert suggestion(word, iter(KNOWN), label) == end


def test_where_nothing_is_known_that_is_said() -> None:
    assert suggestion("hm", [], "installed") == "; installed: none"


@given(words, st.lists(words, unique=True, max_size=6))
def test_only_what_is_known_is_suggested_and_a_known_word_is_itself(word: str, known: list[str]) -> None:
    end = suggestion(word, known)
    assert end == "" or any(end == f"; did you mean '{each}'?" for each in known)
    if word in known:
        assert end == f"; did you mean '{word}'?"


@pytest.mark.parametrize(
    ("value", "text"),
    [(True, "true"), (2.5, "2.5"), ("größer", '"größer"'), ([1, "a"], '[1, "a"]'), (None, "null")],
)
def test_a_value_is_shown_as_a_person_writes_it(value: Any, text: str) -> None:
    assert found(value) == text


def test_a_value_that_json_has_not_is_shown_as_text() -> None:
    assert json.loads(found({"when": 1 + 2j})) == {"when": "(1+2j)"}


def test_hints_stand_below_an_error_line_by_line() -> None:
    error = InputError("there is no file")
    assert full_text(error) == "there is no file"
    error.add_note("look elsewhere")
    error.add_note("or make one")
    assert full_text(error) == "there is no file\n  look elsewhere\n  or make one"


def test_a_cause_has_its_type_unless_it_is_meant_for_a_person() -> None:
    assert cause_of(InputError("there is no file")) == "there is no file"
    assert cause_of(KeyError("pivot")) == "KeyError: 'pivot'"
