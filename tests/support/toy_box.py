"""The toy components as an installed plugin."""

from __future__ import annotations

from pathlib import Path

import toy_capabilities
import toys

from evoframe import RunConfig
from evoframe.config.resolve import load_config
from evoframe.contract.config import Source
from evoframe.registry.registry import Plugins


def installed() -> Plugins:
    plugins = Plugins()
    add_to(plugins)
    return plugins


def add_to(plugins: Plugins) -> None:
    """Add the toy components to other plugins."""
    plugins.add(toys, Source("toy-box", "1.0", "toys"))
    plugins.add(toy_capabilities, Source("toy-box", "1.0", "capabilities"))


def variant(name: str, directory: Path, *overrides: str, plugins: Plugins | None = None) -> RunConfig:
    """Return a configuration of :data:`toy_capabilities.VARIANTS`, whose file is written to *directory*."""
    text, own = toy_capabilities.VARIANTS[name]
    path = directory / f"{name.replace(' ', '-')}.toml"
    path.write_text(text)
    return load_config(path, overrides=[*own, *overrides], plugins=plugins or installed())
