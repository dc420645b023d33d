"""Optional capabilities of components, one protocol each.

A component has a capability if it has all members of the protocol; no registration is required. The core
tests this with ``isinstance``, which does not check signatures; the contract tests of :mod:`evoframe.testing`
do.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, Protocol, Self, TypeVar, runtime_checkable

import attrs
import numpy as np
from numpy.typing import NDArray

from evoframe.contract.drawings import Geometry, NetworkGraph
from evoframe.contract.protocols import (
    Aggregator,
    CollaborationRun,
    CollaborationStrategy,
    Credit,
    Encoder,
    Evolver,
    EvolverRun,
    Objective,
    Simulator,
)
from evoframe.contract.values import (
    ArrayType,
    Design,
    Export,
    FileContents,
    FileOptions,
    Judged,
    Member,
    Outcome,
    Record,
)

__all__ = [
    "CORE_MEASURES",
    "SupportsArrayTypes",
    "SupportsBatches",
    "SupportsBitGeneration",
    "SupportsDesignMeasures",
    "SupportsDialects",
    "SupportsDuration",
    "SupportsEach",
    "SupportsExemptions",
    "SupportsExport",
    "SupportsFitnessUnit",
    "SupportsGeometry",
    "SupportsGraph",
    "SupportsInputNames",
    "SupportsLoad",
    "SupportsMeasures",
    "SupportsMemory",
    "SupportsObjective",
    "SupportsOutcomeMeasures",
    "SupportsOutputNames",
    "SupportsProvenance",
    "SupportsPublished",
    "SupportsRandomControllers",
    "SupportsReading",
    "SupportsSeeds",
    "SupportsSettings",
    "SupportsSizes",
    "SupportsUnit",
    "SupportsVariants",
    "SupportsWants",
    "SupportsWholeDesigns",
    "SupportsWindow",
    "Variant",
    "array_types_of",
    "batch_size_of",
    "bit_generation_of",
    "measures_of_designs",
    "measures_of_simulations",
    "unit_of",
    "wanted_by",
    "whole_of",
    "window_of",
]

S = TypeVar("S", bound=Simulator)

CORE_MEASURES = ("age", "genome-size", "novelty")
"""Measures that the core supplies: age in turns, number of genes, and the mean distance of the decoded part
to the nearest 15 of the population (novelty search, Lehman and Stanley 2011, without an archive)."""


@runtime_checkable
class SupportsProvenance(Protocol):
    """A component of any kind that contributes to the provenance of a run."""

    def provenance(self) -> Mapping[str, str]:
        """Return names and versions, such as those of libraries, for ``[provenance.libraries]``."""


@runtime_checkable
class SupportsBitGeneration(Protocol):
    """A component that states the generation of its results; of any kind but an executor.

    A run records the number. With another one it is resumed only if the user allows it, and its scores need
    not be reproduced.
    """

    @property
    def bit_generation(self) -> int:
        """Number to be raised by 1 with every change of a bit of the results for equal arguments.

        The first results have the number 1, which is also that of a component that states none.
        """


@runtime_checkable
class SupportsExemptions(Aggregator, Protocol):
    """An aggregator that deliberately violates a law of its protocol (``evoframe.testing``)."""

    @property
    def exempt_from(self) -> Mapping[str, str]:
        """Name of a law (``bounded``, ``idempotent``, ``monotone``) -> reason; a class attribute."""


@runtime_checkable
class SupportsEach(CollaborationStrategy, Protocol):
    """A strategy that chooses anew for each individual, and may consider who it is.

    Laws: each row obeys the laws of :meth:`CollaborationStrategy.select`, which is not called.
    """

    def select_each(
        self, judged: Sequence[Judged], members: Sequence[Member], rng: np.random.Generator
    ) -> NDArray[np.intp]:
        """Return the collaborators of each of *judged*, ``intp[len(judged), size(len(members))]``."""


@runtime_checkable
class SupportsMemory(CollaborationStrategy, Protocol):
    """A strategy with a memory, whose choices depend on earlier turns."""

    def start(self, population: str, other: str) -> CollaborationRun:
        """Return the choices for the individuals of *population* among those of *other*; both are names."""


@runtime_checkable
class SupportsSizes(CollaborationStrategy, Protocol):
    """A strategy that does not always choose the same number of collaborators."""

    def sizes(self, n_members: int) -> Sequence[int]:
        """Return all numbers of collaborators that it may choose from a population of *n_members*.

        Raises:
            ConfigurationError: The population is too small; the message names both numbers.
        """


@runtime_checkable
class SupportsReading(Simulator, Protocol):
    """A simulator that reads designs from files (``evoframe simulate``, ``verify``, ``robustness``)."""

    def read(self, path: Path) -> Sequence[tuple[str, Design]]:
        """Return the designs of a file, at least one, with their labels.

        Raises:
            InputError: The file cannot be read, or its format is unknown; the error names the file.
        """


@runtime_checkable
class SupportsSettings(Simulator, Protocol):
    """A simulator that reads files which contain settings."""

    def settings_of(self, path: Path) -> Mapping[str, Any] | None:
        """Return the options that a file contains, as TOML values; ``None`` if it contains none.

        The result includes every relevant option, so that none is taken from a preset.

        Raises:
            InputError: The file cannot be read.
        """


@runtime_checkable
class SupportsObjective(Simulator, Protocol):
    """A simulator that suggests the objective for designs of files which contain settings."""

    def objective_for(self, designs: Sequence[Design]) -> Mapping[str, Any]:
        """Return the objective that fits *designs* with these settings: the table ``objective``.

        It is used for files with settings (:class:`SupportsSettings`), which need not be experiments of a
        preset, unless the user names an objective or a preset.

        Returns:
            The table as TOML values, with ``name``; its samples exist in every simulation of the designs.
        """


@runtime_checkable
class SupportsDuration(Simulator, Protocol):
    """A simulator that knows the simulated time in advance, for comparison with what the objective uses."""

    def duration_of(self, design: Design) -> float:
        """Return the time of the last step of a design's simulation, s; 0 if it cannot start."""


@runtime_checkable
class SupportsDialects(SupportsReading, SupportsSettings, Protocol):
    """A simulator whose files depend on choices of the user (``--dialect``, ``--base``, ``--set``)."""

    @property
    def dialects(self) -> tuple[str, ...]:
        """Names of the programs whose rules for files it knows."""

    def interpret(self, path: Path, options: FileOptions) -> FileContents | None:
        """Return the contents of a file; ``None`` if it has no settings and is read by :meth:`read`.

        Settings that ``options.settings`` override need not be valid, nor complete.

        Raises:
            InputError: The file cannot be read, is invalid, or requires a choice that *options* lack.
            ConfigurationError: An option is unknown, or does not fit the file.
        """


@runtime_checkable
class SupportsExport(Simulator, Protocol):
    """A simulator that writes designs as files for other programs (``evoframe export``)."""

    @property
    def formats(self) -> tuple[str, ...]:
        """Formats, each named by the extension of its files."""

    def export(self, design: Design, format_: str) -> Export:
        """Return *design* and the simulator's settings in a format; equal designs give equal bytes.

        Raises:
            ConfigurationError: The format cannot express the settings.
            InputError: The format cannot express the design.
        """


@attrs.frozen(eq=False)
class Variant:
    """A simulation with one change, which shows how the score depends on it.

    Attributes:
        name: The change, as shown in the table of ``evoframe verify``. Variants with the same name are draws
            of one random change.
        simulator: Simulator of the variant.
        design: Design to simulate.
        record: Samples to record: as many of the same tracks as in the unchanged simulation, so that the same
            objective can score them.
        kept: Interpretation if the variant keeps the score, as a clause about the score; may be empty.
        lost: The same if the variant loses the score.
    """

    name: str
    simulator: Simulator
    design: Design
    record: Record
    kept: str = ""
    lost: str = ""


@runtime_checkable
class SupportsVariants(Simulator, Protocol):
    """A simulator that offers variants of a simulation (``evoframe verify``)."""

    def variants(self, design: Design, record: Record) -> Sequence[Variant]:
        """Return simulations of *design* with one change each; equal arguments give equal variants."""


@runtime_checkable
class SupportsWholeDesigns(Simulator, Protocol):
    """A simulator that judges divergence by what can affect the recorded samples (:class:`~evoframe.Record`).

    It need not simulate what cannot affect any sample of a record. If only that would diverge, the design has
    not diverged for that record. ``evoframe verify`` and ``doctor`` simulate whole designs, so that every
    divergence is seen.
    """

    def for_whole_designs(self) -> Self:
        """Return this simulator with another rule: a divergence anywhere counts, whatever is recorded.

        Samples before the divergence are the same, bit for bit. Its variants have this rule, too.
        """


@runtime_checkable
class SupportsGeometry(Simulator, Protocol):
    """A simulator that provides the shape of its designs (figures and pages of reports)."""

    def geometry(self, design: Design, frames: int) -> Geometry:
        """Return a design at rest and at up to *frames* - 1 later times.

        With more than one frame, the design is simulated until the end or until it diverges.
        """


@runtime_checkable
class SupportsRandomControllers(Simulator, Protocol):
    """A simulator that draws random controllers (``evoframe robustness``)."""

    def random_controller(self, design: Design, rng: np.random.Generator) -> Design:
        """Return the same body with a random controller.

        The same state of *rng* gives bodies of the same shape the same controller, whatever their materials.
        """


@runtime_checkable
class SupportsPublished(Simulator, Protocol):
    """A simulator that includes published bodies (``evoframe robustness --published``)."""

    def published(self) -> Sequence[tuple[str, Design]]:
        """Return the bodies with their labels."""


@runtime_checkable
class SupportsBatches(Simulator, Protocol):
    """A simulator that states how many designs it should receive at once."""

    @property
    def batch_size(self) -> int:
        """Largest useful number of designs in a call; near the end of a turn, workers share the rest."""


@runtime_checkable
class SupportsMeasures(Simulator, Protocol):
    """A simulator that measures more than its tracks."""

    @property
    def measures(self) -> tuple[str, ...]:
        """Names of the measures that ``measures`` of every outcome contains, unless it diverged."""


@runtime_checkable
class SupportsDesignMeasures(Encoder, Protocol):
    """An encoder that measures the designs that it decodes, such as the share of filled voxels."""

    @property
    def measures(self) -> tuple[str, ...]:
        """Names of the measures."""

    def measure(self, design: Design) -> Mapping[str, float]:
        """Return all measures of a *design* that :meth:`Encoder.decode` returned; finite."""


@runtime_checkable
class SupportsArrayTypes(Encoder, Protocol):
    """An encoder that declares type and shape of the arrays that it requires or provides."""

    @property
    def array_types(self) -> Mapping[str, ArrayType]:
        """Role -> type and shape of its array; the core checks them before and after decoding."""


@runtime_checkable
class SupportsInputNames(Encoder, Protocol):
    """An encoder that names the inputs of its networks (figures of networks)."""

    @property
    def input_names(self) -> tuple[str, ...]:
        """One name for each input."""


@runtime_checkable
class SupportsOutputNames(Encoder, Protocol):
    """An encoder that names the outputs of its networks (figures of networks)."""

    @property
    def output_names(self) -> tuple[str, ...]:
        """One name for each output."""


@runtime_checkable
class SupportsGraph(Evolver, Protocol):
    """An evolver whose genomes can be drawn as graphs (figures of networks)."""

    def graph(self, genome: Any, inputs: int, outputs: int) -> NetworkGraph:
        """Return the graph of a genome.

        Args:
            genome: Genome from :meth:`~evoframe.EvolverRun.dump`, possibly from a file that was changed.
            inputs: Number of inputs of its network.
            outputs: Number of outputs of its network.

        Raises:
            ValueError: The genome is invalid; the message describes the fault.
        """


@runtime_checkable
class SupportsWants(Evolver, Protocol):
    """An evolver that uses measures besides the fitness, such as further objectives.

    The core supplies those of :data:`CORE_MEASURES`; encoders, objective and simulator may supply others. A
    configuration in which one is missing is refused.
    """

    @property
    def wants(self) -> tuple[str, ...]:
        """Names of the measures that :meth:`EvolverRun.tell` receives."""


@runtime_checkable
class SupportsLoad(EvolverRun, Protocol):
    """The evolution of a population that can express genomes of archives and of other runs."""

    def load(self, dumped: Any) -> Any:
        """Return the genome that :meth:`EvolverRun.dump` returned as *dumped*, for :meth:`express`.

        Law: ``dump(load(dumped)) == dumped``, and both genomes express the same network.

        Raises:
            ValueError: It is not a genome of this population; the message describes the fault.
        """


@runtime_checkable
class SupportsSeeds(SupportsLoad, Protocol):
    """The evolution of a population that can start from given genomes."""

    def seed(self, genomes: Sequence[Any]) -> None:
        """Start from these genomes; called before the first :meth:`ask`, if at all.

        Args:
            genomes: From :meth:`load`, at least one and at most as many as the population has members. The
                initial population contains each of them, in this order; mutants of them fill the rest.
        """


@runtime_checkable
class SupportsOutcomeMeasures(Objective, Protocol):
    """An objective that computes further scores, such as that of a second objective.

    Those of an individual's meetings are aggregated like its scores, to one value for its evolver.
    """

    @property
    def measures(self) -> tuple[str, ...]:
        """Names of the measures."""

    def measure(self, outcome: Outcome) -> Mapping[str, float]:
        """Return all measures of an *outcome* that did not diverge; finite."""


@runtime_checkable
class SupportsFitnessUnit(Credit, Protocol):
    """A credit whose fitness does not have the unit of the scores."""

    @property
    def unit(self) -> str:
        """Unit of the fitness; empty if it has none."""


@runtime_checkable
class SupportsUnit(Objective, Protocol):
    """An objective that states the unit of its scores."""

    @property
    def unit(self) -> str:
        """Unit, such as ``m``."""


@runtime_checkable
class SupportsWindow(Objective, Protocol):
    """An objective whose score does not depend on all samples of its record."""

    def window(self, times: NDArray[np.float64]) -> tuple[float, float]:
        """Return the first and the last time on which the score depends.

        Args:
            times: Times of the recorded samples, ``float64[samples]``, s, ascending; one or more.

        Returns:
            Two of the *times*.
        """


def window_of(objective: Objective, times: NDArray[np.float64]) -> tuple[float, float] | None:
    """Return the first and the last of an outcome's *times* on which the score depends; ``None`` for none.

    An objective that does not support :class:`SupportsWindow` uses all samples of its record.
    """
    if not len(times):
        return None
    window = getattr(objective, "window", None)  # isinstance() takes longer than the computation of a score
    first, last = window(times) if window else (times[0], times[-1])
    return float(first), float(last)


def whole_of(simulator: S) -> S:
    """Return the simulator for whole designs; *simulator* itself unless it :class:`SupportsWholeDesigns`."""
    return simulator.for_whole_designs() if isinstance(simulator, SupportsWholeDesigns) else simulator


def unit_of(objective: Objective) -> str:
    """Return the unit of an objective's scores; empty if it states none."""
    return str(objective.unit) if isinstance(objective, SupportsUnit) else ""


def wanted_by(evolver: Evolver) -> tuple[str, ...]:
    """Return the names of the measures that an evolver uses besides the fitness."""
    return tuple(evolver.wants) if isinstance(evolver, SupportsWants) else ()


def array_types_of(encoder: Encoder) -> Mapping[str, ArrayType]:
    """Return types and shapes of the arrays that an encoder declares: role -> type; empty if none."""
    return encoder.array_types if isinstance(encoder, SupportsArrayTypes) else {}


def measures_of_designs(encoder: Encoder) -> tuple[str, ...]:
    """Return the names of the measures that an encoder supplies."""
    return encoder.measures if isinstance(encoder, SupportsDesignMeasures) else ()


def measures_of_simulations(simulator: Simulator, objective: Objective) -> tuple[str, ...]:
    """Return the names of the measures that a simulator and an objective supply."""
    by_simulator = simulator.measures if isinstance(simulator, SupportsMeasures) else ()
    by_objective = objective.measures if isinstance(objective, SupportsOutcomeMeasures) else ()
    return (*by_simulator, *by_objective)


def batch_size_of(simulator: Simulator, otherwise: int) -> int:
    """Return the number of designs that a simulator should receive at once."""
    return simulator.batch_size if isinstance(simulator, SupportsBatches) else otherwise


def bit_generation_of(component: Any) -> int:
    """Return the generation of a component's results; 1 if it states none."""
    return component.bit_generation if isinstance(component, SupportsBitGeneration) else 1
