"""Tests of the layout of the test suite: each module has a test file at the corresponding path."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Mapping
from pathlib import Path

import pytest
from house import CORE, PLUGIN_PACKAGES, ROOT

TESTS = ROOT / "tests"

ELSEWHERE: Mapping[str, str] = {
    **{
        f"src/evoframe/testing/{kind}s.py": f"tests/testing/test_{kind}_contract.py"
        for kind in ("aggregator", "credit", "encoder", "evolver", "executor", "objective", "simulator")
    },
    "src/evoframe/testing/roles.py": "tests/testing/test_role_contract.py",
    "src/evoframe/testing/strategies.py": "tests/testing/test_strategy_contract.py",
}
"""Modules whose tests have another name: the contracts are tests, tested by violating them."""

UNTESTED: Mapping[str, str] = {
    "src/evoframe/analysis/api.py": "forwards calls; covered by tests of studies and reports",
    "src/evoframe/__main__.py": "starts the program; covered by tests of the command line",
    "src/evoframe/_version.py": "contains only a number",
    "src/evoframe/runs/blame.py": "names components in errors; covered by tests of misbehaving components",
    "src/evoframe/runs/restoring.py": "covered by tests of resuming, of the doctor and of warm starts",
    "src/evoframe/testing/encounters.py": "simulated turns; covered by tests of the contract of strategies",
    "src/evoframe/testing/evolving.py": "shared by the laws of evolvers; covered by their tests",
    "src/evoframe/testing/laws.py": "shared by contracts; covered by tests of all contracts",
}
"""Modules without their own tests -> reason."""

FOLDERS: Mapping[str, str] = {
    "architecture": "checks of the source as a whole",
    "benchmarks": "the programs in benchmarks/",
    "browser": "pages of reports in Chromium",
    "data": "files that tests read",
    "experiment": "the paper's experiment, compared with its documents",
    "fuzz": "generated inputs",
    "latex": "tables of reports, typeset by pdflatex",
    "libcppn": "the C library and its binding",
    "libvox": "the C library and its binding",
    "plugins": "a folder for each plugin in plugins/",
    "support": "modules shared by tests",
    "survival": "kills and damage, across all packages",
    "texts": "texts that people read, in one snapshot",
    "third_party": "distributions of third parties",
}
"""Folders of tests that do not mirror a package -> contents."""


def has_tests_to_find(path: Path) -> bool:
    """Return whether a module has code to test; most ``__init__`` modules only re-export names."""
    if path.name != "__init__.py":
        return True
    return any(isinstance(node, ast.ClassDef) for node in ast.parse(path.read_text()).body)


def mirrored() -> Iterator[tuple[Path, Path]]:
    """Yield each module, and the file that its tests belong into."""
    for package in (CORE, *PLUGIN_PACKAGES):
        folder = TESTS if package == CORE else TESTS / "plugins" / package.parent.name
        for path in filter(has_tests_to_find, sorted(package.rglob("*.py"))):
            inner = path.relative_to(package)
            name = package.parent.name if path.name == "__init__.py" else path.stem
            yield path, folder / inner.parent / f"test_{name}.py"


def filled(folder: Path) -> Iterator[str]:
    """Yield the names of folders that contain files other than compiled ones."""
    for path in folder.iterdir():
        if path.is_dir() and any(
            each.is_file() and "__pycache__" not in each.parts for each in path.rglob("*")
        ):
            yield path.name


MIRRORED = {str(path.relative_to(ROOT)): tests for path, tests in mirrored()}


@pytest.mark.parametrize("module", MIRRORED)
def test_every_module_has_tests(module: str) -> None:
    tests = ROOT / ELSEWHERE[module] if module in ELSEWHERE else MIRRORED[module]
    assert tests.is_file() or module in UNTESTED, f"{module} needs {tests.relative_to(ROOT)}"


@pytest.mark.parametrize("module", [*ELSEWHERE, *UNTESTED])
def test_exceptions_are_still_required(module: str) -> None:
    assert module in MIRRORED
    assert not MIRRORED[module].exists()


def test_every_folder_of_tests_mirrors_a_package_or_is_listed() -> None:
    rooms = {path.parent.name for path in CORE.glob("*/__init__.py")}
    folders = set(filled(TESTS))
    assert folders - rooms == FOLDERS.keys()


@pytest.mark.parametrize("package", [CORE, *PLUGIN_PACKAGES], ids=lambda package: package.name)
def test_no_folder_of_tests_mirrors_a_missing_package(package: Path) -> None:
    folder = TESTS if package == CORE else TESTS / "plugins" / package.parent.name
    others = FOLDERS if package == CORE else ()
    for path in folder.rglob("test_*.py"):
        inner = path.parent.relative_to(folder)
        if not inner.parts or inner.parts[0] not in others:
            assert (package / inner / "__init__.py").exists(), f"{path}: there is no {package.name}/{inner}"


def test_every_plugin_has_a_folder_of_tests() -> None:
    assert set(filled(TESTS / "plugins")) == {package.parent.name for package in PLUGIN_PACKAGES}
