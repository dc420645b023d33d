"""The toy plugin, and configurations made of it."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
import toy_box
import toys

from evoframe.config import RunConfig
from evoframe.plugins import Plugins
from evoframe.resolve import load_config


@pytest.fixture
def toy_plugins() -> Plugins:
    return toy_box.installed()


@pytest.fixture
def toy_file(tmp_path: Path) -> Path:
    path = tmp_path / "toy.toml"
    path.write_text(toys.CONFIGURATION)
    return path


@pytest.fixture
def toy_config(toy_plugins: Plugins, toy_file: Path) -> Callable[..., RunConfig]:
    def load(*overrides: str) -> RunConfig:
        return load_config(toy_file, overrides=overrides, plugins=toy_plugins)

    return load
