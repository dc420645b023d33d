"""What a component must do.

A component is a *frozen attrs class*: its fields are its options. What needs state while a run goes on is
returned by ``start``. What a component may offer besides is in :mod:`evoframe.contract.optional`. The laws
that each protocol names are tests in :mod:`evoframe.testing`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any, Protocol, TypeAlias, TypeVar, runtime_checkable

import numpy as np
from numpy.typing import NDArray

from evoframe.contract.values import Design, Member, Outcome, Record, Scores

__all__ = [
    "Aggregator",
    "CollaborationStrategy",
    "Encoder",
    "Evolver",
    "EvolverRun",
    "Executor",
    "ExecutorRun",
    "Network",
    "Objective",
    "Simulator",
]

T = TypeVar("T")
R = TypeVar("R")

Network: TypeAlias = Callable[[NDArray[np.float64]], NDArray[np.float64]]
"""What a genome expresses: ``float64[n, inputs] -> float64[n, outputs]``, all points at once, finite."""


@runtime_checkable
class Aggregator(Protocol):
    """Folds the scores that an individual got with its collaborators into its fitness.

    Laws: the order of the scores is irrelevant, to the last bit; the result is finite for finite scores up to
    1e100; and for scores within ``domain``, to a relative 1e-12: min <= result <= max, equal scores give that
    score, and the result is no less when a score grows. A class may break one of the last three laws if it
    says why: see :class:`~evoframe.SupportsExemptions`.
    """

    @property
    def domain(self) -> tuple[float, float]:
        """The least and the greatest score for which all laws hold."""

    def check(self, n: int) -> None:
        """Refuse a number of collaborators before anything runs.

        Raises:
            ConfigurationError: *n* scores cannot be aggregated; says what could be.
        """

    def aggregate(self, scores: Scores) -> float:
        """Return the fitness of an individual with these *scores* (``float64[n]``, n >= 1, finite)."""


@runtime_checkable
class CollaborationStrategy(Protocol):
    """Chooses the members of another population that individuals are judged with.

    Laws: valid indices, no repeats, as many as declared; the same state of *rng* gives the same choice; ties
    are broken by index; no diverged member is chosen while a clean one is left.
    """

    def size(self, n_members: int) -> int:
        """Return how many collaborators are chosen from a population of *n_members*.

        Raises:
            ConfigurationError: The population is too small; the message names both numbers.
        """

    def select(self, members: Sequence[Member], rng: np.random.Generator) -> NDArray[np.intp]:
        """Return the indices of the chosen *members*, ``intp[size(len(members))]``."""


@runtime_checkable
class Encoder(Protocol):
    """Decodes a network into its part of a design.

    Laws: roles, shapes and dtypes as declared; pure; total: every network gives a design.

    It may offer :class:`~evoframe.SupportsInputNames` and :class:`~evoframe.SupportsOutputNames`.
    """

    @property
    def inputs(self) -> int:
        """Number of inputs that a network needs."""

    @property
    def outputs(self) -> int:
        """Number of outputs that a network needs."""

    @property
    def requires(self) -> tuple[str, ...]:
        """Roles that must be part of a design before :meth:`decode`."""

    @property
    def provides(self) -> tuple[str, ...]:
        """Roles that :meth:`decode` adds to a design."""

    def decode(self, network: Network, design: Design) -> Design:
        """Return *design* with the provided roles, as *network* draws them."""


@runtime_checkable
class EvolverRun(Protocol):
    """An evolver at work on one population.

    Laws: ``restore(state())`` continues bit for bit; draws from its own random stream only.
    """

    def ask(self) -> Sequence[Any]:
        """Return the genomes to evaluate: first the initial ones, later the offspring of those told about."""

    def tell(self, fitness: NDArray[np.float64], measures: Mapping[str, NDArray[np.float64]]) -> None:
        """Take the *fitness* (``float64[n]``, finite, maximised) of the genomes of the last :meth:`ask`.

        Args:
            fitness: One value a genome, in the order of :meth:`ask`.
            measures: Further measures by name, each ``float64[n]``, for evolvers with several objectives.

        Raises:
            ValueError: A wrong number of values, or one that is not finite.
        """

    def members(self) -> Sequence[Member]:
        """Return the current members, in the order of the last :meth:`ask`."""

    def genomes(self) -> Sequence[Any]:
        """Return the genomes of the last :meth:`ask`, also after :meth:`restore`."""

    def express(self, genome: Any) -> Network:
        """Return the network that *genome* encodes."""

    def dump(self, genome: Any) -> Any:
        """Return *genome* as JSON values, for the record."""

    def state(self) -> Any:
        """Return everything needed to continue, as JSON values."""

    def restore(self, state: Any) -> None:
        """Continue from what :meth:`state` returned."""


@runtime_checkable
class Evolver(Protocol):
    """Options of an evolutionary algorithm that works on networks.

    It may offer :class:`~evoframe.SupportsGraph`.
    """

    def check(self, size: int) -> None:
        """Refuse a population size before anything runs.

        Raises:
            ConfigurationError: A population of *size* cannot be evolved with these options.
        """

    def start(self, inputs: int, outputs: int, size: int, rng: np.random.Generator) -> EvolverRun:
        """Begin to evolve *size* genomes that express networks with *inputs* and *outputs*."""


@runtime_checkable
class Simulator(Protocol):
    """Simulates designs.

    Laws: a batch equals its members one by one, bit for bit; any number of threads may call at
    once; recording more changes nothing; equal keys mean equal outcomes; a diverged simulation says so and at
    which step.

    It may offer more, each on its own: :class:`~evoframe.SupportsReading`,
    :class:`~evoframe.SupportsSettings`, :class:`~evoframe.SupportsExport`,
    :class:`~evoframe.SupportsVariants`, :class:`~evoframe.SupportsGeometry`,
    :class:`~evoframe.SupportsRandomControllers` and :class:`~evoframe.SupportsPublished`.
    """

    @property
    def requires(self) -> tuple[str, ...]:
        """Roles that a design must have."""

    @property
    def tracks(self) -> tuple[str, ...]:
        """Names of the points that it can follow; it may accept, and document, tracks of other shapes."""

    def check(self, record: Record) -> None:
        """Refuse a *record* that cannot be delivered.

        Raises:
            ConfigurationError: An unknown track, a sample after the end, or an end before ``record.until``.
        """

    def simulate(self, designs: Sequence[Design], record: Record) -> Sequence[Outcome]:
        """Return the outcome of each of *designs*."""

    def key(self, design: Design, record: Record) -> bytes:
        """Return a key that leaves out what cannot matter to the outcome."""


@runtime_checkable
class Objective(Protocol):
    """Turns the outcome of a simulation into a score, which is maximised.

    Law: finite for every outcome that did not diverge. It may offer :class:`~evoframe.SupportsUnit`.
    """

    @property
    def record(self) -> Record:
        """What must be recorded for :meth:`score`."""

    def score(self, outcome: Outcome) -> float:
        """Return the score of an *outcome* that did not diverge."""


@runtime_checkable
class ExecutorRun(Protocol):
    """Workers that are ready.

    Laws: results come in the order of the items, whatever the number of workers; items are asked for where
    :meth:`map` is called, once, and may be made while others are worked on.
    """

    @property
    def workers(self) -> int:
        """How many items are worked on at once."""

    def map(self, function: Callable[[T], R], items: Iterable[T]) -> list[R]:
        """Return ``[function(item) for item in items]``; an exception of either is raised here.

        Raises:
            WorkerError: The worker of an item was lost: it hung, or its process ended.
        """

    def close(self) -> None:
        """Let the workers go."""


@runtime_checkable
class Executor(Protocol):
    """Options of a way to spread simulations over workers."""

    def start(self) -> ExecutorRun:
        """Make the workers ready."""
