"""Options that evolvers of networks share, and their validation."""

from __future__ import annotations

import math
from importlib.metadata import version
from typing import Any, ClassVar

import attrs
from attrs.validators import and_, deep_iterable, ge, instance_of, le

from evoframe import NetworkGraph
from evoframe_evolvers.cppn.documents import known_activation
from evoframe_evolvers.cppn.graphs import genome_graph
from evoframe_libcppn import ACTIVATIONS

__all__ = [
    "BiasOptions",
    "GeneOptions",
    "GenomeOptions",
    "WeightOptions",
    "at_least",
    "finite",
    "probability",
]


def finite(_instance: Any, attribute: attrs.Attribute[float], value: float) -> None:
    """Validate that an option is neither infinite nor NaN."""
    if not math.isfinite(value):
        raise ValueError(f"'{attribute.name}' must be a finite number: {value}")


def _at_least_one(_instance: Any, attribute: attrs.Attribute[Any], names: tuple[str, ...]) -> None:
    if not names:
        raise ValueError(f"'{attribute.name}' must contain at least one of {', '.join(ACTIVATIONS)}: none")


def probability(default: float) -> Any:
    """Return the field of an option that is a probability."""
    return attrs.field(default=default, validator=and_(ge(0.0), le(1.0)))


def at_least(least: int, default: int) -> Any:
    """Return the field of an option that is a whole number of at least *least*."""
    return attrs.field(default=default, validator=and_(instance_of(int), ge(least)))


@attrs.frozen(kw_only=True)
class GeneOptions:
    """Initialization and mutation of a number in a gene.

    A mutation changes the number with probability *mutate_rate*, replaces it by a new value with probability
    *replace_rate*, and keeps it in all other cases. The defaults are the authors' configuration.

    Attributes:
        init_mean: Mean of the normal distribution of new values.
        init_stdev: Standard deviation of the normal distribution of new values.
        minimum: Lower bound, to which values are clamped.
        maximum: Upper bound, to which values are clamped.
        mutate_power: Standard deviation of the normal distribution of changes.
        mutate_rate: Probability of a change.
        replace_rate: Probability of a new value.
    """

    init_mean: float = attrs.field(default=0.0, validator=finite)
    init_stdev: float = attrs.field(default=1.0, validator=[finite, ge(0.0)])
    minimum: float = attrs.field(default=-30.0, validator=finite)
    maximum: float = attrs.field(default=30.0, validator=finite)
    mutate_power: float = attrs.field(default=0.5, validator=[finite, ge(0.0)])
    mutate_rate: float = probability(0.3)
    replace_rate: float = probability(0.3)

    def __attrs_post_init__(self) -> None:
        if self.minimum > self.maximum:
            raise ValueError(
                f"expected minimum <= maximum, found minimum = {self.minimum} and maximum = {self.maximum}"
            )
        if self.mutate_rate + self.replace_rate > 1.0 + 1e-9:  # decimals such as 0.7 + 0.3 are rounded
            raise ValueError(
                f"expected mutate_rate + replace_rate <= 1, found mutate_rate = {self.mutate_rate} and "
                f"replace_rate = {self.replace_rate}; a value is either changed or replaced"
            )


@attrs.frozen(kw_only=True)
class BiasOptions(GeneOptions):
    """Initialization and mutation of the bias of a node; see :class:`GeneOptions`."""


@attrs.frozen(kw_only=True)
class WeightOptions(GeneOptions):
    """Initialization and mutation of the weight of a connection; see :class:`GeneOptions`."""

    mutate_rate: float = probability(0.8)
    replace_rate: float = probability(0.1)


@attrs.frozen(kw_only=True)
class GenomeOptions:
    """Initialization and mutation of genomes, independent of selection.

    An initial genome has no hidden nodes; every input is connected to every output, and the activation of
    every node is drawn from *activations*. Networks are feed-forward; nodes sum their inputs and have the
    response 1.

    Attributes:
        activations: Names of the activation functions of nodes (the paper's 23).
        activation_mutate_rate: Probability that a mutation redraws the activation of a node (paper).
        connection_add: Probability that a mutation adds a connection (paper).
        connection_delete: Probability that a mutation deletes a connection (paper).
        node_add: Probability that a mutation splits a connection by a new node (paper).
        node_delete: Probability that a mutation deletes a hidden node (paper).
        enabled_mutate_rate: Probability that a mutation redraws whether a connection is enabled (paper).
        bias: Initialization and mutation of biases (authors' configuration).
        weight: Initialization and mutation of weights (authors' configuration).
    """

    activations: tuple[str, ...] = attrs.field(
        default=ACTIVATIONS, validator=[_at_least_one, deep_iterable(known_activation)]
    )
    activation_mutate_rate: float = probability(0.4)
    connection_add: float = probability(0.3)
    connection_delete: float = probability(0.2)
    node_add: float = probability(0.3)
    node_delete: float = probability(0.2)
    enabled_mutate_rate: float = probability(0.5)
    bias: BiasOptions = attrs.field(factory=BiasOptions, validator=instance_of(BiasOptions))
    weight: WeightOptions = attrs.field(factory=WeightOptions, validator=instance_of(WeightOptions))

    # Raise this number by hand with every change of a bit of a network's outputs (libcppn), or of the genomes
    # that follow from a seed and the fitness, and name the change in CHANGELOG.md under "Changed bits". Runs
    # without a number have generation 1.
    bit_generation: ClassVar[int] = 1

    def provenance(self) -> dict[str, str]:
        """Return the version of neat-python, which creates and mutates the genomes."""
        return {"neat-python": version("neat-python")}

    def graph(self, genome: Any, inputs: int, outputs: int) -> NetworkGraph:
        """Return the graph of a dumped *genome*, for figures.

        Raises:
            ValueError: *genome* is not a genome, or does not encode a network with *inputs* and *outputs*.
        """
        return genome_graph(genome, inputs, outputs)
