"""The registry of plugins: offered components, observers, and skipped plugins."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from typing import Any

import attrs
import pluggy

from evoframe.contract import COMPONENTS, POPULATION_COMPONENTS, ROLE_COMPONENTS, Source, protocols
from evoframe.errors import ConfigurationError, PluginError
from evoframe.messages import suggestion
from evoframe.registry import hookspecs

__all__ = ["KINDS", "Kind", "Offer", "Plugins", "Skipped", "kind_of", "normalized"]

_COMPONENT_NAME = re.compile(r"[a-z0-9][a-z0-9_-]*")


@attrs.frozen
class Kind:
    """A kind of component.

    Attributes:
        hook: Hook that offers components of this kind.
        protocol: Protocol of these components.
        others: Further protocols, of which a component can implement one instead.
    """

    hook: str
    protocol: type[Any]
    others: tuple[type[Any], ...] = ()

    def missing(self, component: object) -> list[str]:
        """Return the members that *component* lacks of the protocol that it implements most of."""
        lacking = [_missing(protocol, component) for protocol in (self.protocol, *self.others)]
        return min(lacking, key=len)


def _missing(protocol: type[Any], component: object) -> list[str]:
    members = sorted(name for name in dir(protocol) if not name.startswith("_"))
    return [name for name in members if not hasattr(component, name)]


KINDS: Mapping[str, Kind] = {
    "aggregator": Kind("evoframe_aggregators", protocols.Aggregator, (protocols.Credit,)),
    "encoder": Kind("evoframe_encoders", protocols.Encoder),
    "evolver": Kind("evoframe_evolvers", protocols.Evolver),
    "executor": Kind("evoframe_executors", protocols.Executor),
    "objective": Kind("evoframe_objectives", protocols.Objective),
    "role": Kind("evoframe_roles", protocols.RoleProvider),
    "simulator": Kind("evoframe_simulators", protocols.Simulator),
    "strategy": Kind("evoframe_strategies", protocols.CollaborationStrategy),
}
"""Name of a kind -> the kind."""

OBSERVATIONS = ("evoframe_run_started", "evoframe_turn_finished", "evoframe_run_finished")
"""Hooks with which a plugin observes a run."""

_NOUNS = {"strategy": "collaboration strategy"}  # kind -> its name in messages, if different

_KEYS = (
    {kind: f"populations.ROLE.{key}" for key, kind in POPULATION_COMPONENTS.items()}
    | {kind: f"roles.NAME.{key}" for key, kind in ROLE_COMPONENTS.items()}
    | {kind: key for key, kind in COMPONENTS.items()}
)  # kind -> configuration key


@attrs.frozen
class Offer:
    """A component that a plugin offers.

    Attributes:
        kind: Key of :data:`KINDS`.
        name: Name in configuration files.
        component: The frozen attrs class.
        source: The plugin that offers it.
    """

    kind: str
    name: str
    component: type[Any]
    source: Source


@attrs.frozen
class Skipped:
    """A plugin that could not be used, and the cause."""

    source: Source
    cause: str


def _new_manager() -> pluggy.PluginManager:
    manager = pluggy.PluginManager("evoframe")
    manager.add_hookspecs(hookspecs)
    return manager


@attrs.define
class Plugins:
    """The plugins of this process: offered components, observers, and skipped plugins."""

    manager: pluggy.PluginManager = attrs.field(factory=_new_manager)
    offers: list[Offer] = attrs.field(factory=list)
    observers: list[Source] = attrs.field(factory=list)
    skipped: list[Skipped] = attrs.field(factory=list)

    def add(self, plugin: object, source: Source) -> None:
        """Register *plugin* completely; after an error, nothing of it is registered.

        Raises:
            PluginError: The plugin implements no hook or an unknown one, or offers an invalid component.
        """
        name = f"{source.distribution}:{source.entry_point}"
        if self.manager.has_plugin(name):
            raise PluginError(f"a plugin named '{name}' is already registered")
        try:
            self.manager.register(plugin, name=name)
            _check_hooks(self.manager, plugin)
            self.offers += list(_offers(self.manager, plugin, source))
            if any(caller.name in OBSERVATIONS for caller in self.manager.get_hookcallers(plugin) or ()):
                self.observers.append(source)
        except BaseException as error:
            if self.manager.is_registered(plugin):
                self.manager.unregister(plugin)
            if isinstance(error, pluggy.PluginValidationError | ValueError):
                raise PluginError(str(error)) from error
            raise

    def without(self, distributions: Iterable[str]) -> Plugins:
        """Return the plugins without those of the named *distributions*."""
        blocked = {normalized(distribution) for distribution in distributions}
        if not blocked:
            return self
        kept = Plugins(skipped=self.skipped)
        for name, plugin in self.manager.list_name_plugin():
            distribution, entry_point = name.rsplit(":", 1)
            if plugin is not None and normalized(distribution) not in blocked:
                kept.manager.register(plugin, name=f"{distribution}:{entry_point}")
        kept.observers = [s for s in self.observers if normalized(s.distribution) not in blocked]
        kept.offers = [o for o in self.offers if normalized(o.source.distribution) not in blocked]
        return kept

    def require(self, distributions: Iterable[str]) -> None:
        """Check that a plugin of each of *distributions* is usable.

        Raises:
            PluginError: A distribution is missing or was skipped; names the cause.
        """
        names = {name.rsplit(":", 1)[0] for name, _ in self.manager.list_name_plugin()}
        usable = {normalized(name) for name in names}
        for distribution in distributions:
            wanted = normalized(distribution)
            causes = [s.cause for s in self.skipped if normalized(s.source.distribution) == wanted]
            if causes:
                raise PluginError(f"required plugin '{distribution}' cannot be used: {causes[0]}")
            if wanted not in usable:
                found = ", ".join(sorted(names))
                raise PluginError(f"required plugin '{distribution}' is not installed; installed: {found}")

    def names(self, kind: str) -> list[str]:
        """Return the sorted names of the components of a *kind*."""
        return sorted({offer.name for offer in self.offers if offer.kind == kind})

    def missing(self, distributions: Iterable[str]) -> list[str]:
        """Return those of *distributions* that offer no component."""
        present = {offer.source.distribution for offer in self.offers}
        return [name for name in distributions if name not in present]

    def kinds_of(self, name: str) -> list[str]:
        """Return the sorted kinds of the components with this *name*."""
        return sorted({offer.kind for offer in self.offers if offer.name == name})

    def find(self, kind: str, asked: str) -> Offer:
        """Return the component *asked* for, as ``name`` or ``distribution:name``.

        Raises:
            ConfigurationError: No component has that name, or several have; names the alternatives.
        """
        distribution, _, name = asked.rpartition(":")
        found = [
            offer
            for offer in self.offers
            if offer.kind == kind
            and offer.name == name
            and normalized(distribution) in ("", normalized(offer.source.distribution))
        ]
        if len(found) == 1:
            return found[0]
        if found:
            choices = " or ".join(f"'{offer.source.distribution}:{name}'" for offer in found)
            raise ConfigurationError(
                f"several plugins offer the {_NOUNS.get(kind, kind)} '{asked}'; write {choices}"
            )
        raise ConfigurationError(self._unknown(kind, asked))

    def _unknown(self, kind: str, asked: str) -> str:
        others = [f"'{_KEYS[other]}={asked}'" for other in self.kinds_of(asked)]
        if others:
            end = f"; did you mean {' or '.join(others)}? installed: {', '.join(self.names(kind)) or 'none'}"
        else:
            end = suggestion(asked, self.names(kind), "installed")
        message = f"unknown {_NOUNS.get(kind, kind)} '{asked}'{end}"
        if self.skipped:
            causes = "; ".join(f"{skipped.source}: {skipped.cause}" for skipped in self.skipped)
            message += f" (skipped plugins: {causes})"
        return message


def kind_of(protocol: object) -> str | None:
    """Return the kind of components with a *protocol*, or ``None``."""
    return next((name for name, kind in KINDS.items() if protocol in (kind.protocol, *kind.others)), None)


def normalized(distribution: str) -> str:
    """Return the normalized name of a distribution (PEP 503)."""
    return re.sub(r"[-_.]+", "-", distribution).lower()


def _check_hooks(manager: pluggy.PluginManager, plugin: object) -> None:
    known = [name for name in dir(hookspecs) if name.startswith("evoframe_")]
    callers = manager.get_hookcallers(plugin)
    if not callers:
        raise PluginError("the plugin implements no hook; mark its functions with @evoframe.hookimpl")
    for caller in callers:
        if not caller.has_spec():
            raise PluginError(f"unknown hook '{caller.name}'{suggestion(caller.name, known)}")


def _offers(manager: pluggy.PluginManager, plugin: object, source: Source) -> Iterator[Offer]:
    for kind, form in KINDS.items():
        for implementation in getattr(manager.hook, form.hook).get_hookimpls():
            if implementation.plugin is plugin:
                yield from _checked(kind, form.hook, implementation.function(), source)


def _checked(kind: str, hook: str, offered: Any, source: Source) -> Iterator[Offer]:
    """Check the return value of a hook and yield its components."""
    if not isinstance(offered, Mapping):
        raise PluginError(f"{hook} must return a mapping of names to classes, found {offered!r}")
    for name, component in offered.items():
        if not (isinstance(name, str) and _COMPONENT_NAME.fullmatch(name)):
            raise PluginError(
                f"{hook} offers the invalid name {name!r}; use lower-case letters, digits, - and _"
            )
        if not (isinstance(component, type) and attrs.has(component)):
            raise PluginError(f"{hook} offers '{name}': {component!r} is not an attrs class")
        yield Offer(kind, name, component, source)
