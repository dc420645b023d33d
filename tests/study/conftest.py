"""Studies of toys."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import attrs
import pytest
import toy_box
import toys
from toy_study import STUDY

from evoframe import run
from evoframe.plugins import Plugins
from evoframe.study.plan import Planned, Study, read_study


@pytest.fixture
def toy_plugins() -> Plugins:
    return toy_box.installed()


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
