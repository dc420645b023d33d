"""Tests of the boundaries between core and plugins, and of the public API."""

from __future__ import annotations

import types
from pathlib import Path

import pytest
from house import PACKAGES, ROOT, imports_of

import evoframe

PLUGIN_FILES = sorted(ROOT.glob("plugins/*/evoframe_*/**/*.py"))


def test_every_plugin_has_files() -> None:
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
def test_public_names_exist_and_are_documented(name: str) -> None:
    value = getattr(evoframe, name)
    if isinstance(value, type | types.FunctionType):
        assert value.__doc__


def test_every_package_is_typed() -> None:
    assert len(PACKAGES) > 1
    assert all((package / "py.typed").exists() for package in PACKAGES)
