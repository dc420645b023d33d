"""Trees of tables, as TOML and JSON have them: their leaves, and how two of them differ."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from typing import Any, TypeAlias

__all__ = ["Tree", "as_read", "differences", "leaves"]

Tree: TypeAlias = dict[str, Any]
"""Key -> value, list or table."""


def as_read(tables: Mapping[str, Any]) -> Tree:
    """Return tables as they are read back from a file: tuples are lists."""
    read: Tree = json.loads(json.dumps(tables))
    return read


def differences(
    then: Mapping[str, Any], now: Mapping[str, Any], words: tuple[str, str] = ("then", "now")
) -> list[str]:
    """Return a line for each value of two trees of tables that is not the same: its dotted key, then, now.

    Args:
        then: One tree.
        now: The other.
        words: What the lines call them.
    """
    before, after = dict(leaves(then)), dict(leaves(now))
    keys = [*before, *(key for key in after if key not in before)]
    missing = "nothing"
    return [
        f"{key}: {before.get(key, missing)!r} {words[0]}, {after.get(key, missing)!r} {words[1]}"
        for key in keys
        if before.get(key, missing) != after.get(key, missing)
    ]


def leaves(tree: Any, path: tuple[str, ...] = ()) -> Iterator[tuple[str, Any]]:
    """Return the dotted key and the value of each leaf of a tree of tables."""
    if isinstance(tree, Mapping) and (tree or not path):
        for key, value in tree.items():
            yield from leaves(value, (*path, str(key)))
    else:
        yield ".".join(path), tree
