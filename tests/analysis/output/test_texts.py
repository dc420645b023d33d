"""Texts have what they are given, letter by letter, and nothing in it is a template."""

from __future__ import annotations

import math

import attrs
import jinja2
import pytest
from hypothesis import given, strategies as st

from evoframe.analysis.output.texts import counted, listed, p_value, written
from evoframe.analysis.statistics.groups import ranked

BAD = "{{ 7 * 7 }} {% for x in y %} <b>&'\"</b> {# no #}"


@given(st.text(st.characters(exclude_characters="\n", exclude_categories=["Cs"]), min_size=1))
def test_names_stand_in_them_as_they_are(name: str) -> None:
    [group] = ranked({name: [1.0]})
    text = written("alone.txt", group=group)
    assert text == f"{name} is the only group, so there is nothing that it could be compared with."


def test_a_name_is_no_template() -> None:
    [group] = ranked({BAD: [1.0]})
    assert written("alone.txt", group=group).startswith(BAD)


@attrs.frozen
class Study:
    """A study in a few words."""

    rows: tuple[int, ...]
    planned: int
    alike: bool


def test_an_indented_line_continues_the_sentence_before_it() -> None:
    assert written("lead.txt", data=Study((1,), 2, alike=True)) == (
        "1 of 2 runs are finished. What follows may change with the others."
    )
    assert written("lead.txt", data=Study((1, 2), 2, alike=True)) == "2 of 2 runs are finished."


def test_a_value_that_is_not_given_is_missed() -> None:
    with pytest.raises(jinja2.UndefinedError, match="data"):
        written("lead.txt")


@given(st.lists(st.text("ab", min_size=1), max_size=5))
def test_a_list_has_commas_and_one_and(items: list[str]) -> None:
    text = listed(items)
    assert text.replace(" and ", ", ").split(", ") == (items or [""])
    assert text.count(" and ") == (len(items) > 1)


def test_numbers_are_counted() -> None:
    assert [counted(n, "run", "runs") for n in (0, 1, 2)] == ["0 runs", "1 run", "2 runs"]


@given(st.floats(0, 1))
def test_a_p_value_has_three_digits(p: float) -> None:
    sign, _, number = p_value(p).partition(" ")
    assert (sign, number) == ("<", "0.001") if p < 0.001 else math.isclose(float(number), p, abs_tol=5.1e-4)
