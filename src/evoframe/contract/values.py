"""Small frozen values that the core and the plugins exchange."""

from __future__ import annotations

import itertools
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, TypeAlias

import attrs
import numpy as np
from numpy.typing import NDArray

__all__ = [
    "Archived",
    "ArrayType",
    "BestPair",
    "Choice",
    "Design",
    "Export",
    "FileContents",
    "FileOptions",
    "Judged",
    "Member",
    "Outcome",
    "Pair",
    "PopulationReport",
    "Record",
    "Score",
    "ScoredMeetings",
    "Scores",
    "Turn",
    "Workload",
]

Scores: TypeAlias = NDArray[np.float64]
"""Scores of one individual with each of its collaborators, ``float64[n]``, in the objective's unit."""


def _shapes(roles: Mapping[str, NDArray[Any]]) -> str:
    """Return types and shapes instead of hundreds of numbers."""
    return ", ".join(f"{role}: {array.dtype}{list(array.shape)}" for role, array in roles.items())


def _count(items: Sequence[Any]) -> str:
    return f"<{len(items)} items>"


def _frozen_roles(roles: Mapping[str, NDArray[Any]]) -> dict[str, NDArray[Any]]:
    """Copy writable arrays, so that a design in a cache never changes."""
    frozen = {}
    for role, given in roles.items():
        array = np.asarray(given)
        if array.flags.writeable:
            array = array.copy()
            array.setflags(write=False)
        frozen[role] = array
    return frozen


@attrs.frozen(eq=False)
class Design:
    """A design to simulate: one array for each role, such as ``morphology`` and ``controller``.

    Attributes:
        roles: Role -> array, read-only. The built-in roles are ``morphology`` (``uint8[X, Y, Z]``: 0 empty,
            1 passive, 3 contractile) and ``controller`` (``float64[X, Y, Z]``: phase offsets).
    """

    roles: Mapping[str, NDArray[Any]] = attrs.field(factory=dict, converter=_frozen_roles, repr=_shapes)

    def with_role(self, role: str, array: NDArray[Any]) -> Design:
        """Return a copy with *array* stored under *role*."""
        return Design({**self.roles, role: array})


@attrs.frozen
class ArrayType:
    """Type and shape of the array of a role.

    Attributes:
        dtype: Name of its dtype, such as ``uint8``.
        shape: Lengths of its axes; ``None`` for any length.
    """

    dtype: str
    shape: tuple[int | None, ...]

    def __str__(self) -> str:
        lengths = ", ".join("any" if length is None else str(length) for length in self.shape)
        return f"{self.dtype}[{lengths}]"

    def accepts(self, other: ArrayType) -> bool:
        """Return whether an array can have both types."""
        return (
            self.dtype == other.dtype
            and len(self.shape) == len(other.shape)
            and all(
                None in (own, given) or own == given
                for own, given in zip(self.shape, other.shape, strict=True)
            )
        )

    @classmethod
    def of(cls, array: NDArray[Any]) -> ArrayType:
        """Return type and shape of *array*."""
        return cls(array.dtype.name, array.shape)


@attrs.frozen
class Record:
    """The samples that a simulator records.

    Samples follow the rule of the paper's engine: sample 0 is taken after the first step, each further one
    after the first step that ends at least *every* seconds after the sample before it.

    Recording more tracks or samples changes nothing in an outcome that does not diverge. A simulation may
    judge divergence by what can affect the recorded samples (:class:`~evoframe.SupportsWholeDesigns`): what
    diverges out of their reach, or after the last one, has not diverged for this record.

    Attributes:
        tracks: Names of the tracks. Each point in a simulator's ``tracks`` gives ``float64[samples, 3]`` in
            meters; other tracks that it accepts have the shapes that it documents.
        every: Minimum time between samples, s; 0: a sample after every step.
        samples: Indices of the samples to keep, ascending; ``None`` keeps all.
        initial: Whether the state before the first step is recorded as an additional first row.
        until: Time that the simulation must reach, s: a simulator refuses a record whose last sample would be
            earlier. Nothing else depends on it.
    """

    tracks: tuple[str, ...]
    every: float = 0.0
    samples: tuple[int, ...] | None = None
    initial: bool = False
    until: float = 0.0


@attrs.frozen(eq=False)
class Outcome:
    """The outcome of one simulation.

    Attributes:
        steps: ``int64[samples]``, number of completed steps at each sample.
        times: ``float64[samples]``, simulated time of each sample, s.
        tracks: Name -> ``float64[samples, 3]``, positions in meters, or the shape that the simulator
            documents if the track is not a point; NaN from the divergence on.
        diverged_at: Step at which the simulation diverged, or ``None``. A simulation that cannot start
            diverges at step 0, and may have no samples. It may have diverged out of reach of the samples
            without being reported (:class:`Record`).
        measures: Measures by name that the simulator declares (:class:`~evoframe.SupportsMeasures`).
    """

    steps: NDArray[np.int64]
    times: NDArray[np.float64]
    tracks: Mapping[str, NDArray[np.float64]]
    diverged_at: int | None = None
    measures: Mapping[str, float] = attrs.field(factory=dict)


@attrs.frozen
class Export:
    """A design with its settings, as a file for other programs.

    Attributes:
        data: The bytes of the file.
        left_out: Descriptions of the settings that the format cannot express, such as
            ``fluid drag (750 kg/m3)``.
    """

    data: bytes
    left_out: tuple[str, ...] = ()


@attrs.frozen
class FileOptions:
    """Choices of the user for reading a file with designs.

    Attributes:
        dialect: Name of the program by whose rules the file is read; empty: told by the file.
        base: File that completes one which contains only differences; ``None``: told by the file.
        settings: Options of the simulator that the user sets; they override those of the file.
    """

    dialect: str = ""
    base: Path | None = None
    settings: Mapping[str, Any] = attrs.field(factory=dict)


@attrs.frozen(eq=False)
class FileContents:
    """Contents of a file with designs and settings.

    Attributes:
        designs: The designs with their labels, at least one.
        settings: Options of the simulator that the file contains, as TOML values.
        dialect: Name of the program by whose rules it was read; empty if there is only one.
        notes: What a user should know about the reading, such as a choice between rules; a line each.
    """

    designs: tuple[tuple[str, Design], ...]
    settings: Mapping[str, Any]
    dialect: str = ""
    notes: tuple[str, ...] = ()


@attrs.frozen
class Member:
    """An individual, as collaboration strategies and the record see it.

    Attributes:
        id: Identifier of the genome within its population, for the whole run.
        fitness: Latest fitness; ``None`` before the first evaluation.
        species: Species of the individual; ``None`` if the evolver has no species.
        genome_size: Number of genes (nodes and enabled connections of a network).
        age: Turns of its population since the genome was created.
        diverged: Whether one of the simulations behind its fitness diverged.
    """

    id: int
    fitness: float | None
    species: int | None = None
    genome_size: int = 0
    age: int = 0
    diverged: bool = False


@attrs.frozen(eq=False)
class Archived:
    """An individual that need not be a member of its population any more, as an archive keeps it.

    Attributes:
        member: The individual as it was when it was archived.
        genome: Its genome as JSON values (see :meth:`EvolverRun.dump`).
    """

    member: Member
    genome: Any = attrs.field(repr=False)


Choice: TypeAlias = int | Archived
"""A collaborator: the index of a member, or an archived individual."""


@attrs.frozen
class Judged:
    """An individual that is about to be evaluated, as collaboration strategies see it.

    Attributes:
        member: The individual; its fitness is ``None`` if it is new.
        collaborators: Ids of the collaborators from the other population in its last evaluation; empty if it
            is new.
        index: Its index in its population, which is its place if populations have a shape.
    """

    member: Member
    collaborators: tuple[int, ...] = ()
    index: int = attrs.field(kw_only=True)


@attrs.frozen(eq=False)
class ScoredMeetings:
    """The scored meetings of a turn: who met whom, and the scores.

    Attributes:
        turn: Index of the turn.
        populations: Names of the populations, in the order of decoding.
        members: The individuals of each population that could take part: first all its members, then archived
            individuals. Those that are evaluated in this turn have the fitness of their last evaluation, or
            ``None``, while their credit is computed.
        present: Number of members of each population; further individuals are archived ones.
        meetings: ``intp[n, populations]``: for each meeting and population, an index in its ``members``.
            Meetings are unique.
        scores: ``float64[n]``, in the objective's unit; NaN if the simulation diverged.
    """

    turn: int
    populations: tuple[str, ...]
    members: tuple[tuple[Member, ...], ...] = attrs.field(repr=lambda members: str(list(map(len, members))))
    present: tuple[int, ...]
    meetings: NDArray[np.intp] = attrs.field(repr=_count)
    scores: NDArray[np.float64] = attrs.field(repr=_count)

    def of(self, population: int) -> list[NDArray[np.intp]]:
        """Return for each member of a population the indices of its meetings, in their order."""
        who = self.meetings[:, population]
        order = np.argsort(who, kind="stable").astype(np.intp)
        ends = np.searchsorted(who[order], np.arange(self.present[population] + 1))
        return [order[start:end] for start, end in itertools.pairwise(ends)]


@attrs.frozen
class Score:
    """The score of a design.

    Attributes:
        value: The score, in the objective's unit; ``None`` if the simulation diverged.
        diverged_at: Step at which the simulation diverged, or ``None``.
        window: First and last simulated time on which the score depends, s; ``None`` if the simulation
            diverged. Scores are compared without it.
        measures: Further measures by simulator and objective, by name; empty if the simulation diverged.
    """

    value: float | None
    diverged_at: int | None = None
    window: tuple[float, float] | None = attrs.field(default=None, eq=False, repr=False)
    measures: Mapping[str, float] = attrs.field(factory=dict, eq=False, repr=False)


@attrs.frozen
class Pair:
    """One member of each population, simulated together, and their score.

    Attributes:
        genomes: One genome id for each population, in the order of the populations.
        score: The objective's score; ``None`` if the simulation diverged.
        diverged_at: Step at which the simulation diverged, or ``None``.
    """

    genomes: tuple[int, ...]
    score: float | None
    diverged_at: int | None = None


@attrs.frozen(eq=False)
class BestPair:
    """The best simulated pair so far.

    Attributes:
        turn: Turn in which the pair was simulated.
        score: Score of the pair, in the objective's unit.
        genome_ids: Population -> id of its genome.
        genomes: Population -> its genome as JSON values (see :meth:`EvolverRun.dump`).
        design: The decoded design.
    """

    turn: int
    score: float
    genome_ids: Mapping[str, int]
    genomes: Mapping[str, Any] = attrs.field(repr=False)
    design: Design


@attrs.frozen
class PopulationReport:
    """The state of a population after its evaluation.

    Attributes:
        population: Name of the population (the role that it evolves).
        generation: Number of generations since the initial one.
        members: All members, with the fitness of this turn.
        best: Best fitness of this turn.
        best_so_far: Best fitness of this turn and all earlier turns.
        standing_champion: Latest fitness of the standing champion, which is replaced when the fittest member
            exceeds it (as in the authors' code). It can fall when the standing champion is paired with new
            collaborators, and is constant after that individual has left the population.
        mean: Mean fitness of this turn.
        measures: Measures that its evolver wants: name -> one value for each member.
    """

    population: str
    generation: int
    members: tuple[Member, ...] = attrs.field(repr=_count)
    best: float
    best_so_far: float
    standing_champion: float
    mean: float
    measures: Mapping[str, tuple[float, ...]] = attrs.field(factory=dict, repr=lambda given: str(list(given)))


@attrs.frozen
class Workload:
    """The workload of a turn; it is not part of the result, and may differ between runs with equal results.

    Attributes:
        pairs: Number of scored pairs.
        simulations: Number of simulated pairs; the scores of the others came from the cache.
        seconds: Wall-clock time of the turn.
    """

    pairs: int
    simulations: int
    seconds: float


@attrs.frozen
class Turn:
    """One turn of a run.

    Attributes:
        index: 0 for the initial turn, in which every individual is paired with every individual of the other
            populations; then 1, 2, ...
        reports: One for each evaluated population: all in turn 0, then one per turn; none in the turn of the
            final pair, if there is one.
        pairs: All scored pairs, in the order of evaluation.
        best_pair: The best pair so far, if it was found in this turn.
        workload: Pairs, simulations and time of the turn.
    """

    index: int
    reports: tuple[PopulationReport, ...]
    pairs: tuple[Pair, ...] = attrs.field(repr=_count)
    best_pair: BestPair | None
    workload: Workload = attrs.field(eq=False)
