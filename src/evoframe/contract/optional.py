"""Optional capabilities of components, one protocol each.

A component offers a capability by having its members; nothing is registered. The core asks with
``isinstance``, which finds the members and does not look at their signatures: the contract tests of
:mod:`evoframe.testing` do.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, Protocol, runtime_checkable

import attrs
import numpy as np

from evoframe.contract.drawings import Geometry, NetworkGraph
from evoframe.contract.protocols import Aggregator, Encoder, Evolver, Objective, Simulator
from evoframe.contract.values import Design, Export, Record

__all__ = [
    "SupportsExemptions",
    "SupportsExport",
    "SupportsGeometry",
    "SupportsGraph",
    "SupportsInputNames",
    "SupportsOutputNames",
    "SupportsProvenance",
    "SupportsPublished",
    "SupportsRandomControllers",
    "SupportsReading",
    "SupportsSettings",
    "SupportsUnit",
    "SupportsVariants",
    "Variant",
    "unit_of",
]


@runtime_checkable
class SupportsProvenance(Protocol):
    """A component of any kind with something to add to the provenance of a run."""

    def provenance(self) -> Mapping[str, str]:
        """Return names and versions for the table ``[provenance.libraries]``, such as that of a library."""


@runtime_checkable
class SupportsExemptions(Aggregator, Protocol):
    """An aggregator that breaks a law of its protocol on purpose (``evoframe.testing``)."""

    @property
    def exempt_from(self) -> Mapping[str, str]:
        """Name of a law (``bounded``, ``idempotent``, ``monotone``) -> the reason; a class attribute."""


@runtime_checkable
class SupportsReading(Simulator, Protocol):
    """A simulator that reads designs from files (``evoframe simulate``, ``verify``, ``robustness``)."""

    def read(self, path: Path) -> Sequence[tuple[str, Design]]:
        """Return the designs of a file with their labels, at least one.

        Raises:
            InputError: The file cannot be read, or is of no known format; the message names it.
        """


@runtime_checkable
class SupportsSettings(Simulator, Protocol):
    """A simulator that knows files which bring settings with them."""

    def settings_of(self, path: Path) -> Mapping[str, Any] | None:
        """Return the options that a file brings, as TOML values; ``None`` if it brings none.

        Every option that matters is given, so that nothing of a preset lingers.

        Raises:
            InputError: The file cannot be read.
        """


@runtime_checkable
class SupportsExport(Simulator, Protocol):
    """A simulator that writes designs as files of other programs (``evoframe export``)."""

    @property
    def formats(self) -> tuple[str, ...]:
        """Formats, each named by the ending of its files."""

    def export(self, design: Design, format_: str) -> Export:
        """Return *design* with the simulator's settings in one of the formats; equal designs, equal bytes.

        Raises:
            ConfigurationError: The format cannot express the settings.
            InputError: The format cannot express the design.
        """


@attrs.frozen(eq=False)
class Variant:
    """A simulation of a design with one thing changed, which shows what its score rests on.

    Attributes:
        name: What was changed, as the table of ``evoframe verify`` shows it. Variants of one name are draws
            of one random change.
        simulator: Simulates it.
        design: What is simulated.
        record: What is recorded: as many samples of the same tracks as in the unchanged simulation, so that
            the same objective can score them.
    """

    name: str
    simulator: Simulator
    design: Design
    record: Record


@runtime_checkable
class SupportsVariants(Simulator, Protocol):
    """A simulator that offers variants of a simulation (``evoframe verify``)."""

    def variants(self, design: Design, record: Record) -> Sequence[Variant]:
        """Return simulations of *design* with one thing changed in each; equal arguments, equal variants."""


@runtime_checkable
class SupportsGeometry(Simulator, Protocol):
    """A simulator that describes the shape of its designs (figures and pages of reports)."""

    def geometry(self, design: Design, frames: int) -> Geometry:
        """Return a design at rest, and at *frames* - 1 later times at most.

        With more than one frame the design is simulated, from the start to the end or to the divergence.
        """


@runtime_checkable
class SupportsRandomControllers(Simulator, Protocol):
    """A simulator that draws random controllers (``evoframe robustness``)."""

    def random_controller(self, design: Design, rng: np.random.Generator) -> Design:
        """Return the same body with a controller drawn at random.

        The same state of *rng* gives bodies of the same shape the same controller, whatever they are made of.
        """


@runtime_checkable
class SupportsPublished(Simulator, Protocol):
    """A simulator that brings published bodies (``evoframe robustness --published``)."""

    def published(self) -> Sequence[tuple[str, Design]]:
        """Return the bodies with their labels."""


@runtime_checkable
class SupportsInputNames(Encoder, Protocol):
    """An encoder that names the inputs of its networks (figures of networks)."""

    @property
    def input_names(self) -> tuple[str, ...]:
        """One word for each input."""


@runtime_checkable
class SupportsOutputNames(Encoder, Protocol):
    """An encoder that names the outputs of its networks (figures of networks)."""

    @property
    def output_names(self) -> tuple[str, ...]:
        """One word for each output."""


@runtime_checkable
class SupportsGraph(Evolver, Protocol):
    """An evolver whose genomes can be drawn as graphs (figures of networks)."""

    def graph(self, genome: Any, inputs: int, outputs: int) -> NetworkGraph:
        """Return the graph of a genome whose network has so many *inputs* and *outputs*.

        Args:
            genome: As :meth:`~evoframe.EvolverRun.dump` gives it, perhaps from a file that somebody changed.
            inputs: Number of inputs of its network.
            outputs: Number of outputs of its network.

        Raises:
            ValueError: The genome is damaged; the message says how.
        """


@runtime_checkable
class SupportsUnit(Objective, Protocol):
    """An objective that states the unit of its scores."""

    @property
    def unit(self) -> str:
        """Such as ``m``."""


def unit_of(objective: Objective) -> str:
    """Return the unit of an objective's scores; empty if it states none."""
    return str(objective.unit) if isinstance(objective, SupportsUnit) else ""
