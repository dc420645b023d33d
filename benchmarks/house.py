"""Structure of the source: modules in each folder, the longest chain of imports, circular imports, functions.

``python -m benchmarks.house [CHECKOUT]``, by default this one; nothing in it is imported or executed.
"""

from __future__ import annotations

import ast
import statistics
import sys
from collections import Counter
from collections.abc import Iterator, Mapping
from functools import cache
from pathlib import Path

import attrs

__all__ = ["Form", "form_of"]

_Modules = Mapping[str, tuple[Path, ast.Module]]
_Graph = Mapping[str, frozenset[str]]


@attrs.frozen
class Form:
    """Figures of a source tree from its syntax.

    Attributes:
        folders: Folder -> number of its modules.
        lines: Number of lines of all modules.
        code: Number of lines without imports, ``__all__``, docstrings, comments and blank lines.
        chain: Number of modules on the longest chain of imports; a circle counts as one.
        circles: Sets of modules that import each other.
        functions: Lengths of all functions, in lines.
        private: Number of functions whose names begin with an underscore.
        used_once: Number of private functions named only once in their module.
    """

    folders: Mapping[str, int]
    lines: int
    code: int
    chain: int
    circles: tuple[frozenset[str], ...]
    functions: tuple[int, ...]
    private: int
    used_once: int


def form_of(root: Path) -> Form:
    """Return the figures of the Python packages of a checkout: core, plugins and bindings."""
    modules = dict(_modules(root))
    graph = {name: frozenset(_imported(tree, modules)) - {name} for name, (_, tree) in modules.items()}
    reached = {name: _reached(graph, name) for name in graph}
    circles = {frozenset(n for n in reached[name] if name in reached[n]) | {name} for name in graph}

    @cache
    def chain(circle: frozenset[str]) -> int:
        above = {other for name in circle for other in graph[name]} - circle
        return 1 + max((chain(next(c for c in circles if name in c)) for name in above), default=0)

    functions = [
        (tree, node)
        for _, tree in modules.values()
        for node in ast.walk(tree)
        if isinstance(node, ast.FunctionDef)
    ]
    private = [(t, f) for t, f in functions if f.name.startswith("_") and not f.name.startswith("__")]
    named = {tree: _named(tree) for tree, _ in private}
    texts = [(path.read_text(encoding="utf-8").splitlines(), tree) for path, tree in modules.values()]
    return Form(
        folders=Counter(path.parent.relative_to(root).as_posix() for path, _ in modules.values()),
        lines=sum(len(lines) for lines, _ in texts),
        code=sum(_code(lines, tree) for lines, tree in texts),
        chain=max(map(chain, circles)),
        circles=tuple(circle for circle in circles if len(circle) > 1),
        functions=tuple((node.end_lineno or node.lineno) - node.lineno + 1 for _, node in functions),
        private=len(private),
        used_once=sum(named[tree][node.name] == 1 for tree, node in private),
    )


def _modules(root: Path) -> Iterator[tuple[str, tuple[Path, ast.Module]]]:
    for base in (root / "src", *sorted((root / "plugins").iterdir()), *sorted(root.glob("lib*"))):
        for path in sorted(base.glob("evoframe*/**/*.py")):
            parts = path.relative_to(base).with_suffix("").parts
            name = ".".join(parts[:-1] if parts[-1] == "__init__" else parts)
            yield name, (path, ast.parse(path.read_text(encoding="utf-8")))


def _imported(tree: ast.Module, modules: _Modules) -> Iterator[str]:
    """Yield the modules that a module imports, also within its functions."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names if alias.name in modules)
        elif isinstance(node, ast.ImportFrom) and node.module:
            inner = [f"{node.module}.{alias.name}" for alias in node.names]
            yield from (name if name in modules else node.module for name in inner if node.module in modules)


def _reached(graph: _Graph, start: str) -> set[str]:
    reached: set[str] = set()
    waiting = [start]
    while waiting:
        new = graph[waiting.pop()] - reached
        reached |= new
        waiting += new
    return reached


def _named(tree: ast.Module) -> Counter[str]:
    nodes = list(ast.walk(tree))
    names = [node.id for node in nodes if isinstance(node, ast.Name)]
    return Counter([*names, *(node.attr for node in nodes if isinstance(node, ast.Attribute))])


def _code(lines: list[str], tree: ast.Module) -> int:
    """Return the number of lines without imports, ``__all__``, docstrings, comments and blank lines."""
    idle = set()
    for node in ast.walk(tree):
        text = isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant)
        listed = isinstance(node, ast.Assign) and getattr(node.targets[0], "id", "") == "__all__"
        if isinstance(node, ast.Import | ast.ImportFrom) or text or listed:
            idle |= set(range(node.lineno, (node.end_lineno or node.lineno) + 1))  # type: ignore[attr-defined]
    numbered = enumerate((line.strip() for line in lines), start=1)
    return sum(bool(line) and not line.startswith("#") and number not in idle for number, line in numbered)


def main() -> None:
    """Print the figures of a checkout."""
    root = Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).parents[1]
    form = form_of(root)
    for folder, count in sorted(form.folders.items()):
        print(f"{count:4} modules in {folder}")  # noqa: T201 - a program
    share = form.used_once / form.private
    print(  # noqa: T201 - a program
        f"{sum(form.folders.values())} modules, {form.lines:,} lines, {form.code:,} of code\n"
        f"longest chain of imports: {form.chain}; circles: {len(form.circles)}\n"
        f"{len(form.functions)} functions of {statistics.mean(form.functions):.2f} lines on average\n"
        f"{form.used_once} of {form.private} private functions are used once ({share:.0%})"
    )


if __name__ == "__main__":
    main()
