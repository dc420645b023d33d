"""Discovery of plugins, each load guarded, and the registry of what they offer."""

from __future__ import annotations

import difflib
import importlib
import importlib.metadata
import importlib.util
import os
import sys
import warnings
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from types import ModuleType
from typing import Any

import attrs
import pluggy

from evoframe import hookspecs
from evoframe.errors import ConfigurationError, PluginError, PluginWarning

__all__ = ["KINDS", "Offer", "Plugins", "Skipped", "Source", "did_you_mean", "discover"]

GROUP = "evoframe"

KINDS: Mapping[str, str] = {
    "aggregator": "evoframe_aggregators",
    "encoder": "evoframe_encoders",
    "evolver": "evoframe_evolvers",
    "executor": "evoframe_executors",
    "objective": "evoframe_objectives",
    "simulator": "evoframe_simulators",
    "strategy": "evoframe_strategies",
}
"""Kind of component -> the hook that offers it."""


@attrs.frozen(order=True)
class Source:
    """Where a plugin comes from.

    Attributes:
        distribution: Name of the installed distribution, or of the local module given with ``-p``.
        version: The distribution's version; ``local`` for a local module.
        entry_point: Name of the entry point in the group ``evoframe``.
    """

    distribution: str
    version: str
    entry_point: str

    def __str__(self) -> str:
        return f"'{self.entry_point}' of {self.distribution} {self.version}"


@attrs.frozen
class Offer:
    """A component that a plugin offers.

    Attributes:
        kind: One of :data:`KINDS`.
        name: The name in configuration files.
        component: The frozen attrs class.
        source: The plugin that offers it.
    """

    kind: str
    name: str
    component: type[Any]
    source: Source


@attrs.frozen
class Skipped:
    """A plugin that could not be used, and why."""

    source: Source
    cause: str


def did_you_mean(word: str, known: Iterable[str]) -> str:
    """Return ``; did you mean 'x'?`` for the known word closest to *word*, or nothing."""
    close = difflib.get_close_matches(word, list(known), n=1, cutoff=0.5)
    return f"; did you mean '{close[0]}'?" if close else ""


def _new_manager() -> pluggy.PluginManager:
    manager = pluggy.PluginManager("evoframe")
    manager.add_hookspecs(hookspecs)
    return manager


@attrs.define
class Plugins:
    """The plugins of this process: what they offer, who observes, and who was skipped."""

    manager: pluggy.PluginManager = attrs.field(factory=_new_manager)
    offers: list[Offer] = attrs.field(factory=list)
    skipped: list[Skipped] = attrs.field(factory=list)

    def add(self, plugin: object, source: Source) -> None:
        """Register *plugin*, or none of it.

        Raises:
            PluginError: It implements no hook or an unknown one, or offers something that is no component.
        """
        try:
            self.manager.register(plugin, name=f"{source.distribution}:{source.entry_point}")
        except (pluggy.PluginValidationError, ValueError) as error:
            if self.manager.is_registered(plugin):
                self.manager.unregister(plugin)
            raise PluginError(str(error)) from error
        try:
            _check_hooks(self.manager, plugin)
            self.offers += list(_offers(plugin, source))
        except Exception:
            self.manager.unregister(plugin)
            raise

    def without(self, distributions: Iterable[str]) -> Plugins:
        """Return the same plugins but those of the named *distributions*."""
        blocked = set(distributions)
        if not blocked:
            return self
        kept = Plugins(skipped=self.skipped)
        for name, plugin in self.manager.list_name_plugin():
            distribution, entry_point = name.rsplit(":", 1)
            if plugin is not None and distribution not in blocked:
                kept.manager.register(plugin, name=f"{distribution}:{entry_point}")
        kept.offers = [offer for offer in self.offers if offer.source.distribution not in blocked]
        return kept

    def require(self, distributions: Iterable[str]) -> None:
        """Make sure that each of *distributions* offers something here.

        Raises:
            PluginError: One is missing or was skipped; says why.
        """
        names = {name.rsplit(":", 1)[0] for name, _ in self.manager.list_name_plugin()}
        for distribution in distributions:
            causes = [s.cause for s in self.skipped if s.source.distribution == distribution]
            if causes:
                raise PluginError(f"required plugin '{distribution}' cannot be used: {causes[0]}")
            if distribution not in names:
                found = ", ".join(sorted(names))
                raise PluginError(f"required plugin '{distribution}' is not installed; found: {found}")

    def names(self, kind: str) -> list[str]:
        """Return the sorted names of the components of a *kind*."""
        return sorted({offer.name for offer in self.offers if offer.kind == kind})

    def find(self, kind: str, asked: str) -> Offer:
        """Return the component *asked* for, as ``name`` or ``distribution:name``.

        Raises:
            ConfigurationError: There is none of that name, or several; says what there is.
        """
        distribution, _, name = asked.rpartition(":")
        found = [
            offer
            for offer in self.offers
            if offer.kind == kind and offer.name == name and distribution in ("", offer.source.distribution)
        ]
        if len(found) == 1:
            return found[0]
        if found:
            choices = " or ".join(f"'{offer.source.distribution}:{name}'" for offer in found)
            raise ConfigurationError(f"{kind} '{asked}' is offered by several plugins; write {choices}")
        raise ConfigurationError(self._unknown(kind, asked))

    def _unknown(self, kind: str, asked: str) -> str:
        known = self.names(kind)
        message = f"unknown {kind} '{asked}'{did_you_mean(asked, known)}"
        message += f"{'' if message.endswith('?') else ';'} installed: {', '.join(known) or 'none'}"
        if self.skipped:
            causes = "; ".join(f"{skipped.source}: {skipped.cause}" for skipped in self.skipped)
            message += f" (skipped plugins: {causes})"
        return message


def discover(modules: Iterable[str] = ()) -> Plugins:
    """Load the installed plugins and the local *modules*.

    The environment variables ``EVOFRAME_PLUGINS_BLOCK`` and ``EVOFRAME_PLUGINS_REQUIRE`` name distributions,
    separated by commas, that are not loaded, or that must be.

    Args:
        modules: Importable names, or paths of Python files, of plugins that no distribution installs.

    Raises:
        PluginError: A local module, or a required distribution, cannot be used.

    Warns:
        PluginWarning: An installed plugin cannot be used; the others are.
    """
    plugins = Plugins()
    blocked = _listed("EVOFRAME_PLUGINS_BLOCK")
    for source, entry_point in _entry_points():
        if source.distribution not in blocked:
            _load_guarded(plugins, source, entry_point)
    for module in modules:
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
    except (Exception, SystemExit) as error:  # noqa: BLE001 - any fault of a plugin is only that plugin's
        cause = str(error) if isinstance(error, PluginError) else f"{type(error).__name__}: {error}"
        plugins.skipped.append(Skipped(source, cause))
        warnings.warn(f"plugin {source} is skipped: {cause}", PluginWarning, stacklevel=3)


def _load_local(plugins: Plugins, module: str) -> None:
    name = Path(module).stem if module.endswith(".py") else module
    try:
        plugins.add(_import_local(module, name), Source(name, "local", name))
    except (Exception, SystemExit) as error:
        cause = str(error) if isinstance(error, PluginError) else f"{type(error).__name__}: {error}"
        raise PluginError(f"plugin module '{module}' cannot be used: {cause}") from error


def _import_local(module: str, name: str) -> ModuleType:
    if not module.endswith(".py"):
        here = str(Path.cwd())
        if here not in sys.path:
            sys.path.insert(0, here)
        return importlib.import_module(module)
    path = Path(module)
    if not path.is_file():
        raise PluginError("there is no such file")
    spec = importlib.util.spec_from_file_location(name, path)
    if spec is None or spec.loader is None:
        raise PluginError("it is not a Python module")
    loaded = importlib.util.module_from_spec(spec)
    sys.modules[name] = loaded
    spec.loader.exec_module(loaded)
    return loaded


def _check_hooks(manager: pluggy.PluginManager, plugin: object) -> None:
    known = [name for name in dir(hookspecs) if name.startswith("evoframe_")]
    callers = manager.get_hookcallers(plugin)
    if not callers:
        raise PluginError("it implements no hook; are its functions marked with evoframe.hookimpl?")
    for caller in callers:
        if not caller.has_spec():
            raise PluginError(f"unknown hook '{caller.name}'{did_you_mean(caller.name, known)}")


def _offers(plugin: object, source: Source) -> Iterator[Offer]:
    for kind, hook in KINDS.items():
        function = getattr(plugin, hook, None)
        if function is None or not hasattr(function, "evoframe_impl"):
            continue
        offered = function()
        if not isinstance(offered, Mapping):
            raise PluginError(f"{hook} must return a mapping of names to classes, not {offered!r}")
        for name, component in offered.items():
            if not (isinstance(name, str) and isinstance(component, type) and attrs.has(component)):
                raise PluginError(
                    f"{hook} offers {name!r}: {component!r}, which is no attrs class with a name"
                )
            yield Offer(kind, name, component, source)
