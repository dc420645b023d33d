"""Configurations as TOML with a comment above every option."""

from __future__ import annotations

import textwrap
from collections.abc import Iterator, Mapping
from typing import Any

import tomli_w

from evoframe.config.options import Option, options_of, summary_of
from evoframe.contract import (
    COMPONENTS,
    POPULATION_COMPONENTS,
    ROLE_COMPONENTS,
    PluginSettings,
    PopulationConfig,
    RoleConfig,
    RunConfig,
    RunSettings,
)
from evoframe.documents import Tree

__all__ = ["commented", "starter"]

_WIDTH = 100


def commented(config: RunConfig) -> str:
    """Return a configuration as TOML with the meaning, type and range of every option as comments."""
    return "\n".join(["extends = false", *_sections(config, active=True)]) + "\n"


def starter(config: RunConfig, base: str) -> str:
    """Return a starting configuration that extends *base*, with every option of *config* commented out.

    Args:
        config: The resolved configuration of *base*.
        base: The preset that the file extends, or the path of another file from its directory.
    """
    head = [
        *_comment(f"Settings that are not set here are those of the preset {base}."),
        f"extends = {_inline(base)}",
        "",
        *_comment("To change an option, remove the # in front of it. Components are chosen by name."),
    ]
    return "\n".join([*head, *_sections(config, active=False)]) + "\n"


def _sections(config: RunConfig, *, active: bool) -> Iterator[str]:
    tables, components = config.tables(), dict(config.components())
    yield from _section("run", tables["run"], RunSettings, active=active)
    for role, table in tables["populations"].items():
        yield from _section(f"populations.{role}", table, PopulationConfig, active=active)
        for part in (part for part in POPULATION_COMPONENTS if part in table):
            key = f"populations.{role}.{part}"
            yield from _section(key, table[part], type(components[key].component), active=active)
    for name, table in tables.get("roles", {}).items():
        yield from _section(f"roles.{name}", table, RoleConfig, active=active)
        key = f"roles.{name}.provider"
        yield from _section(key, table["provider"], type(components[key].component), active=active)
    for key in COMPONENTS:
        yield from _section(key, tables[key], type(components[key].component), active=active)
    yield from _section("plugins", tables["plugins"], PluginSettings, active=active)


def _section(path: str, table: Tree, class_: type, *, active: bool) -> Iterator[str]:
    """Yield the lines of a table and of its nested tables, but not of components."""
    yield ""
    if "name" in table:
        yield from _comment(summary_of(class_))
    yield f"[{path}]"
    if "name" in table:
        yield f"name = {_inline(table['name'])}"
    options = {
        name: option for name, option in options_of(class_).items() if not _has_own_section(class_, name)
    }
    nested = [n for n, option in options.items() if option.table and isinstance(table.get(n), Mapping)]
    for name, option in options.items():
        if name not in nested:
            yield from _option(name, table.get(name), option, active=active)
    for name in nested:
        inner = options[name].table
        if inner is not None:
            yield from _section(f"{path}.{name}", table[name], inner, active=active)


def _has_own_section(class_: type, option: str) -> bool:
    return (class_ is PopulationConfig and option in POPULATION_COMPONENTS) or (
        class_ is RoleConfig and option in ROLE_COMPONENTS
    )


def _option(name: str, value: Any, option: Option, *, active: bool) -> Iterator[str]:
    yield from _comment(f"{option.meaning} [{option.expected}]".strip())
    if value is None:
        yield f"# {name} is not set"
        return
    text = f"{name} = {_inline(value)}"
    yield text if active else f"#{text}"


def _inline(value: Any) -> str:
    """Return a value as TOML on one line."""
    if isinstance(value, Mapping):
        return f"{{ {', '.join(f'{key} = {_inline(inner)}' for key, inner in value.items())} }}"
    if isinstance(value, list | tuple):
        return f"[{', '.join(map(_inline, value))}]"
    return tomli_w.dumps({"x": value}).removeprefix("x = ").rstrip()


def _comment(text: str) -> list[str]:
    return [f"# {line}" for line in textwrap.wrap(text, _WIDTH)]
