"""Tests of texts rendered from templates: values are inserted unchanged and never parsed."""

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
def test_a_name_is_inserted_unchanged(name: str) -> None:
    [group] = ranked({name: [1.0]})
    assert written("alone.txt", groups=[group], fewest=5).startswith(f"{name} is ")


def test_a_name_is_not_parsed_as_a_template() -> None:
    [group] = ranked({BAD: [1.0]})
    assert written("alone.txt", groups=[group], fewest=5).startswith(BAD)


@attrs.frozen
class Study:
    """The state of a study."""

    rows: tuple[int, ...]
    planned: int
    alike: bool
    mixed: tuple[str, ...] = ()


def test_an_indented_line_continues_the_sentence_before_it() -> None:
    unfinished = written("lead.txt", data=Study((1,), 2, alike=True))
    finished = written("lead.txt", data=Study((1, 2), 2, alike=True))
    unlike = written("lead.txt", data=Study((1, 2), 2, alike=False))
    assert [text.count(". ") for text in (unfinished, finished, unlike)] == [1, 0, 1]
    assert unfinished.startswith("1 of 2 ")
    assert finished.startswith("2 of 2 ")
    assert unlike.startswith(f"{finished} ")
    assert not any("\n" in text or "  " in text for text in (unfinished, finished, unlike))


def test_bit_generations_that_are_mixed_are_named() -> None:
    alike, mixed = (
        Study((1, 2), 2, alike=True, mixed=names) for names in ((), ("vox: 1 and 2", "x: 1 and 3"))
    )
    assert written("lead.txt", data=mixed).startswith(written("lead.txt", data=alike))
    assert "(vox: 1 and 2; x: 1 and 3)" in written("lead.txt", data=mixed)


def test_a_missing_value_is_an_error() -> None:
    with pytest.raises(jinja2.UndefinedError, match="data"):
        written("lead.txt")


@given(st.lists(st.text("ab", min_size=1), max_size=5))
def test_an_enumeration_has_commas_and_one_and(items: list[str]) -> None:
    text = listed(items)
    assert text.replace(" and ", ", ").split(", ") == (items or [""])
    assert text.count(" and ") == (len(items) > 1)


def test_a_noun_agrees_with_its_number() -> None:
    assert [counted(n, "run", "runs") for n in (0, 1, 2)] == ["0 runs", "1 run", "2 runs"]


@given(st.floats(0, 1))
def test_a_p_value_has_three_digits(p: float) -> None:
    sign, _, number = p_value(p).partition(" ")
    assert (sign, number) == ("<", "0.001") if p < 0.001 else math.isclose(float(number), p, abs_tol=5.1e-4)
