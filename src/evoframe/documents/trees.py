"""Trees of tables, as in TOML and JSON: their leaves, and the differences of two trees."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from typing import Any, TypeAlias

__all__ = ["Tree", "as_read", "differences", "leaves"]

Tree: TypeAlias = dict[str, Any]
"""Key -> value, list or table."""


def as_read(tables: Mapping[str, Any]) -> Tree:
    """Return tables in the form that reading a file gives: lists instead of tuples."""
    read: Tree = json.loads(json.dumps(tables))
    return read


def differences(
    then: Mapping[str, Any], now: Mapping[str, Any], words: tuple[str, str] = ("then", "now")
) -> list[str]:
    """Return a line for each value that differs between two trees: its dotted key and both values.

    Args:
        then: The first tree.
        now: The second tree.
        words: Names of the two trees in the lines.
    """
    before, after = dict(_leaves(then, ())), dict(_leaves(now, ()))
    keys = [*before, *(key for key in after if key not in before)]
    return [
        f"{'.'.join(key)}: {before.get(key, _NOTHING)!r} {words[0]}, {after.get(key, _NOTHING)!r} {words[1]}"
        for key in keys
        if before.get(key, _NOTHING) != after.get(key, _NOTHING)
    ]


def leaves(tree: Any) -> Iterator[tuple[str, Any]]:
    """Yield the dotted key and the value of each leaf of a tree of tables."""
    return ((".".join(path), value) for path, value in _leaves(tree, ()))


class _Nothing:
    """Placeholder for a missing value; unequal to every value."""

    def __repr__(self) -> str:
        return "not set"


_NOTHING = _Nothing()


def _leaves(tree: Any, path: tuple[str, ...]) -> Iterator[tuple[tuple[str, ...], Any]]:
    if isinstance(tree, Mapping) and (tree or not path):
        for key, value in tree.items():
            yield from _leaves(value, (*path, str(key)))
    else:
        yield path, tree
