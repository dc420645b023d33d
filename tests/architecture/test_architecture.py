"""Who may import whom, and what is public."""

from __future__ import annotations

import types
from pathlib import Path

import pytest
from house import PACKAGES, ROOT, imports_of

import evoframe

PLUGIN_FILES = sorted(ROOT.glob("plugins/*/evoframe_*/**/*.py"))


def test_there_are_plugins() -> None:
    assert {path.parents[1] for path in PLUGIN_FILES} >= set((ROOT / "plugins").iterdir())


@pytest.mark.parametrize("path", PLUGIN_FILES, ids=lambda path: f"{path.parent.name}/{path.name}")
def test_plugins_import_only_the_public_api(path: Path) -> None:
    for module, name in imports_of(path):
        if module.split(".")[0] == "evoframe":
            assert module == "evoframe", f"{path}: {module}"
            assert name in evoframe.__all__, f"{path}: {name}"


@pytest.mark.parametrize("path", sorted((ROOT / "src").rglob("*.py")), ids=lambda path: path.name)
def test_the_core_imports_no_plugin(path: Path) -> None:
    assert not [module for module, _ in imports_of(path) if module.startswith("evoframe_")]


@pytest.mark.parametrize("name", evoframe.__all__)
def test_public_names_exist_and_say_what_they_are(name: str) -> None:
    value = getattr(evoframe, name)
    if isinstance(value, type | types.FunctionType):
        assert value.__doc__


def test_every_package_is_typed() -> None:
    assert len(PACKAGES) > 1
    assert all((package / "py.typed").exists() for package in PACKAGES)
