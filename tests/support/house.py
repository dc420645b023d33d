"""The source of evoframe: its modules, their imports, and import cycles."""

from __future__ import annotations

import ast
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path

__all__ = [
    "CORE",
    "PACKAGES",
    "PLUGIN_PACKAGES",
    "ROOT",
    "circles",
    "imports_of",
    "modules_of",
    "parts",
    "uses",
]

ROOT = Path(__file__).parents[2]
CORE = ROOT / "src" / "evoframe"
PLUGIN_PACKAGES = sorted(path.parent for path in ROOT.glob("plugins/*/evoframe_*/__init__.py"))
PACKAGES = [CORE, *PLUGIN_PACKAGES, *sorted(path.parent for path in ROOT.glob("lib*/evoframe_*/__init__.py"))]


def modules_of(package: Path) -> dict[str, Path]:
    """Return dotted name -> file of each module of a package; ``__init__`` has the name of its package."""
    found = {}
    for path in sorted(package.rglob("*.py")):
        parts = path.relative_to(package.parent).with_suffix("").parts
        found[".".join(parts[:-1] if parts[-1] == "__init__" else parts)] = path
    return found


def imports_of(path: Path) -> list[tuple[str, str]]:
    """Return (module, name) of all imports in a file, including nested ones."""
    found = []
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            found += [(alias.name, "") for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            found += [(node.module or "", alias.name) for alias in node.names]
    return found


def uses(package: Path) -> dict[str, set[str]]:
    """Return module -> imported modules within a package; its stub defines the imports of lazy names."""
    modules = modules_of(package)
    graph = {name: set(_targets(imports_of(path), modules)) - {name} for name, path in modules.items()}
    stub = package / "__init__.pyi"
    if stub.exists():
        relative = [(f"{package.name}.{module}", name) for module, name in imports_of(stub)]
        graph[package.name] |= set(_targets(relative, modules))
    return graph


def _targets(imports: Iterable[tuple[str, str]], modules: Iterable[str]) -> Iterator[str]:
    for module, name in imports:
        if f"{module}.{name}" in modules:
            yield f"{module}.{name}"
        elif module in modules:
            yield module


def parts(graph: Mapping[str, Iterable[str]], package: str) -> dict[str, set[str]]:
    """Return part -> imported parts of a package; parts are its modules and inner packages."""

    def part(module: str) -> str:
        return module.removeprefix(f"{package}.").partition(".")[0]

    inner = {module for module in graph if module.startswith(f"{package}.")}
    found: dict[str, set[str]] = {part(module): set() for module in inner}
    for module in inner:
        found[part(module)] |= {part(used) for used in graph[module] if used in inner} - {part(module)}
    return found


def circles(graph: Mapping[str, Iterable[str]]) -> list[list[str]]:
    """Return the cycles: sets of nodes that reach each other, each sorted."""
    reached = {node: _reached(graph, node) for node in graph}
    found = {tuple(sorted(n for n in reached[node] if node in reached[n])) for node in graph}
    return sorted(list(circle) for circle in found if circle)


def _reached(graph: Mapping[str, Iterable[str]], start: str) -> set[str]:
    reached: set[str] = set()
    waiting = [start]
    while waiting:
        new = set(graph[waiting.pop()]) - reached
        reached |= new
        waiting += new
    return reached
