"""Short names of configurations, from their base and its overrides."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any

from evoframe.config.layers import Layer

__all__ = ["label_of"]

_LONGEST = 60
_WITHOUT_EFFECT = ("executor", "plugins")  # on the result


def label_of(source: str | Path, overrides: Iterable[Layer]) -> str:
    """Return a short name that distinguishes a configuration from others, such as ``paper-hm-n5``.

    Args:
        source: Name of a preset, or path of a TOML file.
        overrides: Settings that override it; components add their name, options their key and value.
    """
    parts: dict[str, str] = {}  # the last setting of a key wins, as in the configuration
    for layer in overrides:
        for path, value in _settings(layer.tree, ()):
            parts[".".join(path)] = _part(path, value)
    parts.pop("run.seed", None)
    kept = [part for key, part in parts.items() if key.split(".")[0] not in _WITHOUT_EFFECT]
    label = "-".join([Path(source).stem, *kept])
    return label if len(label) <= _LONGEST else Path(source).stem


def _settings(tree: Mapping[str, Any], path: tuple[str, ...]) -> Iterator[tuple[tuple[str, ...], Any]]:
    for key, value in tree.items():
        if isinstance(value, Mapping):
            yield from _settings(value, (*path, key))
        else:
            yield (*path, key), value


def _part(path: tuple[str, ...], value: Any) -> str:
    text = str(value) if path[-1] == "name" else f"{path[-1]}{value}"
    return re.sub(r"[^A-Za-z0-9._]+", "-", text).strip("-.")
