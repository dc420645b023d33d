"""The protocols of components.

A component is a *frozen attrs class*, whose fields are its options. ``start`` returns the objects that have
state during a run. Optional capabilities are in :mod:`evoframe.contract.optional`.
:mod:`evoframe.testing` tests the laws that each protocol names.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any, Protocol, TypeAlias, TypeVar, runtime_checkable

import numpy as np
from numpy.typing import NDArray

from evoframe.contract.values import (
    Choice,
    Design,
    Judged,
    Member,
    Outcome,
    Record,
    ScoredMeetings,
    Scores,
)

__all__ = [
    "Aggregator",
    "CollaborationRun",
    "CollaborationStrategy",
    "Credit",
    "Encoder",
    "Evolver",
    "EvolverRun",
    "Executor",
    "ExecutorRun",
    "Network",
    "Objective",
    "RoleProvider",
    "RoleRun",
    "Simulator",
]

T = TypeVar("T")
R = TypeVar("R")

Network: TypeAlias = Callable[[NDArray[np.float64]], NDArray[np.float64]]
"""A network: ``float64[n, inputs] -> float64[n, outputs]``, all points at once, with finite outputs."""


@runtime_checkable
class Aggregator(Protocol):
    """Aggregates the scores of an individual with its collaborators into its fitness.

    Laws: the result does not depend on the order of the scores, bit for bit; it is finite for finite scores
    up to 1e100. For scores within ``domain``, up to a relative 1e-12: min <= result <= max (bounded), equal
    scores give that score (idempotent), and the result does not decrease when a score increases (monotone). A
    class may violate the last three laws if it states the reasons: see
    :class:`~evoframe.SupportsExemptions`.
    """

    @property
    def domain(self) -> tuple[float, float]:
        """Minimum and maximum score for which all laws hold."""

    def check(self, n: int) -> None:
        """Refuse a number of collaborators before anything runs.

        Raises:
            ConfigurationError: *n* scores cannot be aggregated; names the numbers that can.
        """

    def aggregate(self, scores: Scores) -> float:
        """Return the fitness of an individual with these *scores* (``float64[n]``, n >= 1, finite)."""


@runtime_checkable
class Credit(Protocol):
    """Computes the fitness of individuals from all scored meetings of a turn; offered as an aggregator.

    It knows more than an :class:`Aggregator`: whom each individual met, the fitness of these collaborators,
    and the scores of all others in the same turn. Its fitness need not have the unit of the scores.

    Laws: one finite value for each member, for finite scores up to 1e100; the result does not depend on the
    order of the meetings, bit for bit.
    """

    def check(self, n: int) -> None:
        """Refuse a number of collaborators before anything runs.

        Raises:
            ConfigurationError: *n* collaborators each give no fitness; names the numbers that do.
        """

    def credit(self, meetings: ScoredMeetings, population: int) -> NDArray[np.float64]:
        """Return the fitness of each member of a population, ``float64[present]``.

        Args:
            meetings: All meetings of the turn. Scores of diverged simulations are NaN.
            population: Index of the population whose members are credited; each of them has a meeting.

        Returns:
            One value for each member; that of a member with a diverged simulation is ignored, and can be NaN.
        """


@runtime_checkable
class CollaborationStrategy(Protocol):
    """Chooses the members of another population with which individuals are evaluated.

    Laws: indices are valid, unique, and as many as declared; the same state of *rng* gives the same choice;
    ties are broken by index; a diverged member is chosen only if no other is left.

    Without more, one choice serves a whole turn. It may offer :class:`~evoframe.SupportsEach`, to choose anew
    for each individual, :class:`~evoframe.SupportsMemory`, to remember earlier turns, and
    :class:`~evoframe.SupportsSizes`, to choose different numbers in different turns.
    """

    def size(self, n_members: int) -> int:
        """Return the number of collaborators chosen from a population of *n_members*.

        Raises:
            ConfigurationError: The population is too small; the message names both numbers.
        """

    def select(self, members: Sequence[Member], rng: np.random.Generator) -> NDArray[np.intp]:
        """Return the indices of the chosen *members*, ``intp[size(len(members))]``."""


@runtime_checkable
class CollaborationRun(Protocol):
    """The choices of a strategy for one population among the individuals of another, during a run.

    Laws: collaborators of an individual are different, and as many as the strategy declares; random numbers
    come only from the given generator; ``restore(state())`` continues bit for bit; a diverged individual is
    chosen only if no other is left.
    """

    def choose(
        self, judged: Sequence[Judged], members: Sequence[Member], rng: np.random.Generator
    ) -> Sequence[Sequence[Choice]]:
        """Return the collaborators of each of *judged*: indices of *members*, or archived individuals.

        It can be called several times in a turn, with different individuals or a part of the members.
        """

    def observe(self, meetings: ScoredMeetings, genome: Callable[[int], Any]) -> None:
        """See a turn that has ended, whichever population was evaluated in it.

        Args:
            meetings: The turn. All individuals have the fitness that they have after it.
            genome: Returns the genome of an individual of the other population as JSON values, by its index
                in ``meetings.members``.
        """

    def state(self) -> Any:
        """Return everything needed to continue, as JSON values."""

    def restore(self, state: Any) -> None:
        """Continue from what :meth:`state` returned.

        Raises:
            ValueError: The state is invalid.
        """


@runtime_checkable
class Encoder(Protocol):
    """Decodes a network into its part of a design.

    Laws: roles, shapes and dtypes are as declared; decoding is pure, and total: every network gives a design.

    In a run, a network that is called again with the same read-only array returns the same values, also
    read-only, without evaluating them again.

    It may offer :class:`~evoframe.SupportsInputNames`, :class:`~evoframe.SupportsOutputNames`,
    :class:`~evoframe.SupportsArrayTypes` and :class:`~evoframe.SupportsDesignMeasures`.
    """

    @property
    def inputs(self) -> int:
        """Number of inputs that a network needs; 0 if it is evaluated at points without coordinates."""

    @property
    def outputs(self) -> int:
        """Number of outputs that a network needs."""

    @property
    def requires(self) -> tuple[str, ...]:
        """Roles that a design must have before :meth:`decode`."""

    @property
    def provides(self) -> tuple[str, ...]:
        """Roles that :meth:`decode` adds to a design."""

    def decode(self, network: Network, design: Design) -> Design:
        """Return *design* with the provided roles added, computed from *network*."""


@runtime_checkable
class EvolverRun(Protocol):
    """The evolution of one population.

    Laws: ``restore(state())`` continues bit for bit; random numbers come only from its own stream.

    It may offer :class:`~evoframe.SupportsLoad` and :class:`~evoframe.SupportsSeeds`.
    """

    def ask(self) -> Sequence[Any]:
        """Return the genomes to evaluate: the initial ones, or after :meth:`tell` their offspring.

        The core can call it while another population is evaluated, so genomes of the call before can still be
        in use, and must not change.
        """

    def tell(self, fitness: NDArray[np.float64], measures: Mapping[str, NDArray[np.float64]]) -> None:
        """Receive the *fitness* (``float64[n]``, finite, maximized) of the genomes of the last :meth:`ask`.

        Args:
            fitness: One value per genome, in the order of :meth:`ask`.
            measures: The measures that the evolver wants (:class:`~evoframe.SupportsWants`): name ->
                ``float64[n]``, finite.

        Raises:
            ValueError: The number of values is wrong, or a value is not finite.
        """

    def members(self) -> Sequence[Member]:
        """Return the current members, in the order of the last :meth:`ask`."""

    def genomes(self) -> Sequence[Any]:
        """Return the genomes of the last :meth:`ask`, even after :meth:`restore`."""

    def express(self, genome: Any) -> Network:
        """Return the network that *genome* encodes."""

    def dump(self, genome: Any) -> Any:
        """Return *genome* as JSON values."""

    def state(self) -> Any:
        """Return everything needed to continue, as JSON values."""

    def restore(self, state: Any) -> None:
        """Continue from what :meth:`state` returned."""


@runtime_checkable
class Evolver(Protocol):
    """Options of an evolutionary algorithm for networks.

    It may offer :class:`~evoframe.SupportsGraph` and :class:`~evoframe.SupportsWants`.
    """

    def check(self, size: int) -> None:
        """Refuse a population size before anything runs.

        Raises:
            ConfigurationError: A population of *size* cannot be evolved with these options.
        """

    def start(self, inputs: int, outputs: int, size: int, rng: np.random.Generator) -> EvolverRun:
        """Start the evolution of *size* genomes of networks with these numbers of *inputs* and *outputs*."""


@runtime_checkable
class Simulator(Protocol):
    """Simulates designs.

    Laws: a batch gives the same outcomes as its members one by one, bit for bit; any number of threads may
    call it at the same time; recording more does not change the outcome; equal keys imply equal outcomes; the
    outcome of a diverged simulation states the step of divergence. What diverges within reach of a sample, so
    that it can affect the sample, is recorded as diverged. If a simulator ignores divergences out of reach of
    all samples, it offers :class:`~evoframe.SupportsWholeDesigns`. Recording more then brings more within
    reach, and changes nothing only in outcomes that do not diverge.

    It may offer any of :class:`~evoframe.SupportsReading`,
    :class:`~evoframe.SupportsSettings`, :class:`~evoframe.SupportsDialects`,
    :class:`~evoframe.SupportsObjective`, :class:`~evoframe.SupportsDuration`,
    :class:`~evoframe.SupportsExport`, :class:`~evoframe.SupportsVariants`,
    :class:`~evoframe.SupportsGeometry`, :class:`~evoframe.SupportsRandomControllers`,
    :class:`~evoframe.SupportsPublished`, :class:`~evoframe.SupportsWholeDesigns`,
    :class:`~evoframe.SupportsBatches` and :class:`~evoframe.SupportsMeasures`.
    """

    @property
    def requires(self) -> tuple[str, ...]:
        """Roles that a design must have."""

    @property
    def tracks(self) -> tuple[str, ...]:
        """Names of the points that it can track; it may accept, and document, tracks of other shapes."""

    def check(self, record: Record) -> None:
        """Refuse a *record* that simulations cannot provide.

        Raises:
            ConfigurationError: A track is unknown, a sample is after the end, or the end is before
                ``record.until``.
        """

    def simulate(self, designs: Sequence[Design], record: Record) -> Sequence[Outcome]:
        """Return the outcome of each of *designs*."""

    def key(self, design: Design, record: Record) -> bytes:
        """Return a key that identifies the outcome, independent of irrelevant parts of *design*."""


@runtime_checkable
class Objective(Protocol):
    """Computes the score of a simulation's outcome; scores are maximized.

    Law: the score is finite for every outcome that did not diverge.

    It may offer :class:`~evoframe.SupportsUnit`, :class:`~evoframe.SupportsWindow` and
    :class:`~evoframe.SupportsOutcomeMeasures`.
    """

    @property
    def record(self) -> Record:
        """Samples that :meth:`score` requires."""

    def score(self, outcome: Outcome) -> float:
        """Return the score of an *outcome* that did not diverge."""


@runtime_checkable
class RoleRun(Protocol):
    """A role that no population evolves, during a run.

    Laws: roles are as declared; equal designs and states of the generator give equal results.
    """

    def fill(self, design: Design, rng: np.random.Generator) -> Design:
        """Return *design* with the provided roles added; random ones are drawn from *rng*."""

    def state(self) -> Any:
        """Return what must be the same when the run is resumed, as JSON values, such as a file's checksum."""

    def restore(self, state: Any) -> None:
        """Compare with what :meth:`state` returned when the run started.

        Raises:
            ValueError: It differs; the message says what changed.
        """


@runtime_checkable
class RoleProvider(Protocol):
    """Provides roles of designs that no population evolves: fixed ones, or random ones."""

    @property
    def requires(self) -> tuple[str, ...]:
        """Roles that a design must have before; without any, these roles are provided before all others."""

    @property
    def provides(self) -> tuple[str, ...]:
        """Roles that are added to a design."""

    def start(self, simulator: Simulator) -> RoleRun:
        """Read what is necessary, for designs of this *simulator*.

        Raises:
            ConfigurationError: The simulator cannot provide it.
            InputError: A file cannot be read.
        """


@runtime_checkable
class ExecutorRun(Protocol):
    """Started workers, which process items.

    Laws: results are in the order of the items, whatever the number of workers; the iterable is consumed
    once, in the thread that calls :meth:`map`, possibly while earlier items are processed.
    """

    @property
    def workers(self) -> int:
        """Number of items processed in parallel."""

    def map(self, function: Callable[[T], R], items: Iterable[T]) -> list[R]:
        """Return ``[function(item) for item in items]``; exceptions from either propagate.

        Raises:
            WorkerError: The worker of an item was lost: it hung, or its process ended.
        """

    def close(self) -> None:
        """Shut down the workers."""


@runtime_checkable
class Executor(Protocol):
    """Options of an executor, which distributes simulations over workers."""

    def start(self) -> ExecutorRun:
        """Start the workers."""
