"""Resolution of presets, files and overrides into a configuration, checked completely before a run."""

from __future__ import annotations

import functools
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from types import UnionType
from typing import Any, TypeVar, Union, cast, get_args, get_origin, get_type_hints

import attrs
from attrs import validators

from evoframe.config.hints import SECTIONS, known_keys, unknown_key, with_hints
from evoframe.config.labels import label_of
from evoframe.config.layers import Layer, Layers, layer_of, read_layers
from evoframe.contract import (
    COMPONENTS,
    POPULATION_COMPONENTS,
    Chosen,
    PluginSettings,
    PopulationConfig,
    RunConfig,
    RunSettings,
    Simulator,
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
class _Size:
    size: int = attrs.field(default=25, validator=validators.ge(2))


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
        chosen = {key: choose(kind, self.tree.get(key), (key,)) for key, kind in COMPONENTS.items()}
        self.faults += _Checks(populations, chosen).faults(scored=scored)
        if self.faults:
            self.faults = with_hints(self.faults, known_keys(self.tree, plugins))
            return None
        return RunConfig(
            run=cast("RunSettings", run),
            populations=cast("Mapping[str, PopulationConfig]", populations),
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
        if not isinstance(tables, Mapping) or len(tables) < 2:
            count = len(tables) if isinstance(tables, Mapping) else 0
            message = f"expected at least two tables [populations.ROLE], found {count}"
            self.faults.append(Fault(("populations",), message))
            return {}
        return {role: self._population(role, table, choose) for role, table in tables.items()}

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
        size = self._structured(rest, _Size, path)
        chosen = {
            key: choose(kind, table.get(key), (*path, key)) for key, kind in POPULATION_COMPONENTS.items()
        }
        if size is None or None in chosen.values():
            return None
        return PopulationConfig(size.size, **cast("dict[str, Any]", chosen))


class _Checks:
    """Checks between components; checks that earlier faults make impossible are skipped."""

    def __init__(
        self,
        populations: Mapping[str, PopulationConfig | None],
        chosen: Mapping[str, Chosen[Any] | None],
    ) -> None:
        self.populations = {role: given for role, given in populations.items() if given is not None}
        self.complete = bool(populations) and len(self.populations) == len(populations)
        self.chosen = {key: given.component for key, given in chosen.items() if given is not None}

    def faults(self, *, scored: bool) -> list[Fault]:
        record = self._record() if scored else ()
        return [*self._sizes(), *self._collaboration(), *self._roles(), *record]

    def _sizes(self) -> Iterator[Fault]:
        for role, population in self.populations.items():
            check = functools.partial(population.evolver.component.check, population.size)
            yield from _refusal(("populations", role), check)

    def _collaboration(self) -> Iterator[Fault]:
        strategy = self.chosen.get("collaboration")
        if strategy is None:
            return
        counts: set[int] = set()
        for role, population in self.populations.items():
            try:
                counts.add(strategy.size(population.size))
            except ConfigurationError as error:
                yield Fault(("collaboration",), f"{error} (population '{role}')")
                return
        if len(self.populations) > 2 and len(counts) > 1:
            listed = ", ".join(map(str, sorted(counts)))
            message = f"populations of different sizes give different numbers of collaborators: {listed}"
            yield Fault(("collaboration",), message)
        if "aggregator" in self.chosen:
            for count in sorted(counts):
                check = functools.partial(self.chosen["aggregator"].check, count)
                yield from _refusal(("aggregator",), check, involves=("collaboration",))

    def _roles(self) -> Iterator[Fault]:
        if not self.complete:
            return
        provided: list[str] = []
        for role, population in self.populations.items():
            encoder = population.encoder.component
            path = ("populations", role, "encoder")
            for needed in encoder.requires:
                if needed not in provided:
                    yield Fault(path, f"requires the role '{needed}', which no earlier population provides")
            for given in encoder.provides:
                if given in provided:
                    yield Fault(path, f"provides the role '{given}', which an earlier population provides")
            provided += encoder.provides
        simulator = self.chosen.get("simulator")
        for needed in simulator.requires if simulator else ():
            if needed not in provided:
                yield Fault(("simulator",), f"requires the role '{needed}', which no population provides")

    def _record(self) -> Iterator[Fault]:
        if "simulator" in self.chosen and "objective" in self.chosen:
            check = functools.partial(self.chosen["simulator"].check, self.chosen["objective"].record)
            yield from _refusal(("objective",), check, involves=("simulator",))


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


def _refusal(
    path: tuple[str, ...], check: Callable[[], object], involves: tuple[str, ...] = ()
) -> Iterator[Fault]:
    try:
        check()
    except ConfigurationError as error:
        yield Fault(path, str(error), involves)
