"""Small frozen values that travel between the core and the plugins."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, TypeAlias

import attrs
import numpy as np
from numpy.typing import NDArray

__all__ = [
    "BestPair",
    "Design",
    "Export",
    "Member",
    "Outcome",
    "Pair",
    "PopulationReport",
    "Record",
    "Score",
    "Scores",
    "Turn",
    "Workload",
]

Scores: TypeAlias = NDArray[np.float64]
"""Scores of one individual with each of its collaborators, ``float64[n]``, in the objective's unit."""


def _frozen_roles(roles: Mapping[str, NDArray[Any]]) -> dict[str, NDArray[Any]]:
    """Copy what others could still write to, so that a design never changes under a cache."""
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
    """What is simulated: one array for every role, such as ``morphology`` and ``controller``.

    Attributes:
        roles: Role -> array, read-only. The built-in roles are ``morphology`` (``uint8[X, Y, Z]``: 0 empty,
            1 passive, 3 contractile) and ``controller`` (``float64[X, Y, Z]``: phase offsets).
    """

    roles: Mapping[str, NDArray[Any]] = attrs.field(factory=dict, converter=_frozen_roles)

    def with_role(self, role: str, array: NDArray[Any]) -> Design:
        """Return the design that has *array* as its *role* too."""
        return Design({**self.roles, role: array})


@attrs.frozen
class Record:
    """What a simulator is asked to keep of a simulation.

    Samples follow the rule of the paper's engine: sample 0 is taken after the first step, each further one
    after the first step that ends at least *every* seconds after the sample before it.

    Attributes:
        tracks: Names of what to follow. Each of the points in a simulator's ``tracks`` gives
            ``float64[samples, 3]`` in metres; other tracks that it accepts have the shapes that it documents.
        every: Seconds between samples; 0 samples after every step.
        samples: The indices of the samples to keep, ascending; ``None`` keeps all of them.
        initial: Whether the state before the first step is kept too, as a row of its own in front.
        until: Seconds that the simulation must reach: a simulator refuses a record whose last sample would
            come before. It changes nothing else.
    """

    tracks: tuple[str, ...]
    every: float = 0.0
    samples: tuple[int, ...] | None = None
    initial: bool = False
    until: float = 0.0


@attrs.frozen(eq=False)
class Outcome:
    """What came out of one simulation.

    Attributes:
        steps: ``int64[samples]``, how many steps had been made at each sample.
        times: ``float64[samples]``, the simulated time of each sample, s.
        tracks: Name -> ``float64[samples, 3]``, positions in metres, or what the simulator documents of a
            track that is no point; NaN from the divergence on.
        diverged_at: The step at which the simulation diverged, or ``None``. What could not even begin has
            diverged at step 0, and may have no samples.
    """

    steps: NDArray[np.int64]
    times: NDArray[np.float64]
    tracks: Mapping[str, NDArray[np.float64]]
    diverged_at: int | None = None


@attrs.frozen
class Export:
    """A design with its settings, as a file that other programs read.

    Attributes:
        data: The bytes of the file.
        left_out: What the format cannot say, one entry for each setting, in words, such as
            ``fluid drag (750 kg/m3)``.
    """

    data: bytes
    left_out: tuple[str, ...] = ()


@attrs.frozen
class Member:
    """What a collaboration strategy and the record see of an individual.

    Attributes:
        id: Identifies the genome within its population, for the whole run.
        fitness: Its latest fitness; ``None`` before the first evaluation.
        species: The species it belongs to, ``None`` where an evolver has none.
        genome_size: Number of genes (nodes and enabled connections of a network).
        age: Turns of its population since the genome came into being.
        diverged: Whether one of the simulations behind its fitness diverged.
    """

    id: int
    fitness: float | None
    species: int | None = None
    genome_size: int = 0
    age: int = 0
    diverged: bool = False


@attrs.frozen
class Score:
    """What a design scored.

    Attributes:
        value: In the objective's unit; ``None`` if the simulation diverged.
        diverged_at: The step at which it diverged, or ``None``.
    """

    value: float | None
    diverged_at: int | None = None


@attrs.frozen
class Pair:
    """One encounter of the members of all populations, and its score.

    Attributes:
        genomes: One genome id for each population, in the order of the populations.
        score: The objective's score, ``None`` if the simulation diverged.
        diverged_at: The step at which it diverged, or ``None``.
    """

    genomes: tuple[int, ...]
    score: float | None
    diverged_at: int | None = None


@attrs.frozen(eq=False)
class BestPair:
    """The best pair that was really simulated so far.

    Attributes:
        turn: The turn in which it was simulated.
        score: Its score, in the objective's unit.
        genome_ids: Population -> id of its genome.
        genomes: Population -> its genome as JSON (see :meth:`EvolverRun.dump`).
        design: The decoded design.
    """

    turn: int
    score: float
    genome_ids: Mapping[str, int]
    genomes: Mapping[str, Any]
    design: Design


@attrs.frozen
class PopulationReport:
    """The state of a population after it was evaluated.

    Attributes:
        population: Its name (the role that it evolves).
        generation: How often it has reproduced.
        members: All its members, with the fitness of this turn.
        best: The best fitness of this turn.
        best_so_far: The best fitness of this turn and all before it.
        standing_champion: Fitness of the standing champion at its latest evaluation (it falls when the
            champion meets new collaborators, and stands still when it has left the population).
        mean: The mean fitness of this turn.
    """

    population: str
    generation: int
    members: tuple[Member, ...]
    best: float
    best_so_far: float
    standing_champion: float
    mean: float


@attrs.frozen
class Workload:
    """How a turn's work was done; differs between equal runs, so it is no part of their result.

    Attributes:
        pairs: Pairs that were scored.
        simulations: Pairs that had to be simulated; the others were served from the cache.
        seconds: Wall-clock time of the turn.
    """

    pairs: int
    simulations: int
    seconds: float


@attrs.frozen
class Turn:
    """What happened in one turn.

    Attributes:
        index: 0 for the initial meeting of everyone with everyone, then 1, 2, ...
        reports: One for each population that was judged: all of them in turn 0, later one; none in the
            closing meeting of the fittest, where there is one.
        pairs: Every pair that was scored, in the order of evaluation.
        best_pair: The best pair so far, if this turn found it.
        workload: What the turn cost.
    """

    index: int
    reports: tuple[PopulationReport, ...]
    pairs: tuple[Pair, ...]
    best_pair: BestPair | None
    workload: Workload = attrs.field(eq=False)
