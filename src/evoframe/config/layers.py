"""Merging of presets, files and overrides into one tree of tables that records the origin of each value."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from importlib.resources import files
from pathlib import Path
from typing import Any

import attrs

from evoframe.contract import COMPONENTS, POPULATION_COMPONENTS, ROLE_COMPONENTS
from evoframe.documents import Tree
from evoframe.errors import ConfigurationError, InputError
from evoframe.files import TOO_DEEP, exists, is_too_deep, parsed_toml, read_text
from evoframe.messages import found, suggestion

__all__ = [
    "Layer",
    "Layers",
    "layer_of",
    "layers_in",
    "layers_of",
    "preset_names",
    "read_layers",
]

_KEY = re.compile(r"[A-Za-z0-9_-]+(\.[A-Za-z0-9_-]+)*")
_BARE_WORD = re.compile(r"[A-Za-z_][A-Za-z0-9_.:/-]*")
_LARGEST_FILE = 16  # MiB
_LONGEST_SHOWN = 86  # characters of a source in an error about its depth


@attrs.frozen
class Layer:
    """One source of settings.

    Attributes:
        origin: Name of the source in errors, such as a file name, ``preset 'paper'`` or ``--set run.seed=2``.
        tree: The tables; components are tables with ``name``.
    """

    origin: str
    tree: Tree


@attrs.frozen
class Layers:
    """Settings in the order in which they override each other; the last one wins.

    Attributes:
        layers: The settings.
        local_plugins: Names of the local plugins (``-p``) with which a run of these settings was started.
        source: Name of the preset, or path of the file, from which they were read; empty for others.
    """

    layers: tuple[Layer, ...]
    local_plugins: tuple[str, ...] = ()
    source: str = ""

    def merged(self) -> Tree:
        """Return the merged tree of all layers."""
        result: Tree = {}
        for layer in self.layers:
            result = _merge(result, layer.tree, ())
        return result

    def under(self, overrides: Iterable[str | Layer]) -> Layers:
        """Return a copy with *overrides* on top, given as for :func:`read_layers`."""
        if isinstance(overrides, str):
            raise TypeError("overrides must be a list of strings, not a string")
        on_top = [given if isinstance(given, Layer) else _override(given) for given in overrides]
        for layer in on_top:
            if is_too_deep(layer.tree):  # also values from Python, and long keys
                raise ConfigurationError(TOO_DEEP, source=_shown(layer.origin))
        return attrs.evolve(self, layers=(*self.layers, *map(_with_component_tables, on_top)))

    def without(self, *keys: str) -> Layers:
        """Return a copy without some top-level keys."""
        kept = (
            Layer(layer.origin, {key: value for key, value in layer.tree.items() if key not in keys})
            for layer in self.layers
        )
        return attrs.evolve(self, layers=tuple(kept))

    def origin(self, *paths: tuple[str, ...]) -> str:
        """Return the origin of the latest value at *paths*; a missing value counts as its nearest table."""
        return self.layers[max(map(self._level, paths))].origin

    def _level(self, path: tuple[str, ...]) -> int:
        for length in range(len(path), 0, -1):
            for level in range(len(self.layers) - 1, -1, -1):
                if _has(self.layers[level].tree, path[:length]):
                    return level
        return 0


def preset_names() -> list[str]:
    """Return the names of the built-in presets."""
    return sorted(
        entry.name.removesuffix(".toml")
        for entry in files("evoframe.config").joinpath("presets").iterdir()
        if entry.name.endswith(".toml")
    )


def read_layers(source: str | Path, overrides: Iterable[str | Layer] = ()) -> Layers:
    """Read a preset or file and the ones that it extends, and add the *overrides*.

    Args:
        source: Name of a preset, or path of a TOML file.
        overrides: Layers, or ``key=value`` with a dotted key and a TOML value, as for ``--set``; the last one
            wins.

    Raises:
        ConfigurationError: A file or an override cannot be read.
    """
    return Layers((), source=str(source)).under(_chain(str(source), Path(), ())).under(overrides)


def layers_in(tables: Mapping[str, Any], origin: str) -> Layers:
    """Return the layers for the tables of a complete configuration.

    Args:
        tables: Tables of a run's ``config.toml``.
        origin: Path of that file.
    """
    own = {key: value for key, value in tables.items() if key not in ("extends", "provenance")}
    return Layers((), _local_plugins(tables), origin).under([Layer(origin, own)])


def _local_plugins(tables: Mapping[str, Any]) -> tuple[str, ...]:
    """Return the local plugins in the provenance of a run."""
    components = tables.get("provenance", {}).get("components", {})
    sources = components.values() if isinstance(components, Mapping) else ()
    found = (re.fullmatch(r"'(\w+)' of \1 local", str(source)) for source in sources)
    return tuple(dict.fromkeys(match.group(1) for match in found if match))


def layer_of(origin: str, key: str, value: Any) -> Layer:
    """Return the layer that sets one dotted *key*."""
    tree: Any = value
    for part in reversed(key.split(".")):
        tree = {part: tree}
    return Layer(origin, tree)


def layers_of(*settings: Mapping[str, Any]) -> list[Layer]:
    """Return a layer for each dotted key of *settings* from Python code; ``None`` leaves a key unset."""
    given = [item for each in settings for item in each.items() if item[1] is not None]
    return [layer_of(f"{key}={value!r}", key, value) for key, value in given]


@attrs.frozen
class _Source:
    """A preset or a file.

    Attributes:
        preset: Name of the preset, or ``None``.
        path: Path of the file, or ``None``.
    """

    preset: str | None = None
    path: Path | None = None

    def __str__(self) -> str:
        return f"preset '{self.preset}'" if self.path is None else str(self.path)

    def equals(self, other: _Source) -> bool:
        if self.path is None or other.path is None:
            return self == other
        return self.path.resolve() == other.path.resolve()

    def text(self) -> str:
        if self.path is None:
            return files("evoframe.config").joinpath("presets", f"{self.preset}.toml").read_text("utf-8")
        return read_text(self.path, _LARGEST_FILE)


def _chain(name: str, relative_to: Path, seen: tuple[_Source, ...]) -> list[Layer]:
    """Return the layer of a preset or file, preceded by those that it extends."""
    try:
        source = _source(name, relative_to, seen)
        text = source.text()
    except InputError as error:
        if seen:
            raise _extends_error(seen[-1], str(error)) from error
        raise ConfigurationError(error.problem, source=error.source, key=error.key) from error
    if any(source.equals(other) for other in seen):
        chain = " -> ".join(map(str, [*seen, source]))
        raise _extends_error(source, f"a file must not extend itself: {chain}")
    tree = parsed_toml(text, str(source), ConfigurationError)
    tree.pop("provenance", None)  # information that a run wrote, not settings
    layer = Layer(str(source), tree)
    base = tree.pop("extends", False if source.preset == "paper" else "paper")
    if base is False:
        return [layer]
    if not isinstance(base, str) or not base:
        raise _extends_error(source, f"expected the name of a preset or file, or false; found {found(base)}")
    return [*_chain(base, source.path.parent if source.path else Path(), (*seen, source)), layer]


def _source(name: str, relative_to: Path, seen: tuple[_Source, ...]) -> _Source:
    """Return the preset or file with this *name*, which the last of *seen* extends."""
    known, path = preset_names(), relative_to / name
    if name in known:
        return _Source(preset=name)
    if not exists(path):
        hint = suggestion(name, known, "presets")
        if seen:
            raise _extends_error(seen[-1], f"no such preset or file as {found(name)}{hint}")
        raise ConfigurationError(f"no such preset or file{hint}", source=name)
    return _Source(path=path)


def _extends_error(source: _Source, problem: str) -> ConfigurationError:
    return ConfigurationError(problem, source=source, key="extends")


def _shown(origin: str) -> str:
    return origin if len(origin) <= _LONGEST_SHOWN else f"{origin[:_LONGEST_SHOWN]}..."


def _override(text: str) -> Layer:
    key, equals, value = text.partition("=")
    key = key.strip()
    if not equals or not _KEY.fullmatch(key):
        raise ConfigurationError(
            "expected key=value, as in aggregator=hm or run.seed=2", source=f"--set {text}"
        )
    return layer_of(f"--set {text}", key, _value(text, value.strip()))


def _value(text: str, value: str) -> Any:
    if _BARE_WORD.fullmatch(value) and value not in ("true", "false", "inf", "nan"):
        return value
    tree = parsed_toml(f"value = {value}", f"--set {text}", ConfigurationError)
    if list(tree) != ["value"]:
        raise ConfigurationError("the right side must be one TOML value", source=f"--set {text}")
    return tree["value"]


def _is_component(path: tuple[str, ...]) -> bool:
    if len(path) == 1:
        return path[0] in COMPONENTS
    parts = {"populations": POPULATION_COMPONENTS, "roles": ROLE_COMPONENTS}
    return len(path) == 3 and path[2] in parts.get(path[0], ())


def _with_component_tables(layer: Layer) -> Layer:
    def convert(value: Any, path: tuple[str, ...]) -> Any:
        if _is_component(path) and isinstance(value, str):
            return {"name": value}
        if isinstance(value, dict) and not _is_component(path):
            return {key: convert(inner, (*path, key)) for key, inner in value.items()}
        return value

    return Layer(layer.origin, convert(layer.tree, ()))


def _merge(base: Any, over: Any, path: tuple[str, ...]) -> Any:
    if not (isinstance(base, dict) and isinstance(over, dict)):
        return over
    if _is_component(path) and "name" in over and over["name"] != base.get("name"):
        return over  # drop the options of the other component
    merged = dict(base)
    for key, value in over.items():
        merged[key] = _merge(base[key], value, (*path, key)) if key in base else value
    return merged


def _has(tree: Any, path: tuple[str, ...]) -> bool:
    for part in path:
        key = part.split("[", 1)[0]
        if not isinstance(tree, dict) or key not in tree:
            return False
        tree = tree[key]
    return True
