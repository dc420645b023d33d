"""Tests of imports: no input is executed, and every unusual module has a documented reason."""

from __future__ import annotations

import ast
import itertools
import re
import tomllib
from collections.abc import Iterator, Mapping
from pathlib import Path

import attrs
import pytest
from house import PACKAGES, ROOT

SOURCES = sorted(path for package in PACKAGES for path in package.rglob("*.py"))

USUAL = frozenset(
    [
        "__future__",
        "abc",
        "base64",
        "bisect",
        "codecs",
        "collections",
        "concurrent",
        "contextlib",
        "contextvars",
        "csv",
        "difflib",
        "enum",
        "errno",
        "functools",
        "graphlib",
        "hashlib",
        "heapq",
        "html",
        "importlib.metadata",
        "importlib.resources",
        "io",
        "itertools",
        "json",
        "logging",
        "math",
        "numbers",
        "os",
        "pathlib",
        "platform",
        "queue",
        "random",
        "re",
        "select",
        "shlex",
        "signal",
        "stat",
        "statistics",
        "string",
        "struct",
        "sys",
        "textwrap",
        "threading",
        "time",
        "tokenize",
        "tomllib",
        "traceback",
        "types",
        "typing",
        "warnings",
        "zipfile",
        "zlib",
    ]
)
"""Modules of the standard library that do not execute their input."""


@attrs.frozen
class Unusual:
    """A module that could be unsafe, or that exists on one platform only.

    Attributes:
        reason: Reason for its use.
        users: Files that may import it.
    """

    reason: str
    users: set[str]


UNUSUAL: Mapping[str, Unusual] = {
    "configparser": Unusual(
        "neat-python reads its options with it; the text is generated from a frozen class",
        {"plugins/evolvers/evoframe_evolvers/cppn/genomes.py"},
    ),
    "fcntl": Unusual(
        "requests a signal from Linux when the parent process ends", {"src/evoframe/workers/child.py"}
    ),
    "importlib": Unusual(
        "loads evoframe's own modules on demand, and plugins that the user installed or named",
        {
            "src/evoframe/cli/program.py",
            "src/evoframe/record/run.py",
            "src/evoframe/registry/discovery.py",
        },
    ),
    "multiprocessing.connection": Unusual(
        "waits for connections to be ready, and reads none", {"src/evoframe/workers/child.py"}
    ),
    "multiprocessing.reduction": Unusual(
        "pickles the messages between a program and its workers, never from a file or a network",
        {"plugins/executors/evoframe_executors/worker.py", "src/evoframe/workers/channel.py"},
    ),
    "multiprocessing.spawn": Unusual(
        "lets workers import the main program, as multiprocessing does",
        {"src/evoframe/workers/child.py", "src/evoframe/workers/process.py"},
    ),
    "socket": Unusual(
        "connects a program with its workers by pairs of sockets without a name",
        {
            "src/evoframe/workers/channel.py",
            "src/evoframe/workers/child.py",
            "src/evoframe/workers/process.py",
        },
    ),
    "subprocess": Unusual(
        "starts workers: the running interpreter, with a program of its own",
        {"src/evoframe/workers/process.py"},
    ),
    "sqlite3": Unusual(
        "opens databases for reading with an untrusted schema, and attaches no others",
        {"src/evoframe/record/database.py", "src/evoframe/record/store.py"},
    ),
    "tempfile": Unusual(
        "creates directories of files that are read by name only: neat-python's options, unfinished reports",
        {"plugins/evolvers/evoframe_evolvers/cppn/genomes.py", "src/evoframe/analysis/output/writing.py"},
    ),
}

NAMES_OF_MODULES = {
    "cffi": set[str](),
    "matplotlib": {"matplotlib", "mpl_toolkits"},
    "neat_python": {"neat"},
    "python_slugify": {"slugify"},
}
"""Distributions whose modules have other names; cffi builds the bindings and is not imported."""

BARE = frozenset({"eval", "exec", "compile", "__import__"})
"""Functions that execute text."""

CALLED = frozenset(
    (
        "dlopen",
        "exec_module",
        "execv",
        "execve",
        "popen",
        "read_pickle",
        "spawnv",
        "startfile",
        "system",
        "to_pickle",
    )
)
"""Methods that execute code or programs."""

EXECUTING = {
    ("src/evoframe/registry/discovery.py", "exec_module"): "loads a plugin file that the user named with -p"
}


def dependencies() -> set[str]:
    """Return the modules of the dependencies of evoframe and its extras."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    wanted = [*project["dependencies"], *itertools.chain(*project["optional-dependencies"].values())]
    distributions = {re.split(r"[^A-Za-z0-9_-]", text)[0].replace("-", "_").lower() for text in wanted}
    return {module for name in distributions for module in NAMES_OF_MODULES.get(name, {name})}


DEPENDENCIES = dependencies()


def shown(path: Path) -> str:
    return str(path.relative_to(ROOT))


def imported(tree: ast.AST) -> Iterator[str]:
    """Yield the dotted names of all imports in a file, including nested ones."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            yield from (f"{node.module}.{alias.name}" for alias in node.names)


def rule_of(name: str) -> str | None:
    """Return the longest entry of the lists above that covers a name."""
    pieces = name.split(".")
    covering = [".".join(pieces[:length]) for length in range(len(pieces), 0, -1)]
    own = pieces[0] == "evoframe" or pieces[0].startswith("evoframe_")
    known = USUAL | UNUSUAL.keys() | DEPENDENCIES | ({pieces[0]} if own else set())
    return next((entry for entry in covering if entry in known), None)


def refused_imports(path: str, tree: ast.AST) -> list[str]:
    """Return the forbidden imports of a file."""
    refused = []
    for name in imported(tree):
        rule = rule_of(name)
        if rule is None or (rule in UNUSUAL and path not in UNUSUAL[rule].users):
            refused.append(name)
    return refused


def refused_calls(path: str, tree: ast.AST) -> list[str]:
    """Return the calls in a file that execute, or could execute, their arguments."""
    calls = [node for node in ast.walk(tree) if isinstance(node, ast.Call)]
    return [ast.unparse(call) for call in calls if _is_refused(path, call)]


def _is_refused(path: str, call: ast.Call) -> bool:
    function = call.func
    if isinstance(function, ast.Name) and function.id in BARE:
        return True
    if isinstance(function, ast.Attribute):
        if function.attr in CALLED and (path, function.attr) not in EXECUTING:
            return True
        if ast.unparse(function) == "yaml.load":
            return True
    return any(
        keyword.arg in ("shell", "allow_pickle") and ast.unparse(keyword.value) != "False"
        for keyword in call.keywords
    )


@pytest.mark.parametrize("path", SOURCES, ids=shown)
def test_only_listed_modules_are_imported(path: Path) -> None:
    assert refused_imports(shown(path), ast.parse(path.read_text(encoding="utf-8"))) == []


@pytest.mark.parametrize("path", SOURCES, ids=shown)
def test_no_input_is_executed(path: Path) -> None:
    assert refused_calls(shown(path), ast.parse(path.read_text(encoding="utf-8"))) == []


@pytest.mark.parametrize("name", UNUSUAL)
def test_unusual_modules_are_imported_only_by_their_listed_users(name: str) -> None:
    users = {shown(path) for path in SOURCES if name in map(rule_of, imported(ast.parse(path.read_text())))}
    assert users == UNUSUAL[name].users


def test_every_usual_module_is_used() -> None:
    used = {rule_of(name) for path in SOURCES for name in imported(ast.parse(path.read_text()))}
    assert used >= USUAL


@pytest.mark.parametrize(
    "text",
    [
        "import pickle",
        "from pickle import loads",
        "import subprocess",
        "import ctypes",
        "import yaml",
        "import shelve",
        "import multiprocessing",
        "def f():\n    import marshal",
        "from importlib import import_module",
        "import sqlite3 as innocent",
    ],
)
def test_an_import_that_is_not_listed_is_refused(text: str) -> None:
    assert refused_imports("src/evoframe/anywhere.py", ast.parse(text))


@pytest.mark.parametrize(
    "text",
    [
        "eval(text)",
        "exec(compile(text, '', 'exec'))",
        "__import__(name)",
        "yaml.load(text)",
        "os.system(text)",
        "numpy.load(path, allow_pickle=True)",
        "numpy.load(path, allow_pickle=trusted)",
        "run(text, shell=True)",
        "pandas.read_pickle(path)",
        "spec.loader.exec_module(module)",
    ],
)
def test_a_call_that_executes_is_refused(text: str) -> None:
    assert refused_calls("src/evoframe/anywhere.py", ast.parse(text))


@pytest.mark.parametrize(
    "text", ["re.compile(text)", "numpy.load(path, allow_pickle=False)", "json.loads(text)"]
)
def test_a_call_that_does_not_execute_is_accepted(text: str) -> None:
    assert not refused_calls("src/evoframe/anywhere.py", ast.parse(text))
