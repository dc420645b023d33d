"""Tests for import cycles between modules, and between the parts of each package."""

from __future__ import annotations

from pathlib import Path

import pytest
from house import CORE, PACKAGES, circles, parts, uses

GRAPHS = {package.name: uses(package) for package in PACKAGES}
INNER = [
    (name, package)
    for name, graph in GRAPHS.items()
    for package in {m.rpartition(".")[0] for m in graph} - {""}
]


@pytest.mark.parametrize("name", GRAPHS)
def test_no_modules_import_each_other(name: str) -> None:
    assert circles(GRAPHS[name]) == []


@pytest.mark.parametrize(("name", "package"), sorted(INNER))
def test_no_parts_of_a_package_import_each_other(name: str, package: str) -> None:
    """Packages of the core are parts too: two packages must not require each other."""
    assert circles(parts(GRAPHS[name], package)) == []


class TestCircles:
    """The checks above can detect cycles."""

    def test_are_found_with_all_their_members(self) -> None:
        graph = {"a": {"b"}, "b": {"c"}, "c": {"a", "d"}, "d": {"e"}, "e": {"d"}, "f": {"a"}}
        assert circles(graph) == [["a", "b", "c"], ["d", "e"]]

    def test_between_packages_are_found_without_a_cycle_of_modules(self) -> None:
        graph = {"h.a.x": {"h.b.x"}, "h.a.y": set[str](), "h.b.x": set[str](), "h.b.y": {"h.a.y"}}
        assert circles(graph) == []
        assert circles(parts(graph, "h")) == [["a", "b"]]

    def test_count_imports_within_functions_and_for_type_checkers(self, tmp_path: Path) -> None:
        texts = {
            "__init__": "",
            "a": "from typing import TYPE_CHECKING\nif TYPE_CHECKING:\n    from house_of.b import B",
            "b": "def f():\n    from house_of import a",
        }
        (tmp_path / "house_of").mkdir()
        for name, text in texts.items():
            (tmp_path / "house_of" / f"{name}.py").write_text(text)
        assert circles(uses(tmp_path / "house_of")) == [["house_of.a", "house_of.b"]]

    def test_include_the_lazy_names_of_the_public_api(self) -> None:
        assert "evoframe.runs.starting" in GRAPHS[CORE.name]["evoframe"]
