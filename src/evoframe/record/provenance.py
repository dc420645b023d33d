"""What a run was made with: people read it, and a run is resumed only with the same."""

from __future__ import annotations

import platform
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from evoframe._version import __version__
from evoframe.config.layers import Tree
from evoframe.contract.config import RunConfig

__all__ = ["differences", "leaves", "provenance"]


def provenance(config: RunConfig) -> Tree:
    """Return the table ``[provenance]``: versions, machine type, and where each component comes from."""
    components = dict(config.components())
    libraries = {"python": platform.python_version(), "numpy": np.__version__}
    for chosen in components.values():
        if hasattr(chosen.component, "provenance"):
            libraries |= chosen.component.provenance()
    vectors = np.show_config(mode="dicts").get("SIMD Extensions", {})
    return {
        "evoframe": __version__,
        "machine": platform.machine(),
        "vector_extensions": [*vectors.get("baseline", []), *vectors.get("found", [])],
        "c_library": " ".join(platform.libc_ver()),
        "libraries": libraries,
        "components": {key: str(chosen.source) for key, chosen in components.items()},
    }


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
