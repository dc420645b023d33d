"""Options that a configuration can set: meaning, type and range, from the classes that hold them."""

from __future__ import annotations

import re
import types
from collections.abc import Iterator
from typing import Any, Literal, Union, get_args, get_origin, get_type_hints

import attrs
import docstring_parser

__all__ = ["Option", "options_of", "summary_of"]

_BOUND = re.compile(r"<Validator for x (.+?)>(?=[,)>\s]|$)")
_NUMBER = re.compile(r"(?<=[<>=] )\S+")
_CHOICES = re.compile(r"options \((.*?)\)")
_NAMES = {bool: "true or false", int: "whole number", float: "number", str: "text"}


@attrs.frozen
class Option:
    """An option that a configuration can set.

    Attributes:
        name: Its key.
        meaning: Its description in the docstring of its class; empty if there is none.
        kind: Its type in words, such as ``whole number``.
        allowed: Its range, such as ``>= 0, <= 1``; empty if every value of the type is allowed.
        table: The class of its own options, if its value is a table or a list of tables.
    """

    name: str
    meaning: str
    kind: str
    allowed: str
    table: type | None

    @property
    def expected(self) -> str:
        """The type and range in one phrase."""
        return ", ".join(part for part in (self.kind, self.allowed) if part)


def options_of(class_: type) -> dict[str, Option]:
    """Return the options of a frozen attrs class by name, in the order of its fields."""
    meanings, hints = _meanings(class_), get_type_hints(class_)
    return {
        field.name: Option(
            field.name,
            meanings.get(field.name, ""),
            _kind(hints[field.name]),
            _range(field.validator),
            _table(hints[field.name]),
        )
        for field in attrs.fields(class_)
        if field.init
    }


def summary_of(class_: type) -> str:
    """Return the first line of a class's docstring; empty if it has none."""
    return _flat(docstring_parser.parse(class_.__doc__ or "", _GOOGLE).short_description)


_GOOGLE = docstring_parser.DocstringStyle.GOOGLE


def _meanings(class_: type) -> dict[str, str]:
    """Return the descriptions of the attributes of a class and of its base classes."""
    found: dict[str, str] = {}
    for base in reversed(class_.__mro__):
        for parameter in docstring_parser.parse(base.__doc__ or "", _GOOGLE).params:
            found[parameter.arg_name] = _flat(parameter.description)
    return found


def _flat(text: str | None) -> str:
    return " ".join((text or "").replace("``", "").split())


def _kind(hint: Any) -> str:
    origin, arguments = get_origin(hint), get_args(hint)
    if origin is Literal:
        return f"one of {', '.join(map(str, arguments))}"
    if origin in (Union, types.UnionType):
        return " or ".join(_kind(argument) for argument in arguments if argument is not type(None))
    if origin is tuple and arguments[-1] is not Ellipsis:
        return f"list of {len(arguments)} values: {_kind(arguments[0])}"
    if origin in (tuple, list):
        return f"list: {_kind(arguments[0])}"
    return _NAMES.get(hint, "table")


def _table(hint: Any) -> type | None:
    """Return the first attrs class in a type."""
    if isinstance(hint, type) and attrs.has(hint):
        return hint
    return next((found for argument in get_args(hint) if (found := _table(argument))), None)


def _range(validator: Any) -> str:
    """Return the bounds and choices that a validator states in its ``repr``, as those of attrs do."""
    return ", ".join(_stated(repr(validator))) if validator is not None else ""


def _stated(text: str) -> Iterator[str]:
    for match in _BOUND.finditer(text):
        yield _NUMBER.sub(lambda number: f"{float(number.group()):g}", match.group(1))
    for match in _CHOICES.finditer(text):
        yield f"one of {match.group(1).replace(chr(39), '')}"
