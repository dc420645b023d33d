"""Descriptions of options."""

from __future__ import annotations

from typing import Literal

import attrs
import pytest
from attrs import validators

from evoframe.config.options import options_of, summary_of
from evoframe.registry import discover
from evoframe.registry.registry import Offer


@attrs.frozen
class Inner:
    """A table.

    Attributes:
        depth: Depth, m.
    """

    depth: float = 1.0


@attrs.frozen
class Base:
    """A base class.

    Attributes:
        inherited: Described in the base class.
    """

    inherited: int = attrs.field(default=1, validator=validators.ge(1))


@attrs.frozen
class Sample(Base):
    """A ``component`` of a test.

    Attributes:
        share: A ``share``, described
            on two lines.
        color: A color.
        rule: A rule.
        limit: A limit, if set.
        shape: Size along x, y and z.
        counts: Positive numbers.
        inner: A nested table.
    """

    share: float = attrs.field(default=0.5, validator=[validators.ge(0.0), validators.le(1.0)])
    color: Literal["red", "green"] = "red"
    rule: str = attrs.field(default="max", validator=validators.in_(("max", "mean")))
    limit: float | None = attrs.field(default=None, validator=validators.optional(validators.gt(0.0)))
    shape: tuple[int, int, int] = (1, 2, 3)
    counts: tuple[int, ...] = attrs.field(default=(1,), validator=validators.deep_iterable(validators.ge(1)))
    inner: Inner = Inner()
    undocumented: bool = False


@pytest.mark.parametrize(
    ("name", "meaning", "expected"),
    [
        ("inherited", "Described in the base class.", "whole number, >= 1"),
        ("share", "A share, described on two lines.", "number, >= 0, <= 1"),
        ("color", "A color.", "one of red, green"),
        ("rule", "A rule.", "text, one of max, mean"),
        ("limit", "A limit, if set.", "number, > 0"),
        ("shape", "Size along x, y and z.", "list of 3 values: whole number"),
        ("counts", "Positive numbers.", "list: whole number, >= 1"),
        ("inner", "A nested table.", "table"),
        ("undocumented", "", "true or false"),
    ],
)
def test_an_option_has_meaning_type_and_range(name: str, meaning: str, expected: str) -> None:
    option = options_of(Sample)[name]
    assert (option.meaning, option.expected) == (meaning, expected)


def test_options_keep_the_order_of_the_fields() -> None:
    assert list(options_of(Sample)) == [field.name for field in attrs.fields(Sample)]


def test_a_nested_table_names_its_class() -> None:
    options = options_of(Sample)
    assert {name: option.table for name, option in options.items() if option.table} == {"inner": Inner}


def test_a_summary_is_the_first_line_of_the_docstring() -> None:
    assert summary_of(Sample) == "A component of a test."


@pytest.mark.parametrize("offer", discover().offers, ids=lambda offer: f"{offer.kind} {offer.name}")
def test_every_option_of_a_built_in_component_is_described(offer: Offer) -> None:
    assert summary_of(offer.component)
    assert [name for name, option in options_of(offer.component).items() if not option.meaning] == []
