"""Hints for unknown keys, chosen from all keys that a configuration can have."""

from __future__ import annotations

import difflib
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import attrs

from evoframe.config.layers import read_layers
from evoframe.contract import (
    COMPONENTS,
    POPULATION_COMPONENTS,
    ROLE_COMPONENTS,
    PluginSettings,
    PopulationConfig,
    RunSettings,
)
from evoframe.documents import Fault, Tree, leaves, option_names
from evoframe.errors import ConfigurationError
from evoframe.messages import suggestion
from evoframe.registry import Plugins

__all__ = ["SECTIONS", "known_keys", "settings_like", "similar_keys", "unknown_key", "with_hints"]

SECTIONS = ("run", "populations", "roles", *COMPONENTS, "plugins")
"""The top-level keys of a configuration."""

_MOST_HINTS = 4
_ALIASES = {kind: key for key, kind in COMPONENTS.items()}  # kind of component -> its key


def known_keys(tree: Tree, plugins: Plugins) -> list[str]:
    """Return the dotted keys of a configuration, with all options of the components that it chooses."""
    populations = tree.get("populations")
    keys = [*SECTIONS, *_under("run", RunSettings), *_under("plugins", PluginSettings)]
    for key, kind in COMPONENTS.items():
        keys += _component_keys(key, kind, tree.get(key), plugins)
    for role, table in populations.items() if isinstance(populations, Mapping) else ():
        if isinstance(table, Mapping):
            plain = [n for n in option_names(PopulationConfig) if n not in POPULATION_COMPONENTS]
            keys += [f"populations.{role}", *(f"populations.{role}.{name}" for name in plain)]
            for key, kind in POPULATION_COMPONENTS.items():
                path = f"populations.{role}.{key}"
                keys += [path, *_component_keys(path, kind, table.get(key), plugins)]
    roles = tree.get("roles")
    for name, table in roles.items() if isinstance(roles, Mapping) else ():
        if isinstance(table, Mapping):
            keys += [f"roles.{name}", f"roles.{name}.draw"]
            for key, kind in ROLE_COMPONENTS.items():
                path = f"roles.{name}.{key}"
                keys += [path, *_component_keys(path, kind, table.get(key), plugins)]
    return keys


def settings_like(word: str, plugins: Plugins) -> list[str]:
    """Return the keys of the preset ``paper`` that *word* may mean, at most four."""
    return similar_keys(word, known_keys(read_layers("paper").merged(), plugins))[:_MOST_HINTS]


def similar_keys(key: str, known: Sequence[str]) -> list[str]:
    """Return the *known* keys that end with *key*; if there are none, those that end with a similar word."""
    meant = _ALIASES.get(key, key)
    exact = [meant] if meant in known else [each for each in known if each.endswith(f".{meant}")]
    if exact:
        return exact
    words = {each.rpartition(".")[2] for each in known}
    words |= {kind for kind, section in _ALIASES.items() if section in known}
    close = difflib.get_close_matches(key, sorted(words), n=1, cutoff=0.75)
    return [each for word in close for each in similar_keys(word, known)]


def unknown_key(key: str, value: Any, tree: Tree, plugins: Plugins) -> str:
    """Return the message about an unknown top-level *key* with this *value*."""
    known = known_keys(tree, plugins)
    dotted = [f"{key}.{inner}" for inner, _ in leaves(value)] if isinstance(value, Mapping) else []
    meant = [each for inner in dotted for each in _ending_with(inner, known)] or similar_keys(key, known)
    kinds = plugins.kinds_of(value) if isinstance(value, str) else []
    if not meant:
        meant = [_ALIASES[kind] for kind in kinds if kind in _ALIASES]
    meant = [f"{each}={value}" if COMPONENTS.get(each) in kinds else each for each in meant]
    return f"unknown key{_question(meant) or suggestion(key, SECTIONS, 'keys')}"


def with_hints(faults: Sequence[Fault], known: Sequence[str]) -> list[Fault]:
    """Return *faults* with hints: an unknown option may be an option of another table."""
    return [fault if fault.options is None else _with_hint(fault, fault.options, known) for fault in faults]


def _with_hint(fault: Fault, options: Sequence[str], known: Sequence[str]) -> Fault:
    hint = _question(_ending_with(fault.path[-1], known))
    if not hint:
        return fault
    message = f"unknown option{hint} options: {', '.join(options)}" if options else f"{fault.message}{hint}"
    return attrs.evolve(fault, message=message)


def _question(meant: Sequence[str]) -> str:
    words = [f"'{each}'" for each in dict.fromkeys(meant)]
    more = [] if len(words) <= _MOST_HINTS else ["another key of this name"]
    return f"; did you mean {' or '.join([*words[:_MOST_HINTS], *more])}?" if words else ""


def _ending_with(key: str, known: Sequence[str]) -> list[str]:
    return [each for each in known if each.endswith(f".{key}")]


def _component_keys(path: str, kind: str, table: Any, plugins: Plugins) -> Iterator[str]:
    if isinstance(table, Mapping) and isinstance(table.get("name"), str):
        try:
            component = plugins.find(kind, table["name"]).component
        except ConfigurationError:  # reported where the component is chosen
            return
        yield from _under(path, component)


def _under(path: str, class_: type[Any]) -> Iterator[str]:
    return (f"{path}.{name}" for name in option_names(class_))
