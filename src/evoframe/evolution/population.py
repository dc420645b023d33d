"""One population of a run: its genomes, their fitness, and a summary of its history."""

from __future__ import annotations

import math
import numbers
from collections.abc import Callable, Mapping, Sequence
from types import MappingProxyType
from typing import Any, TypeAlias

import attrs
import numpy as np
from attrs.validators import ge
from numpy.typing import NDArray

from evoframe.contract import (
    Archived,
    ArrayType,
    Choice,
    Design,
    Encoder,
    EvolverRun,
    Member,
    Network,
    PopulationReport,
    SupportsLoad,
    SupportsSeeds,
    array_types_of,
    blaming,
)
from evoframe.documents import structure
from evoframe.errors import ComponentError, ConfigurationError, RunError
from evoframe.files import json_text

__all__ = ["Population"]

_Generation: TypeAlias = tuple[Sequence[Any], tuple[Member, ...]]
"""Genomes, and the individuals that have them."""

_NO_MEASURES: Mapping[str, Sequence[float | None]] = MappingProxyType({})

_PLAIN = {(int, int, int, int), (int, int, int, type(None))}
"""Types of the id, the size, the age and the species of a member that need no conversion."""


@attrs.define
class Population:
    """A population that evolves one role.

    Attributes:
        name: The role.
        encoder: Decodes its networks.
        evolver: Evolves its genomes.
        rng: Random stream for the choice of its collaborators.
        wants: Names of the measures that its evolver receives.
        source: Run whose genomes it starts with; they must be given by :meth:`seed`. Empty for none.
        generation: Number of generations since the initial one; -1 before that.
        genomes: The current genomes.
        members: The individuals, one for each genome.
    """

    name: str
    encoder: Encoder
    evolver: EvolverRun
    rng: np.random.Generator
    wants: tuple[str, ...] = ()
    source: str = ""
    generation: int = -1
    genomes: Sequence[Any] = ()
    members: tuple[Member, ...] = ()
    _array_types: Mapping[str, ArrayType] = attrs.field(init=False)
    _accepted: dict[str, tuple[np.dtype[Any], tuple[int, ...]]] = attrs.field(factory=dict, init=False)
    _candidates: _Generation | None = attrs.field(default=None, init=False)
    _guests: list[tuple[Member, Any]] = attrs.field(factory=list, init=False)
    _networks: dict[int, Network] = attrs.field(factory=dict, init=False)
    _offspring: _Generation | ComponentError | None = attrs.field(default=None, init=False)
    _state: dict[str, Any] | None = attrs.field(default=None, init=False)
    _measures: dict[str, NDArray[np.float64]] = attrs.field(factory=dict, init=False)
    _best_so_far: float | None = attrs.field(default=None, init=False)
    _lowest: float | None = attrs.field(default=None, init=False)
    _champion: Member | None = attrs.field(default=None, init=False)

    def __attrs_post_init__(self) -> None:
        self._array_types = array_types_of(self.encoder)

    @property
    def candidates(self) -> Sequence[Member]:
        """The individuals among which collaborators are chosen: see :meth:`reproduce`."""
        return self.members if self._candidates is None else self._candidates[1]

    @property
    def present(self) -> tuple[Member, ...]:
        """The members, followed by the individuals that were admitted in this turn."""
        return (*self.members, *(member for member, _ in self._guests)) if self._guests else self.members

    def seed(self, genomes: Sequence[Any]) -> None:
        """Start with these *genomes*, given as JSON values; called before the first :meth:`reproduce`.

        Raises:
            ConfigurationError: The evolver cannot start with them.
        """
        if not isinstance(self.evolver, SupportsSeeds):
            raise ConfigurationError(
                "the evolver cannot start with given genomes; choose another, or remove "
                f"populations.{self.name}.start",
                key=self._evolver,
            )
        try:
            self.evolver.seed([self.evolver.load(genome) for genome in genomes])
            self.source = ""
        except ValueError as error:
            raise ConfigurationError(
                f"does not accept a genome: {error}", key=f"populations.{self.name}.start"
            ) from error

    def begin_turn(self) -> None:
        """Dismiss the individuals that were admitted in the turn before."""
        for position in range(len(self.members), len(self.members) + len(self._guests)):
            self._networks.pop(position, None)
        self._guests, self._candidates = [], None

    def admit(self, choice: Choice) -> int:
        """Return the position of a collaborator; one that is not a member is admitted for this turn.

        Args:
            choice: Index of a candidate, or an archived individual.
        """
        if not isinstance(choice, Archived):
            if self._candidates is None:
                return int(choice)
            member, genome = self._candidates[1][choice], self._candidates[0][choice]
            return self._admitted(member, lambda: genome)
        return self._admitted(choice.member, lambda: self._loaded(choice))

    def _admitted(self, member: Member, genome: Callable[[], Any]) -> int:
        for position, present in enumerate(self.present):
            if present.id == member.id:
                return position
        self._guests.append((member, genome()))
        return len(self.members) + len(self._guests) - 1

    def _loaded(self, archived: Archived) -> Any:
        with blaming(self._evolver, f"{self.name} {archived.member.id}"):
            if not isinstance(self.evolver, SupportsLoad):
                raise TypeError("cannot load the genome of an archived individual: it has no method 'load'")
            return self.evolver.load(archived.genome)

    def _genome(self, position: int) -> Any:
        there = position - len(self.members)
        return self.genomes[position] if there < 0 else self._guests[there][1]

    def reproduce(self, *, keep_candidates: bool = False) -> None:
        """Replace the genomes with the next generation; first, with the initial one.

        Args:
            keep_candidates: Whether collaborators are chosen from the generation before, in this turn.
        """
        if self.source and self.generation < 0:
            raise RunError(
                f"population '{self.name}' starts with genomes of the run {self.source}, which were not given"
            )
        before = (self.genomes, self.members) if keep_candidates else None
        offspring = self._offspring or self._next_generation()
        if isinstance(offspring, ComponentError):
            raise offspring
        self.genomes, self.members = offspring
        self._candidates = before
        self.generation += 1
        self._offspring = self._state = None
        self._networks.clear()

    def breed(self) -> None:
        """Have the evolver create the next generation before :meth:`reproduce` is called.

        Until then, the genomes, the members and :meth:`state` are those of the current generation. An error
        of the evolver is raised by :meth:`reproduce`, since the turn in progress does not depend on it.
        """
        self.state()  # which the evolver cannot return later
        try:
            self._offspring = self._next_generation()
        except ComponentError as error:
            self._offspring = error

    def _next_generation(self) -> _Generation:
        with blaming(self._evolver):
            genomes = list(self.evolver.ask())
            members = tuple(self._plain(member) for member in self.evolver.members())
            counts = len(genomes), len(members)
        if counts[0] < 1 or counts[0] != counts[1] or counts[0] != (len(self.genomes) or counts[0]):
            wanted = f", expected {len(self.genomes)} of each" if self.genomes else ""
            raise ComponentError(
                self._evolver, f"returned {counts[0]} genomes and {counts[1]} members{wanted}"
            )
        return genomes, members

    def network(self, position: int) -> Network:
        """Return the network that the genome at *position* expresses."""
        if position not in self._networks:
            with blaming(self._evolver, self.called(position)):
                network = self.evolver.express(self._genome(position))
            self._networks[position] = _Remembering(network, self._evolver, self.called(position))
        return self._networks[position]

    def dump(self, position: int) -> Any:
        """Return the genome at *position* as JSON values."""
        with blaming(self._evolver, self.called(position)):
            genome = self.evolver.dump(self._genome(position))
            json_text({"genomes": {self.name: genome}})  # fails here, so that the evolver is named
            return genome

    def archivable(self, position: int) -> Any:
        """Return the genome at *position* for an archive.

        Raises:
            ComponentError: The evolver could not load it again.
        """
        if not isinstance(self.evolver, SupportsLoad):
            problem = (
                "cannot load genomes (it has no method 'load'), which an archive of collaborators requires"
            )
            raise ComponentError(self._evolver, problem)
        return self.dump(position)

    def decode(self, position: int, design: Design) -> Design:
        """Return *design* with the roles that the genome at *position* provides.

        Raises:
            ComponentError: Evolver or encoder failed, or the design lacks a role that the encoder provides.
        """
        network = self.network(position)
        if self._array_types:
            self._refuse_arrays(design, self.encoder.requires, "received", position)
        with blaming(self._encoder, self.called(position)):
            decoded = self.encoder.decode(network, design)
            lacking = [role for role in self.encoder.provides if role not in decoded.roles]
        if lacking:
            raise ComponentError(
                self._encoder, f"did not provide the role '{lacking[0]}'", self.called(position)
            )
        if self._array_types:
            self._refuse_arrays(decoded, self.encoder.provides, "provided", position)
        return decoded

    def _refuse_arrays(self, design: Design, roles: Sequence[str], verb: str, position: int) -> None:
        """Refuse arrays whose types or shapes differ from those that the encoder declares."""
        for role in roles:
            array = design.roles[role]
            if self._accepted.get(role) == (array.dtype, array.shape):  # as the one before
                continue
            declared = self._array_types.get(role)
            if declared is not None and not declared.accepts(there := ArrayType.of(array)):
                problem = f"{verb} {there} for the role '{role}', expected {declared}"
                raise ComponentError(self._encoder, problem, self.called(position))
            self._accepted[role] = array.dtype, array.shape

    def called(self, position: int) -> str:
        """Return the name of the individual at *position* in errors."""
        return f"{self.name} {self.present[position].id}"

    @property
    def _evolver(self) -> str:
        return f"populations.{self.name}.evolver"

    @property
    def _encoder(self) -> str:
        return f"populations.{self.name}.encoder"

    def judge(
        self,
        fitness: Sequence[float | None],
        floor: float | None,
        measures: Mapping[str, Sequence[float | None]] = _NO_MEASURES,
    ) -> None:
        """Set the fitness of all genomes.

        Args:
            fitness: One value per genome; ``None`` if a simulation diverged. Such a genome gets the lowest
                fitness of the other genomes in this turn; if all diverged, the lowest fitness of earlier
                turns.
            floor: Fitness of such a genome if there are no earlier turns either: the lowest score of this
                turn; ``None`` without scores.
            measures: The measures that the evolver wants: one value per genome; ``None`` if a simulation
                diverged. Such a genome gets the lowest value of the others, or 0.

        Raises:
            RunError: All simulations of the initial turn diverged.
        """
        lowest = min((value for value in fitness if value is not None), default=self._lowest)
        if lowest is None:
            lowest = floor
        if lowest is None:
            raise RunError(
                "all simulations of the initial turn diverged, so no fitness can be assigned; "
                "check the simulator's options (time step, stiffness, density)"
            )
        self._lowest = lowest if self._lowest is None else min(lowest, self._lowest)
        self._state = None
        complete = np.array([lowest if value is None else value for value in fitness])
        self._measures = {name: _completed(values) for name, values in measures.items()}
        with blaming(self._evolver):
            self.evolver.tell(complete, self._measures)
        self._note_members(complete, [value is None for value in fitness])
        self._note_champion()

    def fittest(self) -> int:
        """Return the position of the fittest member; a diverged one only if there is no other.

        Raises:
            RunError: The population has no members yet, or they have no fitness.
        """
        if not self.members:
            raise RunError(f"population '{self.name}' has no members before the first turn")
        return max(range(len(self.members)), key=lambda position: (_rank(self.members[position]), -position))

    def ranked(self) -> list[int]:
        """Return the positions of all members, the fittest first, diverged ones last, ties by position."""
        ranks = [(m.diverged, -_fitness(m), position) for position, m in enumerate(self.members)]
        return [position for *_, position in sorted(ranks)]

    def report(self) -> PopulationReport:
        """Return the report of the latest turn, in which the population must have been evaluated."""
        if self._champion is None or self._best_so_far is None:
            raise RunError(f"population '{self.name}' has no fitness before its first evaluation")
        fitness = [_fitness(member) for member in self.members]
        return PopulationReport(
            population=self.name,
            generation=self.generation,
            members=self.members,
            best=fitness[self.fittest()],
            best_so_far=self._best_so_far,
            standing_champion=_fitness(self._champion),
            mean=math.fsum(fitness) / len(fitness),
            measures={name: tuple(values.tolist()) for name, values in self._measures.items()},
        )

    def state(self) -> dict[str, Any]:
        """Return everything needed to continue, as JSON values."""
        if self._state is None:
            with blaming(self._evolver):
                evolver = self.evolver.state()
            self._state = {
                "evolver": evolver,
                "rng": self.rng.bit_generator.state,
                "generation": self.generation,
                "diverged": [member.diverged for member in self.members],
                "best_so_far": self._best_so_far,
                "lowest": self._lowest,
                "champion": attrs.asdict(self._champion) if self._champion else None,
            }
        return self._state

    def restore(self, state: Any) -> None:
        """Continue from the result of :meth:`state`.

        Raises:
            StructureError: The state is invalid; names the key.
            ValueError: The evolver or the random stream rejects its state.
        """
        saved = structure(state, _Saved, (self.name,))
        with blaming(self._evolver, self.name):
            self.evolver.restore(saved.evolver)
        self.rng.bit_generator.state = saved.rng
        self.generation = saved.generation
        self.genomes = self.evolver.genomes()
        self._offspring = self._state = self._candidates = None
        self._guests = []
        self._networks.clear()
        self.members = tuple(
            attrs.evolve(member, diverged=diverged)
            for member, diverged in zip(map(self._plain, self.evolver.members()), saved.diverged, strict=True)
        )
        self._best_so_far, self._lowest, self._champion = saved.best_so_far, saved.lowest, saved.champion

    def _note_members(self, fitness: NDArray[np.float64], diverged: Sequence[bool]) -> None:
        with blaming(self._evolver):
            self.members = tuple(
                attrs.evolve(self._plain(member), fitness=float(value), diverged=failed)
                for member, value, failed in zip(self.evolver.members(), fitness, diverged, strict=True)
            )

    def _plain(self, member: Member) -> Member:
        """Return *member* with Python integers, which the record requires."""
        given = (member.id, member.genome_size, member.age)
        if (*map(type, given), type(member.species)) in _PLAIN:
            return member
        wrong = [value for value in given if not isinstance(value, numbers.Integral)]
        if not isinstance(member.species, numbers.Integral | None):
            wrong.append(member.species)
        if wrong:
            raise ComponentError(self._evolver, f"returned a member with {wrong[0]!r}, expected an integer")
        key, size, age = map(int, given)
        species = None if member.species is None else int(member.species)
        return attrs.evolve(member, id=key, genome_size=size, age=age, species=species)

    def _note_champion(self) -> None:
        """Replace the standing champion if the fittest member exceeds its latest fitness (authors' code)."""
        best = self.members[self.fittest()]
        if self._best_so_far is None or _fitness(best) > self._best_so_far:
            self._best_so_far = _fitness(best)
        latest = {member.id: member for member in self.members}
        if self._champion is not None:
            self._champion = latest.get(self._champion.id, self._champion)
        if self._champion is None or _rank(best) > _rank(self._champion):
            self._champion = best


@attrs.define
class _Remembering:
    """A network that remembers its values for the latest read-only points.

    An encoder that evaluates the whole canvas for each body thus computes the same values only once.
    """

    _network: Network
    _evolver: str
    _individual: str
    _points: NDArray[np.float64] | None = None
    _values: NDArray[np.float64] = attrs.field(factory=lambda: np.empty(0))

    def __call__(self, points: NDArray[np.float64]) -> NDArray[np.float64]:
        if points is self._points:
            return self._values
        with blaming(self._evolver, self._individual):  # an encoder calls it
            values = self._network(points)
        if points.flags.writeable:
            return values
        values = values.copy()  # the network may use its array again
        values.setflags(write=False)
        self._points, self._values = points, values
        return values


@attrs.frozen
class _Saved:
    """The document that :meth:`Population.state` returns."""

    evolver: Any
    rng: dict[str, Any]
    generation: int = attrs.field(validator=ge(-1))
    diverged: tuple[bool, ...]
    best_so_far: float | None
    lowest: float | None
    champion: Member | None


def _completed(values: Sequence[float | None]) -> NDArray[np.float64]:
    lowest = min((value for value in values if value is not None), default=0.0)
    return np.array([lowest if value is None else value for value in values], dtype=np.float64)


def _fitness(member: Member) -> float:
    if member.fitness is None:
        raise RunError(f"genome {member.id} has no fitness before its first evaluation")
    return member.fitness


def _rank(member: Member) -> tuple[bool, float]:
    return not member.diverged, _fitness(member)
