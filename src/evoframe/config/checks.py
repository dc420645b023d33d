"""Checks between the components of a configuration."""

from __future__ import annotations

import functools
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any

from evoframe.contract import (
    CORE_MEASURES,
    SHARED,
    Aggregator,
    ArrayType,
    Chosen,
    Encoder,
    PopulationConfig,
    RoleConfig,
    RoleProvider,
    RunSettings,
    array_types_of,
    measures_of_designs,
    measures_of_simulations,
    sizes_of,
    wanted_by,
)
from evoframe.documents import Fault
from evoframe.errors import ConfigurationError

__all__ = ["Checks"]


class Checks:
    """Checks between components; checks that earlier faults make impossible are skipped."""

    def __init__(
        self,
        run: RunSettings | None,
        populations: Mapping[str, PopulationConfig | None],
        roles: Mapping[str, RoleConfig | None],
        chosen: Mapping[str, Chosen[Any] | None],
    ) -> None:
        self.run = run
        self.alone = len(populations) == 1
        self.populations = {role: given for role, given in populations.items() if given is not None}
        self.roles = {name: given for name, given in roles.items() if given is not None}
        self.complete = (
            bool(populations) and len(self.populations) == len(populations) and len(self.roles) == len(roles)
        )
        self.chosen = {key: given.component for key, given in chosen.items() if given is not None}

    def faults(self, *, scored: bool) -> list[Fault]:
        """Return all faults; with *scored*, simulations must provide what the objective requires."""
        record = self._record() if scored else ()
        return [
            *self._sizes(),
            *self._goals(),
            *self._timing(),
            *self._collaborations(),
            *self._roles(),
            *self._array_types(),
            *self._measures(),
            *record,
        ]

    def _sizes(self) -> Iterator[Fault]:
        for role, population in self.populations.items():
            check = functools.partial(population.evolver.component.check, population.size)
            yield from _refusal(("populations", role), check)

    def _goals(self) -> Iterator[Fault]:
        """Check that a pair with a large score is wanted, and that aggregators accept negated scores."""
        minimizing = [role for role, population in self.populations.items() if population.goal == "minimize"]
        if self.complete and len(minimizing) == len(self.populations):
            message = (
                "all populations minimize, but the champion is the pair with the largest score; use an "
                "objective with the opposite sign"
            )
            yield Fault(("populations", minimizing[0], "goal"), message)
        for role in minimizing:
            own = self.populations[role].aggregator
            aggregator = own.component if own else self.chosen.get("aggregator")
            if isinstance(aggregator, Aggregator) and aggregator.domain[0] >= 0.0:
                message = (
                    "'minimize' negates scores, but the aggregator requires positive ones; choose another "
                    f"populations.{role}.aggregator"
                )
                yield Fault(("populations", role, "goal"), message, ("aggregator",))

    def _timing(self) -> Iterator[Fault]:
        if self.run is None or self.run.timing != "parallel":
            return
        for role, population in self.populations.items():
            if population.turns != 1:
                message = f"expected 1 with run.timing = 'parallel', found {population.turns}"
                yield Fault(("populations", role, "turns"), message, ("run", "timing"))

    def _collaborations(self) -> Iterator[Fault]:
        """Check strategies and aggregators; equal ones of several populations are checked together."""
        by_key: dict[tuple[str, ...], list[str]] = {}
        for role, population in self.populations.items():
            own = population.collaboration is not None
            by_key.setdefault(
                ("populations", role, "collaboration") if own else ("collaboration",), []
            ).append(role)
        for path, roles in by_key.items():
            yield from self._collaboration(path, roles)

    def _collaboration(self, path: tuple[str, ...], roles: Sequence[str]) -> Iterator[Fault]:
        """Check one strategy that chooses for the individuals of some populations."""
        own = self.populations[roles[0]].collaboration
        strategy = own.component if own else self.chosen.get("collaboration")
        if strategy is None:
            return
        if self.alone:  # its individuals meet nobody, and have one score
            yield from self._aggregators(path, {roles[0]: {1}})
            return
        counts: dict[str, set[int]] = {}
        for other, population in self.populations.items():
            if roles == [other]:
                continue
            try:
                counts[other] = set(sizes_of(strategy, population.size))
            except ConfigurationError as error:
                yield Fault(path, f"{_in_place(str(error), path)} (population '{other}')")
                return
        if len(self.populations) > 2 and len(set(map(frozenset, counts.values()))) > 1:
            listed = ", ".join(map(str, sorted(set().union(*counts.values()))))
            message = f"populations of different sizes give different numbers of collaborators: {listed}"
            yield Fault(path, message)
        met = {role: set().union(*(n for other, n in counts.items() if other != role)) for role in roles}
        yield from self._aggregators(path, met)

    def _aggregators(self, path: tuple[str, ...], met: Mapping[str, set[int]]) -> Iterator[Fault]:
        """Check that the aggregators of populations accept their numbers of collaborators."""
        places: dict[tuple[str, ...], tuple[Any, set[int]]] = {}
        for role, counts in met.items():
            own = self.populations[role].aggregator
            if own is not None:
                places["populations", role, "aggregator"] = own.component, counts
            elif "aggregator" in self.chosen:
                shared = places.setdefault(("aggregator",), (self.chosen["aggregator"], set()))
                shared[1].update(counts)
        for place, (aggregator, numbers) in places.items():
            for count in sorted(numbers):
                yield from _refusal(place, functools.partial(aggregator.check, count), involves=path)

    def _measures(self) -> Iterator[Fault]:
        """Check that every measure that an evolver wants has exactly one supplier."""
        if not self.complete or not {"simulator", "objective"} <= self.chosen.keys():
            return
        suppliers: list[tuple[str, tuple[str, ...]]] = [("evoframe", CORE_MEASURES)]
        suppliers += [
            (f"populations.{role}.encoder", measures_of_designs(population.encoder.component))
            for role, population in self.populations.items()
        ]
        simulator, objective = self.chosen["simulator"], self.chosen["objective"]
        suppliers.append(("simulator or objective", measures_of_simulations(simulator, objective)))
        supplied = sorted({name for _, names in suppliers for name in names})
        for role, population in self.populations.items():
            path = ("populations", role, "evolver")
            for wanted in wanted_by(population.evolver.component):
                count = sum(names.count(wanted) for _, names in suppliers)
                if count == 0:
                    known = ", ".join(supplied)
                    yield Fault(
                        path, f"wants the measure '{wanted}', which nothing supplies; supplied: {known}"
                    )
                elif count > 1:
                    listed = ", ".join(key for key, names in suppliers if wanted in names)
                    yield Fault(path, f"wants the measure '{wanted}', which several supply: {listed}")

    def _roles(self) -> Iterator[Fault]:
        """Check that required roles are provided, and only once, in the order of decoding."""
        if not self.complete:
            return
        steps: list[tuple[tuple[str, ...], Encoder | RoleProvider]] = [
            (("populations", name, "encoder"), population.encoder.component)
            for name, population in self.populations.items()
        ]
        others = [(("roles", n, "provider"), role.provider.component) for n, role in self.roles.items()]
        before = [step for step in others if not step[1].requires]
        after = [step for step in others if step[1].requires]
        provided: dict[str, tuple[str, ...]] = {}
        for path, provider in [*before, *steps, *after]:
            for needed in provider.requires:
                if needed not in provided:
                    yield Fault(path, f"requires the role '{needed}', which nothing before it provides")
            for given in provider.provides:
                if given in provided:
                    yield _provided_twice(given, provided[given], path)
            provided |= dict.fromkeys(provider.provides, path)
        simulator = self.chosen.get("simulator")
        for needed in simulator.requires if simulator else ():
            if needed not in provided:
                yield Fault(("simulator",), f"requires the role '{needed}', which no population provides")

    def _array_types(self) -> Iterator[Fault]:
        """Check that encoders receive arrays of the types that they declare."""
        provided: dict[str, ArrayType] = {}
        for name, population in self.populations.items():
            encoder = population.encoder.component
            declared = array_types_of(encoder)
            for role in encoder.requires:
                if role in declared and role in provided and not declared[role].accepts(provided[role]):
                    message = f"requires {declared[role]} for the role '{role}', found {provided[role]}"
                    yield Fault(("populations", name, "encoder"), message)
            provided |= {role: type_ for role, type_ in declared.items() if role in encoder.provides}

    def _record(self) -> Iterator[Fault]:
        if "simulator" in self.chosen and "objective" in self.chosen:
            check = functools.partial(self.chosen["simulator"].check, self.chosen["objective"].record)
            yield from _refusal(("objective",), check, involves=("simulator",))


def _refusal(
    path: tuple[str, ...], check: Callable[[], object], involves: tuple[str, ...] = ()
) -> Iterator[Fault]:
    try:
        check()
    except ConfigurationError as error:
        yield Fault(path, _in_place(str(error), path), involves)


def _in_place(advice: str, path: tuple[str, ...]) -> str:
    """Return *advice* of a component about its options with the keys of the place where it was chosen."""
    *_, key = path
    return advice.replace(f" {key}.", f" {'.'.join(path)}.") if key in SHARED else advice


def _provided_twice(role: str, one: tuple[str, ...], other: tuple[str, ...]) -> Fault:
    """Return the fault of two providers of a role; it is that of the one that does not evolve, if any."""
    at, against = (one, other) if one[0] == "roles" else (other, one)
    message = f"provides the role '{role}', which {'.'.join(against)} also provides"
    return Fault(at, f"{message}; set its option for the roles" if at[0] == "roles" else message)
