"""Tests for shadowed names: ``import evoframe.x`` and ``evoframe.x`` always mean the same object."""

from __future__ import annotations

import ast
from pathlib import Path

import pytest
from house import CORE, PLUGIN_PACKAGES, ROOT

import evoframe

INITS = [path for package in (CORE, *PLUGIN_PACKAGES) for path in sorted(package.rglob("__init__.py"))]


def submodules(package: Path) -> set[str]:
    """Return the names of the modules and packages directly in a package."""
    inner = {path.parent.name for path in package.glob("*/__init__.py")}
    return inner | {path.stem for path in package.glob("*.py")} - {"__init__"}


def bound(init: Path) -> dict[str, str]:
    """Return the names that an ``__init__`` defines, and the origin of each."""
    found: dict[str, str] = {}
    for node in ast.parse(init.read_text()).body:
        if isinstance(node, ast.ImportFrom):
            found |= {alias.asname or alias.name: f"{node.module}.{alias.name}" for alias in node.names}
        elif isinstance(node, ast.FunctionDef | ast.ClassDef):
            found[node.name] = "here"
        elif isinstance(node, ast.Assign):
            found |= {target.id: "here" for target in node.targets if isinstance(target, ast.Name)}
        elif isinstance(node, ast.AnnAssign) and isinstance(node.target, ast.Name):
            found[node.target.id] = "here"
    return found


def test_no_module_has_a_public_name() -> None:
    assert submodules(CORE) & set(evoframe.__all__) == set()


@pytest.mark.parametrize("init", INITS, ids=lambda path: str(path.parent.relative_to(ROOT)))
def test_no_package_shadows_its_own_modules(init: Path) -> None:
    names = bound(init)
    shadowed = {name: names[name] for name in submodules(init.parent) & names.keys()}
    itself = {
        name: origin for name, origin in shadowed.items() if origin.endswith(f"{init.parent.name}.{name}")
    }
    assert shadowed == itself  # a package may import its own modules


def test_shadowed_names_are_found(tmp_path: Path) -> None:
    """The check above can fail."""
    for name in ("run", "tools"):
        (tmp_path / f"{name}.py").write_text("")
    (tmp_path / "__init__.py").write_text("from here.run import run\nfrom here import tools\n")
    assert submodules(tmp_path) & bound(tmp_path / "__init__.py").keys() == {"run", "tools"}
    assert bound(tmp_path / "__init__.py") == {"run": "here.run.run", "tools": "here.tools"}
