"""One population of a run: its genomes, their fitness, and a summary of its history."""

from __future__ import annotations

import math
import numbers
from collections.abc import Sequence
from typing import Any, TypeAlias

import attrs
import numpy as np
from attrs.validators import ge
from numpy.typing import NDArray

from evoframe.contract import Design, Encoder, EvolverRun, Member, Network, PopulationReport, blaming
from evoframe.documents import structure
from evoframe.errors import ComponentError, RunError
from evoframe.files import json_text

__all__ = ["Population"]

_Generation: TypeAlias = tuple[Sequence[Any], tuple[Member, ...]]
"""Genomes, and the individuals that have them."""

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
        generation: Number of generations since the initial one; -1 before that.
        genomes: The current genomes.
        members: The individuals, one for each genome.
    """

    name: str
    encoder: Encoder
    evolver: EvolverRun
    rng: np.random.Generator
    generation: int = -1
    genomes: Sequence[Any] = ()
    members: tuple[Member, ...] = ()
    _networks: dict[int, Network] = attrs.field(factory=dict, init=False)
    _offspring: _Generation | ComponentError | None = attrs.field(default=None, init=False)
    _state: dict[str, Any] | None = attrs.field(default=None, init=False)
    _best_so_far: float | None = attrs.field(default=None, init=False)
    _lowest: float | None = attrs.field(default=None, init=False)
    _champion: Member | None = attrs.field(default=None, init=False)

    def reproduce(self) -> None:
        """Replace the genomes with the next generation; first, with the initial one."""
        offspring = self._offspring or self._next_generation()
        if isinstance(offspring, ComponentError):
            raise offspring
        self.genomes, self.members = offspring
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
                self._networks[position] = _Remembering(self.evolver.express(self.genomes[position]))
        return self._networks[position]

    def dump(self, position: int) -> Any:
        """Return the genome at *position* as JSON values."""
        with blaming(self._evolver, self.called(position)):
            genome = self.evolver.dump(self.genomes[position])
            json_text({"genomes": {self.name: genome}})  # fails here, so that the evolver is named
            return genome

    def decode(self, position: int, design: Design) -> Design:
        """Return *design* with the roles that the genome at *position* provides.

        Raises:
            ComponentError: Evolver or encoder failed, or the design lacks a role that the encoder provides.
        """
        network = self.network(position)
        with blaming(self._encoder, self.called(position)):
            decoded = self.encoder.decode(network, design)
            lacking = [role for role in self.encoder.provides if role not in decoded.roles]
        if lacking:
            raise ComponentError(
                self._encoder, f"did not provide the role '{lacking[0]}'", self.called(position)
            )
        return decoded

    def called(self, position: int) -> str:
        """Return the name of the individual at *position* in errors."""
        return f"{self.name} {self.members[position].id}"

    @property
    def _evolver(self) -> str:
        return f"populations.{self.name}.evolver"

    @property
    def _encoder(self) -> str:
        return f"populations.{self.name}.encoder"

    def judge(self, fitness: Sequence[float | None], floor: float | None) -> None:
        """Set the fitness of all genomes.

        Args:
            fitness: One value per genome; ``None`` if a simulation diverged. Such a genome gets the lowest
                fitness of the other genomes in this turn; if all diverged, the lowest fitness of earlier
                turns.
            floor: Fitness of such a genome if there are no earlier turns either: the lowest score of this
                turn; ``None`` without scores.

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
        with blaming(self._evolver):
            self.evolver.tell(complete, {})
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
        self.evolver.restore(saved.evolver)
        self.rng.bit_generator.state = saved.rng
        self.generation = saved.generation
        self.genomes = self.evolver.genomes()
        self._offspring = self._state = None
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
    _points: NDArray[np.float64] | None = None
    _values: NDArray[np.float64] = attrs.field(factory=lambda: np.empty(0))

    def __call__(self, points: NDArray[np.float64]) -> NDArray[np.float64]:
        if points is self._points:
            return self._values
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


def _fitness(member: Member) -> float:
    if member.fitness is None:
        raise RunError(f"genome {member.id} has no fitness before its first evaluation")
    return member.fitness


def _rank(member: Member) -> tuple[bool, float]:
    return not member.diverged, _fitness(member)
