"""Resolution of presets, files and overrides into a configuration, checked completely before a run."""

from __future__ import annotations

import functools
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from types import UnionType
from typing import Any, Literal, TypeVar, Union, cast, get_args, get_origin, get_type_hints

import attrs
from attrs import validators

from evoframe.config.checks import Checks
from evoframe.config.hints import SECTIONS, known_keys, unknown_key, with_hints
from evoframe.config.labels import label_of
from evoframe.config.layers import Layer, Layers, layer_of, read_layers
from evoframe.contract import (
    COMPONENTS,
    POPULATION_COMPONENTS,
    ROLE_COMPONENTS,
    SHARED,
    Chosen,
    PluginSettings,
    PopulationConfig,
    RoleConfig,
    RunConfig,
    RunSettings,
    Simulator,
    StartSettings,
    is_role,
)
from evoframe.documents import Fault, StructureError, Tree, structure
from evoframe.errors import ConfigurationError, PluginError
from evoframe.messages import found
from evoframe.registry import KINDS, Offer, Plugins, discover, kind_of

__all__ = ["load_config", "named_simulator", "resolve_component", "resolve_layers", "resolve_simulator"]

C = TypeVar("C")
_RESERVED_ROLES = {"turn", "pair", "score", "diverged_at"}


def load_config(
    source: str | Path = "paper",
    *,
    overrides: Iterable[str | Layer] = (),
    plugins: Plugins | None = None,
) -> RunConfig:
    """Read, resolve and check a configuration.

    Args:
        source: Name of a preset, or path of a TOML file.
        overrides: Settings that override it; the last one wins: ``key=value`` with a dotted key and a TOML
            value, as for ``--set``, or layers of tables.
        plugins: The plugins to choose from; by default the installed ones.

    Raises:
        ConfigurationError: The configuration is invalid; lists all faults, each with its file and key.
    """
    if not isinstance(source, str | Path):
        raise TypeError(f"expected the name of a preset or the path of a file, found {type(source).__name__}")
    return complete_config(read_layers(source), overrides, plugins or discover())


def complete_config(base: Layers, overrides: Iterable[str | Layer], plugins: Plugins) -> RunConfig:
    """Resolve the layers that :func:`read_layers` returned for a source, as by :func:`load_config`.

    Raises:
        ConfigurationError: The configuration is invalid; lists all faults, each with its file and key.
    """
    layers = base.under(overrides)
    label = label_of(base.source, layers.layers[len(base.layers) :])
    return resolve_layers(layers, label, plugins)


def resolve_layers(layers: Layers, label: str, plugins: Plugins, *, scored: bool = True) -> RunConfig:
    """Resolve and check layers of settings.

    Args:
        layers: The settings.
        label: Name of the configuration, for the default directory.
        plugins: The plugins to choose from.
        scored: Whether simulations must provide the samples that the objective requires.

    Raises:
        ConfigurationError: The configuration is invalid; lists all faults, each with its file and key.
    """
    reading = _Reading(layers.merged())
    settings = reading.section("plugins", PluginSettings) or PluginSettings()
    usable = plugins.without(settings.block)
    reading.refuse_missing(usable, settings.require)
    config = reading.config(usable, settings, label, scored=scored)
    if config is None:
        error = _joined(reading.faults, layers)
        for name in plugins.missing(layers.local_plugins):
            error.add_note(
                f"the run used the local plugin '{name}'; repeat the command with -p PATH/{name}.py"
            )
        raise error
    return config


def named_simulator(
    base: Layers, overrides: Sequence[str | Layer], plugins: Plugins
) -> Chosen[Simulator] | None:
    """Return the simulator that a configuration names, for reading the settings that a file contains.

    If *base* alone gives a valid simulator, overrides of its options are ignored, since they may be valid
    only together with the settings of the file.

    Args:
        base: The settings of a preset or TOML file.
        overrides: As for :func:`load_config`.
        plugins: The plugins to choose from.

    Returns:
        The simulator; ``None`` if there are faults, which :func:`load_config` reports.
    """
    table = base.under(overrides).merged().get("simulator")
    if not isinstance(table, Mapping) or "name" not in table:
        return None
    alone = layer_of("", "simulator", {"name": table["name"]})
    found = (resolve_simulator(base.under(given), plugins) for given in ([alone], overrides))
    return next(filter(None, found), None)


def resolve_simulator(layers: Layers, plugins: Plugins) -> Chosen[Simulator] | None:
    """Return the simulator of layers of settings, whatever their other settings.

    Returns:
        The simulator; ``None`` if there are faults, which :func:`resolve_layers` reports.
    """
    tree = layers.merged()
    reading = _Reading(tree)
    settings = reading.section("plugins", PluginSettings) or PluginSettings()
    usable = plugins.without(settings.block)
    return reading.chosen(usable, "simulator", tree.get("simulator"), ("simulator",))


def resolve_component(options: Tree, class_: type[C], path: tuple[str, ...]) -> C:
    """Return a component with options as a configuration contains them.

    Components among the options are those of the installed plugins, which are loaded only if there are any.

    Raises:
        StructureError: The options are invalid; contains all faults, their paths beginning with *path*.
    """
    reading = _Reading({})
    plugins = discover() if any(_nested_options(class_)) else Plugins()
    component = reading.component(plugins, class_, options, path)
    if component is None:
        raise StructureError(reading.faults)
    return component


def _joined(faults: list[Fault], layers: Layers) -> ConfigurationError:
    errors = [
        ConfigurationError(
            fault.message, source=layers.origin(fault.path, fault.involves), key=".".join(fault.path)
        )
        for fault in faults
    ]
    if len(errors) == 1:
        return errors[0]
    return ConfigurationError(f"{len(errors)} faults in the configuration:", faults=errors)


@attrs.frozen
class _Plain:
    """The options of a population that choose no component."""

    size: int = attrs.field(default=25, validator=validators.ge(2))
    goal: Literal["maximize", "minimize"] = "maximize"
    turns: int = attrs.field(default=1, validator=validators.ge(1))
    start: StartSettings = attrs.field(factory=StartSettings)


@attrs.frozen
class _PlainRole:
    """The options of a role that choose no component."""

    draw: Literal["run", "turn", "individual"] = "run"


class _Reading:
    """A pass over a tree that collects faults instead of stopping at the first."""

    def __init__(self, tree: Tree) -> None:
        self.tree = tree
        self.faults: list[Fault] = []

    def section(self, key: str, class_: type[C]) -> C | None:
        return self._structured(self.tree.get(key, {}), class_, (key,))

    def refuse_missing(self, plugins: Plugins, required: Iterable[str]) -> None:
        for distribution in required:
            try:
                plugins.require([distribution])
            except PluginError as error:
                self.faults.append(Fault(("plugins", "require"), str(error)))

    def config(
        self, plugins: Plugins, settings: PluginSettings, label: str, *, scored: bool
    ) -> RunConfig | None:
        """Return the configuration, or ``None`` if there are faults."""
        self._refuse_unknown_keys(plugins)
        run = self.section("run", RunSettings)
        choose = functools.partial(self.chosen, plugins)
        populations = self._populations(choose)
        roles = self._roles(choose)
        chosen = {key: choose(kind, self.tree.get(key), (key,)) for key, kind in COMPONENTS.items()}
        self.faults += Checks(run, populations, roles, chosen).faults(scored=scored)
        if self.faults:
            self.faults = with_hints(self.faults, known_keys(self.tree, plugins))
            return None
        return RunConfig(
            run=cast("RunSettings", run),
            populations=cast("Mapping[str, PopulationConfig]", populations),
            roles=cast("Mapping[str, RoleConfig]", roles),
            plugins=settings,
            label=label,
            **cast("dict[str, Any]", chosen),
        )

    def chosen(self, plugins: Plugins, kind: str, table: Any, path: tuple[str, ...]) -> Chosen[Any] | None:
        """Return the component that a table names, or ``None`` if there are faults."""
        if not isinstance(table, Mapping) or not isinstance(table.get("name"), str):
            message = f"expected one of {', '.join(plugins.names(kind))}, or a table with the key 'name'"
            problem = f"missing; {message}" if table is None else f"{message}; found {found(table)}"
            self.faults.append(Fault(path, problem))
            return None
        options = {key: value for key, value in table.items() if key != "name"}
        try:
            offer = plugins.find(kind, table["name"])
        except ConfigurationError as error:
            self.faults.append(Fault(path, str(error)))
            return None
        component = self.component(plugins, offer.component, options, path)
        if component is None:
            return None
        violations = [Fault(path, message) for message in _violations(offer, component)]
        self.faults += violations
        return None if violations else Chosen(table["name"], component, offer.source)

    def component(self, plugins: Plugins, class_: type[C], options: Tree, path: tuple[str, ...]) -> C | None:
        """Return a component with these options, or ``None`` if there are faults."""
        faults = len(self.faults)
        complete = self._with_nested(plugins, class_, options, path)
        return self._structured(complete, class_, path) if len(self.faults) == faults else None

    def _with_nested(self, plugins: Plugins, class_: type[Any], options: Tree, path: tuple[str, ...]) -> Tree:
        """Return the options of a component with those that are components themselves chosen."""
        complete = dict(options)
        for name, kind, several in _nested_options(class_):
            given = complete.get(name)
            if several and isinstance(given, list | tuple):
                places = [(*path, f"{name}[{index}]") for index in range(len(given))]
                complete[name] = [
                    self._nested(plugins, kind, table, place)
                    for table, place in zip(given, places, strict=True)
                ]
            elif not several and given is not None:
                complete[name] = self._nested(plugins, kind, given, (*path, name))
        return complete

    def _nested(self, plugins: Plugins, kind: str, table: Any, path: tuple[str, ...]) -> Any:
        if isinstance(table, Chosen):  # from Python
            return table
        return self.chosen(plugins, kind, {"name": table} if isinstance(table, str) else table, path)

    def _structured(self, value: Any, class_: type[C], path: tuple[str, ...]) -> C | None:
        try:
            return structure(value, class_, path)
        except StructureError as error:
            self.faults += error.faults
            return None

    def _refuse_unknown_keys(self, plugins: Plugins) -> None:
        for key, value in self.tree.items():
            if key == "extends":
                self.faults.append(Fault((key,), "can only be set in a file"))
            elif key not in SECTIONS:
                self.faults.append(Fault((key,), unknown_key(key, value, self.tree, plugins)))

    def _populations(self, choose: Callable[..., Chosen[Any] | None]) -> dict[str, PopulationConfig | None]:
        tables = self.tree.get("populations")
        if isinstance(tables, Mapping):  # a file can leave out populations of the preset that it extends
            tables = {name: table for name, table in tables.items() if table is not False}
        if not isinstance(tables, Mapping) or not tables:
            self.faults.append(
                Fault(("populations",), "expected at least one table [populations.NAME], found none")
            )
            return {}
        return {role: self._population(role, table, choose) for role, table in tables.items()}

    def _roles(self, choose: Callable[..., Chosen[Any] | None]) -> dict[str, RoleConfig | None]:
        tables = self.tree.get("roles", {})
        if isinstance(tables, Mapping):
            tables = {name: table for name, table in tables.items() if table is not False}
        if not isinstance(tables, Mapping):
            self.faults.append(Fault(("roles",), f"expected tables [roles.NAME], found {found(tables)}"))
            return {}
        return {name: self._role(name, table, choose) for name, table in tables.items()}

    def _role(self, name: str, table: Any, choose: Callable[..., Chosen[Any] | None]) -> RoleConfig | None:
        path = ("roles", name)
        if not is_role(name):
            message = f"invalid name '{name}'; use lower-case letters, digits, - and _, with a letter first"
            self.faults.append(Fault(path, message))
        if not isinstance(table, Mapping):
            self.faults.append(Fault(path, f"expected a table, found {found(table)}", options=()))
            return None
        rest = {key: value for key, value in table.items() if key not in ROLE_COMPONENTS}
        plain = self._structured(rest, _PlainRole, path)
        provider = choose("role", table.get("provider"), (*path, "provider"))
        return RoleConfig(provider, plain.draw) if plain and provider else None

    def _population(
        self, role: str, table: Any, choose: Callable[..., Chosen[Any] | None]
    ) -> PopulationConfig | None:
        path = ("populations", role)
        if role in _RESERVED_ROLES:
            self.faults.append(Fault(path, f"'{role}' is a column name of the database; choose another role"))
        elif not is_role(role):
            message = f"invalid role '{role}'; use lower-case letters, digits, - and _, with a letter first"
            self.faults.append(Fault(path, message))
        if not isinstance(table, Mapping):
            self.faults.append(Fault(path, f"expected a table, found {found(table)}", options=()))
            return None
        rest = {key: value for key, value in table.items() if key not in POPULATION_COMPONENTS}
        plain = self._structured(rest, _Plain, path)
        chosen = {
            key: choose(kind, table.get(key), (*path, key))
            for key, kind in POPULATION_COMPONENTS.items()
            if key in table or key not in SHARED
        }
        if plain is None or None in chosen.values():
            return None
        settings: dict[str, Any] = attrs.asdict(plain, recurse=False)
        return PopulationConfig(**settings, **cast("dict[str, Any]", chosen))


def _nested_options(class_: type[Any]) -> Iterator[tuple[str, str, bool]]:
    """Yield the options that choose components: name, kind, and whether it is a list of them."""
    try:
        hints = get_type_hints(class_)
    except NameError:  # an annotation that only a type checker can resolve
        return
    for name, hint in hints.items():
        types = [argument for argument in get_args(hint) if argument is not type(None)]
        several = get_origin(hint) is tuple
        alias = types[0] if types and (several or get_origin(hint) in (Union, UnionType)) else hint
        if get_origin(alias) is Chosen and (kind := kind_of(get_args(alias)[0])):
            yield name, kind, several


def _violations(offer: Offer, component: Any) -> Iterator[str]:
    """Yield the violations of the protocol of a component's kind."""
    where = f"{offer.kind} '{offer.name}' of plugin {offer.source}"
    if missing := KINDS[offer.kind].missing(component):
        yield f"{where} lacks {', '.join(missing)}"
    if not attrs.inspect(type(component)).is_frozen:
        yield f"{where} is not a frozen attrs class, so its options could change during a run"
