"""Strict conversion of TOML values into typed attrs classes; all faults are reported together."""

from __future__ import annotations

import contextlib
import functools
import math
import numbers
import re
from collections.abc import Callable, Iterator, Mapping
from types import NoneType, UnionType
from typing import Any, Literal, TypeVar, Union, get_args, get_origin

import attrs
import numpy as np
from cattrs import (
    BaseValidationError,
    ClassValidationError,
    Converter,
    ForbiddenExtraKeysError,
    IterableValidationError,
    IterableValidationNote,
)
from cattrs.gen import make_dict_structure_fn, override

from evoframe.messages import found, suggestion

__all__ = ["Fault", "StructureError", "option_names", "structure", "unstructure"]

T = TypeVar("T")
Path = tuple[str, ...]


@attrs.frozen
class Fault:
    """A fault in a configuration.

    Attributes:
        path: Keys that lead to the value; an index is part of its key, as in ``weights[1]``.
        message: Value found, value expected, and the remedy.
        involves: Another key that contributes to the fault, if any.
        options: Valid options, if the last key of *path* is unknown; otherwise ``None``.
    """

    path: Path
    message: str
    involves: Path = ()
    options: tuple[str, ...] | None = None


class StructureError(ValueError):
    """Values that do not match their type.

    Attributes:
        faults: All faults, in order.
    """

    def __init__(self, faults: list[Fault]) -> None:
        super().__init__("; ".join(f"{'.'.join(fault.path)}: {fault.message}" for fault in faults))
        self.faults = faults


def structure(value: Any, target: type[T], path: Path) -> T:
    """Return *value* as an instance of *target*.

    Raises:
        StructureError: The value is invalid; contains all faults, their paths beginning with *path*.
    """
    try:
        return _converter().structure(value, target)
    except Exception as error:
        faults = list(_faults(error, path))
        raise StructureError(faults) from error


def option_names(class_: type[Any]) -> Iterator[str]:
    """Yield the dotted names of the options of an attrs class, those of nested classes included."""
    with contextlib.suppress(NameError):  # an annotation that only a type checker can resolve
        attrs.resolve_types(class_)
    for field in attrs.fields(class_):
        if field.init:
            yield field.name
            if isinstance(field.type, type) and attrs.has(field.type):
                yield from (f"{field.name}.{inner}" for inner in option_names(field.type))


def unstructure(instance: Any) -> Any:
    """Return *instance* as TOML values, without options that are ``None``, which TOML cannot express.

    Instances that have a method ``as_table`` are written as the table that it returns.
    """
    return _without_none(_converter().unstructure(instance))


def _without_none(value: Any) -> Any:
    if isinstance(value, Mapping):
        return {key: _without_none(inner) for key, inner in value.items() if inner is not None}
    if isinstance(value, list | tuple):
        return [_without_none(inner) for inner in value]
    return value


@functools.cache
def _converter() -> Converter:
    converter = Converter(forbid_extra_keys=True, detailed_validation=True)
    converter.register_structure_hook(bool, _bool)
    converter.register_structure_hook(int, _int)
    converter.register_structure_hook(float, _float)
    converter.register_structure_hook(str, _str)
    converter.register_structure_hook_func(functools.partial(_is_a, Literal), _literal)
    converter.register_structure_hook_func(
        functools.partial(_is_a, tuple), functools.partial(_tuple, converter)
    )
    converter.register_structure_hook_func(functools.partial(_is_a, dict), _table)
    converter.register_structure_hook_func(_is_union, functools.partial(_union, converter))
    converter.register_structure_hook_factory(attrs.has, functools.partial(_class_hook, converter))
    converter.register_structure_hook_func(_is_generic, _instance)
    converter.register_unstructure_hook_func(_has_table, lambda instance: instance.as_table())
    return converter


def _is_generic(type_: Any) -> bool:
    return attrs.has(get_origin(type_) or object)


def _has_table(class_: Any) -> bool:
    return hasattr(class_, "as_table")


def _instance(value: Any, type_: Any) -> Any:
    """Return an instance of a generic class, which only its maker can create from a table."""
    class_ = get_origin(type_)
    if not isinstance(value, class_):
        raise TypeError(f"expected a table with the key 'name', found {found(value)}")
    return value


def _is_a(origin: Any, type_: Any) -> bool:
    return get_origin(type_) is origin


def _is_union(type_: Any) -> bool:
    """Return whether several types are allowed; cattrs handles one type or ``None``."""
    return get_origin(type_) in (Union, UnionType) and len(_alternatives(type_)) > 1


def _alternatives(union: Any) -> list[Any]:
    return [type_ for type_ in get_args(union) if type_ is not NoneType]


def _bool(value: Any, _: Any) -> bool:
    if not isinstance(value, bool):
        raise TypeError(f"expected true or false, found {found(value)}")
    return value


def _int(value: Any, _: Any) -> int:
    if isinstance(value, bool) or not isinstance(value, numbers.Integral):
        raise TypeError(f"expected a whole number, found {found(value)}")
    return int(value)


def _float(value: Any, _: Any) -> float:
    if isinstance(value, bool) or not isinstance(value, numbers.Real):
        raise TypeError(f"expected a number, found {found(value)}")
    if not math.isfinite(value):
        raise ValueError(f"expected a finite number, found {value}")
    return float(value)


def _str(value: Any, _: Any) -> str:
    if not isinstance(value, str):
        raise TypeError(f"expected a string, found {found(value)}")
    return value


def _literal(value: Any, target: Any) -> Any:
    if value not in get_args(target):
        raise ValueError(f"expected {_expected(target)}, found {found(value)}")
    return value


def _union(converter: Converter, value: Any, target: Any) -> Any:
    """Return *value* as the first of the types that accepts it.

    Of a list or table with faults inside, only these are reported; any other value has none of the types.
    """
    if value is None and NoneType in get_args(target):
        return None
    for type_ in _alternatives(target):
        try:
            return converter.structure(value, type_)
        except BaseValidationError:
            raise
        except (TypeError, ValueError):
            continue
    expected = " or ".join(_expected(type_) for type_ in _alternatives(target))
    raise TypeError(f"expected {expected}, found {found(value)}")


_EXPECTED = {
    bool: "true or false",
    int: "a whole number",
    float: "a number",
    str: "a string",
    tuple: "a list",
}


def _expected(type_: Any) -> str:
    """Return a type in words; a type without a name of its own is written as a table."""
    if _is_a(Literal, type_):
        return f"one of {', '.join(found(choice) for choice in get_args(type_))}"
    return _EXPECTED.get(get_origin(type_) or type_, "a table")


def _table(value: Any, _: Any) -> dict[str, Any]:
    """Return a table; its values are not checked."""
    if not isinstance(value, Mapping):
        raise TypeError(f"expected a table, found {found(value)}")
    return dict(value)


def _tuple(converter: Converter, value: Any, target: Any) -> tuple[Any, ...]:
    if isinstance(value, np.ndarray):
        value = value.tolist()
    if not isinstance(value, list | tuple):
        raise TypeError(f"expected a list, found {found(value)}")
    types = get_args(target)
    if len(types) == 2 and types[1] is Ellipsis:
        types = (types[0],) * len(value)
    if len(types) != len(value):
        raise ValueError(f"expected a list of {len(types)}, found {found(value)}")
    items, errors = [], []
    for index, (item, type_) in enumerate(zip(value, types, strict=True)):
        try:
            items.append(converter.structure(item, type_))
        except Exception as error:  # noqa: BLE001 - collected, and raised below with the others
            error.add_note(IterableValidationNote(f"item {index}", index, type_))
            errors.append(error)
    if errors:
        raise IterableValidationError("items of a list", errors, target)
    return tuple(items)


def _class_hook(converter: Converter, class_: type[Any]) -> Callable[[Any, Any], Any]:
    """Structure a table into *class_*, running each field's validator in addition to the type checks.

    attrs alone stops at the first validator that fails; here every fault of a table is reported.
    """
    overrides = {
        field.name: override(struct_hook=functools.partial(_field, converter, field))
        for field in attrs.fields(attrs.resolve_types(class_))
        if field.init
    }
    hook = make_dict_structure_fn(
        class_,
        converter,
        _cattrs_forbid_extra_keys=True,
        _cattrs_detailed_validation=True,
        **overrides,  # type: ignore[arg-type]
    )

    def structure_table(value: Any, target: Any) -> Any:
        if not isinstance(value, Mapping):
            raise TypeError(f"expected a table, found {found(value)}")
        return hook(value, target)

    return structure_table


def _field(converter: Converter, field: attrs.Attribute[Any], value: Any, _: Any) -> Any:
    structured = converter.structure(value, field.type)  # type: ignore[arg-type]
    if field.validator is not None:
        # A validator that compares fields fails here, without an instance; it runs at construction.
        try:
            field.validator(None, field, structured)
        except AttributeError:
            return structured
    return structured


def _faults(error: BaseException, path: Path) -> Iterator[Fault]:
    if isinstance(error, ClassValidationError):
        noted, others = error.group_exceptions()
        for inner, note in noted:
            yield from _faults(inner, (*path, note.name))
        for inner in others:
            yield from _faults(inner, path)
    elif isinstance(error, IterableValidationError):
        noted_items, others = error.group_exceptions()
        for inner, index_note in noted_items:
            yield from _faults(inner, (*path[:-1], f"{path[-1]}[{index_note.index}]"))
        for inner in others:
            yield from _faults(inner, path)
    elif isinstance(error, ForbiddenExtraKeysError):
        for key in sorted(error.extra_fields):
            yield _unknown_option((*path, key), error.cl)
    elif isinstance(error, KeyError):  # its key may already end the path
        key = str(error.args[0])
        yield Fault(path if path[-1:] == (key,) else (*path, key), "is missing")
    else:
        yield Fault(path, _plain(str(error)))


def _unknown_option(path: Path, class_: type[Any]) -> Fault:
    options = tuple(field.name for field in attrs.fields(class_) if field.init)
    return Fault(path, f"unknown option{suggestion(path[-1], options, 'options')}", options=options)


_VALIDATOR = re.compile(r"'\w+' (must .*): (.*)", re.DOTALL)


def _plain(message: str) -> str:
    """Rewrite messages of attrs' validators (``'n' must be >= 1: 0``) in the form of all other messages."""
    match = _VALIDATOR.fullmatch(message)
    return f"{match[1]}, found {match[2]}" if match else message
