"""Configurations with comments."""

from __future__ import annotations

import itertools
from collections.abc import Callable
from pathlib import Path

import pytest
from toy_capabilities import VARIANTS

from evoframe import RunConfig
from evoframe.config import commented, load_config, preset_names, starter
from evoframe.documents.trees import leaves
from evoframe.registry.registry import Plugins


@pytest.mark.parametrize("preset", preset_names())
def test_a_commented_configuration_means_the_same(preset: str, tmp_path: Path) -> None:
    config = load_config(preset)
    path = tmp_path / "commented.toml"
    path.write_text(commented(config))
    assert load_config(path).tables() == config.tables()


@pytest.mark.parametrize("preset", preset_names())
def test_a_starter_means_its_preset(preset: str, tmp_path: Path) -> None:
    config = load_config(preset)
    path = tmp_path / "starter.toml"
    path.write_text(starter(config, preset))
    assert load_config(path).tables() == config.tables()


def test_every_option_of_a_starter_can_be_set(tmp_path: Path) -> None:
    """A starter whose options are all made active, as a user would by removing each #."""
    config = load_config("paper")
    path = tmp_path / "starter.toml"
    lines = starter(config, "paper").splitlines()
    path.write_text("\n".join(line.removeprefix("#") if line[1:2] != " " else line for line in lines))
    assert load_config(path).tables() == config.tables()


@pytest.mark.parametrize("name", VARIANTS)
def test_a_configuration_with_own_components_and_roles_means_the_same_with_comments(
    toy_variant: Callable[..., RunConfig], toy_plugins: Plugins, tmp_path: Path, name: str
) -> None:
    config = toy_variant(name)
    path = tmp_path / "commented.toml"
    path.write_text(commented(config))
    assert load_config(path, plugins=toy_plugins) == config
    (tmp_path / "base.toml").write_text(config.to_toml())
    path.write_text(starter(config, "base.toml"))
    assert load_config(path, plugins=toy_plugins) == config
    lines = starter(config, "base.toml").splitlines()
    path.write_text("\n".join(line.removeprefix("#") if line[1:2] != " " else line for line in lines))
    assert load_config(path, plugins=toy_plugins) == config


def test_every_key_has_a_comment_above_it() -> None:
    config = load_config("paper")
    lines = commented(config).splitlines()
    keys = {line.split(" = ")[0] for line in lines if " = " in line and not line.startswith("#")}
    for above, line in itertools.pairwise(lines):
        if " = " in line and not line.startswith(("#", "name = ")):
            assert above.startswith("#"), line
    named = {key.rpartition(".")[2].partition("[")[0] for key, _ in leaves(config.tables())}
    nested = {"origin", "size", "degrees_of_freedom"}  # in the inline tables of simulator.fixed
    assert named - nested <= keys
