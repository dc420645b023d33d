"""Options that evolvers of networks share, and how their values are checked."""

from __future__ import annotations

import math
from importlib.metadata import version
from typing import Any

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
        raise ValueError(f"{attribute.name} must be a finite number, not {value}")


def _at_least_one(_instance: Any, attribute: attrs.Attribute[Any], names: tuple[str, ...]) -> None:
    if not names:
        raise ValueError(f"{attribute.name} must name at least one of {', '.join(ACTIVATIONS)}")


def probability(default: float) -> Any:
    """Return the field of an option that is a probability."""
    return attrs.field(default=default, validator=and_(ge(0.0), le(1.0)))


def at_least(least: int, default: int) -> Any:
    """Return the field of an option that counts something, *least* or more."""
    return attrs.field(default=default, validator=and_(instance_of(int), ge(least)))


@attrs.frozen(kw_only=True)
class GeneOptions:
    """How a number in a gene begins and mutates.

    In each mutation a number is changed with probability *mutate_rate*, else drawn anew with probability
    *replace_rate*, else left alone. The defaults are the authors' configuration.

    Attributes:
        init_mean: Mean of the normal distribution of new values.
        init_stdev: Its standard deviation.
        minimum: Values are clamped from below to this.
        maximum: Values are clamped from above to this.
        mutate_power: Standard deviation of the normal distribution that a change is drawn from.
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
            raise ValueError(f"minimum {self.minimum} is above maximum {self.maximum}")
        if self.mutate_rate + self.replace_rate > 1.0 + 1e-9:  # decimals such as 0.7 + 0.3 are rounded
            raise ValueError(
                f"mutate_rate {self.mutate_rate} and replace_rate {self.replace_rate} exceed 1 together, "
                "but a value is either changed or replaced"
            )


@attrs.frozen(kw_only=True)
class BiasOptions(GeneOptions):
    """How the bias of a node begins and mutates; see :class:`GeneOptions`."""


@attrs.frozen(kw_only=True)
class WeightOptions(GeneOptions):
    """How the weight of a connection begins and mutates; see :class:`GeneOptions`."""

    mutate_rate: float = probability(0.8)
    replace_rate: float = probability(0.1)


@attrs.frozen(kw_only=True)
class GenomeOptions:
    """How genomes begin and mutate, whatever selects them.

    A genome begins without hidden nodes, every input connected to every output, the activation of every node
    drawn from *activations*. Networks are feed-forward, inputs are summed, the response of a node is 1.

    Attributes:
        activations: Names of the activation functions of nodes (the paper's 23).
        activation_mutate_rate: Probability that a mutation draws a node's activation anew (paper).
        connection_add: Probability that a mutation adds a connection (paper).
        connection_delete: Probability that it deletes one (paper).
        node_add: Probability that it splits a connection by a node (paper).
        node_delete: Probability that it deletes a hidden node (paper).
        enabled_mutate_rate: Probability that it draws anew whether a connection is enabled (paper).
        bias: How biases begin and mutate (authors' configuration).
        weight: How weights begin and mutate (authors' configuration).
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

    def provenance(self) -> dict[str, str]:
        """Return the version of the library that breeds the genomes."""
        return {"neat-python": version("neat-python")}

    def graph(self, genome: Any, inputs: int, outputs: int) -> NetworkGraph:
        """Return what a figure draws of a *genome* that a run has dumped.

        Raises:
            ValueError: It is no such genome, or encodes no network with so many inputs and outputs.
        """
        return genome_graph(genome, inputs, outputs)
