"""Fixtures: the toy plugin, and its configurations and studies."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import attrs
import pytest
import toy_box
import toys
from toy_study import STUDY

from evoframe import run
from evoframe.config.resolve import load_config
from evoframe.contract.config import RunConfig
from evoframe.registry.registry import Plugins
from evoframe.study.plan import Planned, Study, read_study


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
    def load(*overrides: str, plugins: Plugins = toy_plugins) -> RunConfig:
        return load_config(toy_file, overrides=overrides, plugins=plugins)

    return load


@pytest.fixture
def toy_variant(toy_plugins: Plugins, tmp_path: Path) -> Callable[..., RunConfig]:
    """Return a function that loads a configuration with capabilities by its name."""

    def load(name: str, *overrides: str) -> RunConfig:
        return toy_box.variant(name, tmp_path, *overrides, plugins=toy_plugins)

    return load


@pytest.fixture
def toy_study(tmp_path: Path, toy_plugins: Plugins) -> Callable[..., Study]:
    (tmp_path / "toy.toml").write_text(toys.CONFIGURATION)

    def read(*overrides: str, text: str = STUDY) -> Study:
        (tmp_path / "study.toml").write_text(text)
        return read_study(tmp_path / "study.toml", overrides, toy_plugins)

    return read


@pytest.fixture
def made(toy_study: Callable[..., Study], tmp_path: Path) -> tuple[Study, Path, list[Planned]]:
    study, directory = toy_study("runs=1"), tmp_path / "here"
    planned = list(study.planned(directory))
    for each in planned:
        config = each.cell.config
        run(attrs.evolve(config, run=attrs.evolve(config.run, seed=each.seed)), out=each.directory)
    return study, directory, planned
