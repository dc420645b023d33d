"""What a C library shows to the linker, and to the loader of its extension; subclassed for each library."""

import functools
import importlib
import shutil
import subprocess
import sys
import tempfile
from graphlib import TopologicalSorter
from pathlib import Path

import attrs
import pytest

ROOT = Path(__file__).parent.parent.parent
_LEADING = "_" if sys.platform == "darwin" else ""  # what the platform puts before each name


@attrs.frozen
class Symbols:
    """Names that a file defines for others, and names that it needs from others."""

    defined: frozenset[str]
    needed: frozenset[str]


def _tool(name: str) -> str:
    path = shutil.which(name)
    if path is None:
        pytest.fail(f"{name} is not installed; it comes with the compiler")
    return path


def symbols_of(path: Path, *, dynamic: bool = False) -> Symbols:
    """Return the global symbols of a file; only those that a loader sees if *dynamic*."""
    options = ["-D"] if dynamic and sys.platform != "darwin" else []
    listing = subprocess.run(
        [_tool("nm"), "-g", *options, str(path)], check=True, capture_output=True, text=True
    ).stdout
    entries = [line.split()[-2:] for line in listing.splitlines() if line]
    names = {(kind, name.removeprefix(_LEADING)) for kind, name in entries}
    needed = frozenset(name for kind, name in names if kind in "Uw")
    return Symbols(frozenset(name for _, name in names) - needed, needed)


def sources_of(library: str) -> list[Path]:
    """Return the C files of a library, but for what cffi may have left."""
    return [path for path in sorted((ROOT / library).rglob("*.c")) if f"evoframe_{library}" not in path.parts]


@functools.cache
def _objects(library: str) -> dict[str, Symbols]:
    """Return the symbols of the object code of each C file, by the file's name."""
    folders = ["-I", str(ROOT / library / "include"), "-I", str(ROOT / library)]
    sources = sources_of(library)
    with tempfile.TemporaryDirectory() as place:
        command = [_tool("cc"), "-std=c11", "-O0", *folders, "-c", *map(str, sources)]
        subprocess.run(command, check=True, cwd=place)
        return {path.name: symbols_of(Path(place, f"{path.stem}.o")) for path in sources}


class SymbolTests:
    """Tests of a library's symbols; the subclass says which."""

    library: str
    prefix: str

    def test_global_symbols_have_the_prefix_of_the_library(self) -> None:
        """So that a program can link it with any other."""
        names = {name for symbols in _objects(self.library).values() for name in symbols.defined}
        assert f"{self.prefix}_status_message" in names
        assert [name for name in sorted(names) if not name.startswith(f"{self.prefix}_")] == []

    def test_no_two_files_need_each_other(self) -> None:
        objects = _objects(self.library)
        where = {name: file for file, symbols in objects.items() for name in symbols.defined}
        needs = {
            file: {where[name] for name in symbols.needed & where.keys()} for file, symbols in objects.items()
        }
        assert len(list(TopologicalSorter(needs).static_order())) == len(objects)

    def test_the_extension_shows_only_how_it_is_imported(self) -> None:
        extension = importlib.import_module(f"evoframe_{self.library}._{self.prefix}")
        assert extension.__file__
        shown = symbols_of(Path(extension.__file__), dynamic=True).defined
        assert shown == {f"PyInit__{self.prefix}"}
