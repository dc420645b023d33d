"""Short names of configurations, from their base and its overrides."""

from __future__ import annotations

import re
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from evoframe.config.layers import Layer
from evoframe.documents import leaves

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
        parts |= {key: _part(key, value) for key, value in leaves(layer.tree)}
    parts.pop("run.seed", None)
    kept = [part for key, part in parts.items() if key.split(".")[0] not in _WITHOUT_EFFECT]
    label = "-".join([Path(source).stem, *kept])
    return label if len(label) <= _LONGEST else Path(source).stem


def _part(key: str, value: Any) -> str:
    name = key.rpartition(".")[2]
    text = str(value) if name == "name" else f"{name}{value}"
    return re.sub(r"[^A-Za-z0-9._]+", "-", text).strip("-.")
