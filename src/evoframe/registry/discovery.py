"""Discovery of plugins; an installed plugin that fails to load is skipped."""

from __future__ import annotations

import hashlib
import importlib
import importlib.metadata
import importlib.util
import os
import sys
import warnings
from collections.abc import Iterable
from pathlib import Path
from types import ModuleType

from evoframe.contract import Source
from evoframe.errors import PluginError, PluginWarning
from evoframe.files import encodable
from evoframe.messages import cause_of
from evoframe.registry.registry import Plugins, Skipped, normalized

__all__ = ["discover"]

GROUP = "evoframe"
"""Entry point group of plugins."""


def discover(modules: Iterable[str] = ()) -> Plugins:
    """Load the installed plugins and the local *modules*.

    The environment variables ``EVOFRAME_PLUGINS_BLOCK`` and ``EVOFRAME_PLUGINS_REQUIRE`` list the
    distributions, separated by commas, that are blocked or required.

    Args:
        modules: Importable names, or paths of Python files, of plugins without a distribution.

    Raises:
        PluginError: A local module, or a required distribution, cannot be used.

    Warns:
        PluginWarning: An installed plugin cannot be used and was skipped.
    """
    plugins = Plugins()
    blocked = {normalized(name) for name in _listed("EVOFRAME_PLUGINS_BLOCK")}
    for source, entry_point in _entry_points():
        if normalized(source.distribution) not in blocked:
            _load_guarded(plugins, source, entry_point)
    for module in dict.fromkeys(modules):
        _load_local(plugins, module)
    plugins.require(_listed("EVOFRAME_PLUGINS_REQUIRE"))
    return plugins


def _listed(variable: str) -> list[str]:
    return [name.strip() for name in os.environ.get(variable, "").split(",") if name.strip()]


def _entry_points() -> list[tuple[Source, importlib.metadata.EntryPoint]]:
    """Return the entry points of the group, in an order that does not depend on the file system."""
    found = []
    for entry_point in importlib.metadata.entry_points(group=GROUP):
        distribution = entry_point.dist
        name = distribution.name if distribution else "unknown"
        version = distribution.version if distribution else "unknown"
        found.append((Source(name, version, entry_point.name), entry_point))
    return sorted(found, key=lambda pair: pair[0])


def _load_guarded(plugins: Plugins, source: Source, entry_point: importlib.metadata.EntryPoint) -> None:
    try:
        plugins.add(entry_point.load(), source)
    except (Exception, SystemExit) as error:  # noqa: BLE001 - a faulty plugin must not affect others
        cause = cause_of(error)
        plugins.skipped.append(Skipped(source, cause))
        warnings.warn(f"plugin {source} is skipped: {cause}", PluginWarning, stacklevel=3)


def _load_local(plugins: Plugins, module: str) -> None:
    name = Path(module).stem if module.endswith(".py") else module
    try:
        loaded, shown = _import_local(module, name), encodable(name)
        plugins.add(loaded, Source(shown, "local", shown, _digest(loaded)))
    except (Exception, SystemExit) as error:
        cause = cause_of(error)
        raise PluginError(f"cannot be used as a plugin: {cause}", source=module) from error


def _import_local(module: str, name: str) -> ModuleType:
    if not module.endswith(".py"):
        here = str(Path.cwd())
        if here not in sys.path:
            sys.path.insert(0, here)
        return importlib.import_module(module)
    path = Path(module)
    if not path.is_file():
        raise PluginError("no such file")
    private = f"evoframe_local_{name}"  # a local random.py must not replace Python's
    spec = importlib.util.spec_from_file_location(private, path)
    if spec is None or spec.loader is None:
        raise PluginError("not a Python module")
    loaded = importlib.util.module_from_spec(spec)
    sys.modules[private] = loaded  # attrs looks up modules when it creates classes
    try:
        spec.loader.exec_module(loaded)
    except BaseException:
        del sys.modules[private]
        raise
    return loaded


def _digest(module: ModuleType) -> str:
    """Return the SHA-256 of the source of a module: its file, or all Python files of its package."""
    parent = sys.modules.get(module.__spec__.parent or "") if module.__spec__ else None
    roots = [Path(each) for each in getattr(parent or module, "__path__", ())]
    found = hashlib.sha256()
    for root in roots:
        for path in sorted(root.rglob("*.py")):
            content = path.read_bytes()
            found.update(f"{path.relative_to(root).as_posix()}\0{len(content)}\0".encode())
            found.update(content)
    if not roots and module.__file__:
        found.update(Path(module.__file__).read_bytes())
    return f"sha256:{found.hexdigest()}"
