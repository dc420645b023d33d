"""The resolved configuration, which determines a run, as frozen classes."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping
from typing import Any, Generic, Literal, TypeVar

import attrs
import tomli_w
from attrs import validators

from evoframe.contract.protocols import (
    Aggregator,
    CollaborationStrategy,
    Credit,
    Encoder,
    Evolver,
    Executor,
    Objective,
    RoleProvider,
    Simulator,
)
from evoframe.documents import Tree, as_read, unstructure

__all__ = [
    "ADDED_LATER",
    "COMPONENTS",
    "POPULATION_COMPONENTS",
    "ROLE_COMPONENTS",
    "SHARED",
    "Chosen",
    "PluginSettings",
    "PopulationConfig",
    "RoleConfig",
    "RunConfig",
    "RunSettings",
    "Source",
    "StartSettings",
    "deciding",
    "is_role",
]

C = TypeVar("C")

COMPONENTS: Mapping[str, str] = {
    "collaboration": "strategy",
    "aggregator": "aggregator",
    "simulator": "simulator",
    "objective": "objective",
    "executor": "executor",
}
"""Top-level key -> kind of the component that it chooses."""

POPULATION_COMPONENTS: Mapping[str, str] = {
    "encoder": "encoder",
    "evolver": "evolver",
    "collaboration": "strategy",
    "aggregator": "aggregator",
}
"""Key within a population -> kind of the component that it chooses."""

ROLE_COMPONENTS: Mapping[str, str] = {"provider": "role"}
"""Key within a role that no population evolves -> kind of the component that it chooses."""

SHARED = ("collaboration", "aggregator")
"""Keys of components that a population can choose for itself; by default, it has the one of the run."""

ADDED_LATER: Mapping[str, bool] = {"evoframe.added_later": True}
"""Metadata of an option that a component received after its first release: ``attrs.field(default=...,
metadata=ADDED_LATER)``. While it has its default, it is left out of what determines a result, so that earlier
runs, rows and champions remain valid."""

_NOT_DECIDING = ("extends", "executor", "provenance")  # tables of a run's configuration


@attrs.frozen(order=True)
class Source:
    """The origin of a plugin.

    Attributes:
        distribution: Name of the installed distribution, or of the local module given with ``-p``.
        version: The distribution's version; ``local`` for a local module.
        entry_point: Name of the entry point in the group ``evoframe``.
        digest: SHA-256 of the source of a local module; empty for a distribution, which has a version.
    """

    distribution: str
    version: str
    entry_point: str
    digest: str = ""

    def __str__(self) -> str:
        return f"'{self.entry_point}' of {self.distribution} {self.version}"


@attrs.frozen
class RunSettings:
    """The table ``[run]``.

    Attributes:
        seed: Seed from which all random streams derive.
        generations: Number of generations per population (paper: 200, i.e. 400 turns of two populations).
        timing: Order of reproduction. With sequential timing, populations take turns (Potter and De Jong
            1994; the paper). With parallel timing, all reproduce in each turn, and are evaluated with
            collaborators from the previous generation (Wiegand 2003). With asynchronous timing, a turn
            occupies a population for a time drawn from the seed, and whichever is free first takes the next
            turn, with collaborators from the latest generation of the others.
    """

    seed: int = attrs.field(default=1, validator=validators.ge(0))
    generations: int = attrs.field(default=200, validator=validators.ge(0))
    timing: Literal["sequential", "parallel", "asynchronous"] = attrs.field(
        default="sequential", metadata=ADDED_LATER
    )


@attrs.frozen
class PluginSettings:
    """The table ``[plugins]``.

    Attributes:
        block: Distributions whose plugins are not used.
        require: Distributions whose plugins must be usable.
    """

    block: tuple[str, ...] = ()
    require: tuple[str, ...] = ()


@attrs.frozen
class Chosen(Generic[C]):
    """A component chosen by name.

    Attributes:
        name: Name in the configuration.
        component: The instance, with its options.
        source: The plugin that offers it.
    """

    name: str
    component: C
    source: Source

    def as_table(self) -> Tree:
        """Return the table that chooses the component, with all its options."""
        options: Tree = unstructure(self.component)
        return {"name": self.name, **options}

    def nested(self, key: str) -> Iterator[tuple[str, Chosen[Any]]]:
        """Yield this component and those among its options, each with its dotted key; its own is *key*."""
        yield key, self
        component: Any = self.component
        for field in attrs.fields(type(component)):
            value = getattr(component, field.name)
            if isinstance(value, Chosen):
                yield from value.nested(f"{key}.{field.name}")
            elif isinstance(value, tuple):
                for index, item in enumerate(value):
                    if isinstance(item, Chosen):
                        yield from item.nested(f"{key}.{field.name}[{index}]")


@attrs.frozen
class StartSettings:
    """The table ``[populations.NAME.start]``: the initial population, if it is not just drawn at random.

    Attributes:
        run: Directory of another run, relative to the working directory, with whose genomes it starts; the
            rest are mutants of them.
        population: Name of the population in that run; empty: the same name.
        take: Its fittest members, or its member of the champion only.
        draws: Number of random initial populations; the population starts with the fittest individuals of
            all of them (in meetings of the individuals of each draw, as in the initial turn).
    """

    run: str = ""
    population: str = ""
    take: Literal["population", "champion"] = "population"
    draws: int = attrs.field(default=1, validator=validators.ge(1))

    @draws.validator
    def _fits_the_run(self, _: object, draws: int) -> None:
        if draws > 1 and self.run:
            raise ValueError("set either run or draws, not both")
        if not self.run and (self.population or self.take != "population"):
            raise ValueError("population and take refer to another run; set run as well")


@attrs.frozen
class PopulationConfig:
    """The table ``[populations.ROLE]``.

    Attributes:
        size: Number of individuals.
        encoder: Decodes the networks of its genomes.
        evolver: Evolves its genomes.
        collaboration: Chooses the collaborators of its individuals; by default that of the run.
        aggregator: Aggregates the scores of its individuals; by default that of the run.
        goal: Whether its individuals evolve towards large or small scores; with opposite goals, populations
            compete.
        turns: Number of its turns in each round, for one of a population with 1.
        start: Its initial individuals.
    """

    size: int = attrs.field(validator=validators.ge(2))
    encoder: Chosen[Encoder]
    evolver: Chosen[Evolver]
    collaboration: Chosen[CollaborationStrategy] | None = None
    aggregator: Chosen[Aggregator | Credit] | None = None
    goal: Literal["maximize", "minimize"] = attrs.field(default="maximize", metadata=ADDED_LATER)
    turns: int = attrs.field(default=1, validator=validators.ge(1), metadata=ADDED_LATER)
    start: StartSettings = attrs.field(default=StartSettings(), metadata=ADDED_LATER)


@attrs.frozen
class RoleConfig:
    """The table ``[roles.NAME]``: a part of designs that no population evolves.

    Attributes:
        provider: Provides it.
        draw: When a random one is drawn: once in a run, in each turn, or for each individual in each turn.
            In the initial turn, and if all populations reproduce in parallel, the individuals are those of
            the first population.
    """

    provider: Chosen[RoleProvider]
    draw: Literal["run", "turn", "individual"] = "run"


@attrs.frozen
class RunConfig:
    """Everything that determines a run, resolved and checked.

    Attributes:
        run: Seed and length.
        populations: Role -> population, in the order of turns and of decoding.
        collaboration: Chooses collaborators.
        aggregator: Aggregates scores into fitness.
        simulator: Simulates designs.
        objective: Scores outcomes.
        executor: Distributes simulations over workers.
        plugins: Blocked and required distributions.
        roles: Name -> roles that no population evolves.
        label: Name of the preset or file, for the default directory.
    """

    run: RunSettings
    populations: Mapping[str, PopulationConfig]
    collaboration: Chosen[CollaborationStrategy]
    aggregator: Chosen[Aggregator | Credit]
    simulator: Chosen[Simulator]
    objective: Chosen[Objective]
    executor: Chosen[Executor]
    plugins: PluginSettings = attrs.field(factory=PluginSettings)
    roles: Mapping[str, RoleConfig] = attrs.field(factory=dict)
    label: str = attrs.field(default="run", eq=False)

    def components(self) -> Iterator[tuple[str, Chosen[Any]]]:
        """Yield every chosen component with its dotted key, those among options of others included."""
        for role, population in self.populations.items():
            for key in POPULATION_COMPONENTS:
                if chosen := getattr(population, key):
                    yield from chosen.nested(f"populations.{role}.{key}")
        for name, given in self.roles.items():
            yield from given.provider.nested(f"roles.{name}.provider")
        for key in COMPONENTS:
            yield from getattr(self, key).nested(key)

    def tables(self) -> Tree:
        """Return the configuration as TOML tables that include every default."""
        return self._tables(Chosen.as_table, later=True)

    def recorded(self) -> Tree:
        """Return the tables that a run records: without options of :data:`ADDED_LATER` at their default."""
        return self._tables(_recorded_table, later=False)

    def _tables(self, table: Callable[[Chosen[Any]], Tree], *, later: bool) -> Tree:
        roles = {
            name: {"provider": table(role.provider), "draw": role.draw} for name, role in self.roles.items()
        }
        return {
            "extends": False,
            "run": _settings(self.run, later=later),
            "populations": {
                role: _population_table(population, table, later=later)
                for role, population in self.populations.items()
            },
            **({"roles": roles} if roles else {}),
            **{key: table(getattr(self, key)) for key in COMPONENTS},
            "plugins": unstructure(self.plugins),
        }

    def chosen_for(self, role: str, key: str) -> tuple[str, Chosen[Any]]:
        """Return the dotted key and the component that a population has for a key of :data:`SHARED`."""
        own = getattr(self.populations[role], key)
        return (f"populations.{role}.{key}", own) if own else (key, getattr(self, key))

    def deciding(self) -> Tree:
        """Return the tables that determine the result (all but the executor) as JSON values."""
        return as_read(deciding(self.recorded()))

    def simulation(self) -> Tree:
        """Return the tables that determine the simulation and the score of a design."""
        return {key: _recorded_table(getattr(self, key)) for key in ("simulator", "objective")}

    def to_toml(self) -> str:
        """Return the text of an equivalent TOML file."""
        return tomli_w.dumps(self.tables())


def deciding(tables: Mapping[str, Any]) -> Tree:
    """Return those tables of a complete configuration that determine the result."""
    return {key: table for key, table in tables.items() if key not in _NOT_DECIDING}


def is_role(name: str) -> bool:
    """Return whether *name* is a valid name of a population, or of a role that no population evolves."""
    return re.fullmatch(r"[a-z][a-z0-9_-]*", name) is not None


def _population_table(
    population: PopulationConfig, table: Callable[[Chosen[Any]], Tree], *, later: bool
) -> Tree:
    chosen = {key: getattr(population, key) for key in POPULATION_COMPONENTS}
    plain = {key: value for key, value in _settings(population, later=later).items() if key not in chosen}
    return plain | {key: table(component) for key, component in chosen.items() if component}


def _recorded_table(chosen: Chosen[Any]) -> Tree:
    """Return the table of a component without options that were added later and have their default."""
    return {"name": chosen.name, **_settings(chosen.component, later=False)}


def _settings(instance: Any, *, later: bool) -> Tree:
    """Return the options of an instance.

    Args:
        instance: An instance of an attrs class.
        later: Whether to include options of :data:`ADDED_LATER` that have their default.
    """
    options: Tree = unstructure(instance)
    left_out = {
        field.name
        for field in attrs.fields(type(instance))
        if not later
        and ADDED_LATER.items() <= field.metadata.items()
        and getattr(instance, field.name) == field.default
    }
    return {key: value for key, value in options.items() if key not in left_out}
