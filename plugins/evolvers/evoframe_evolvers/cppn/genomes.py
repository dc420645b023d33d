"""neat-python's genomes: their configuration from typed options, and the state that a population shares."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from configparser import ConfigParser
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, NoReturn, TypeAlias

import attrs
import neat
import numpy as np
from attrs.validators import ge
from neat.innovation import InnovationTracker

from evoframe import ConfigurationError
from evoframe_evolvers.cppn.documents import dump_genome, express, load_genome
from evoframe_evolvers.cppn.options import GeneOptions, GenomeOptions
from evoframe_evolvers.cppn.randomness import PrivateStream
from evoframe_libcppn import CppnNetwork

__all__ = ["NO_SELECTION", "Counter", "GenePool", "SavedPool", "Sections", "neat_sections"]


@attrs.define
class Counter:
    """Counter like :func:`itertools.count` whose value can be read and set."""

    value: int

    def __iter__(self) -> Counter:
        return self

    def __next__(self) -> int:
        self.value += 1
        return self.value - 1


Sections: TypeAlias = Mapping[str, Mapping[str, Any]]
"""Section of neat-python's configuration -> key -> value."""

NO_SELECTION: Sections = {
    "DefaultGenome": {
        "compatibility_disjoint_coefficient": 0.0,
        "compatibility_weight_coefficient": 0.0,
    },
    "DefaultSpeciesSet": {"compatibility_threshold": 0.0},
    "DefaultStagnation": {},
    "DefaultReproduction": {},
}
"""Settings of selection that neat-python requires even if it does not select."""


@attrs.frozen
class SavedPool:
    """The document that :meth:`GenePool.state` returns."""

    inputs: int
    outputs: int
    next_genome: int
    next_node: int
    innovation: int = attrs.field(validator=ge(0))
    innovations: tuple[tuple[int, int, str, int], ...]
    random: Any


class GenePool:
    """Source of the genomes of one population.

    It owns neat-python's ``Config`` of the population, the counters that neat-python's objects use, and the
    random stream. Serializing or copying the config would advance its node counter, so save :meth:`state`
    instead.

    Attributes:
        inputs: Number of inputs of a network.
        outputs: Number of outputs of a network.
        config: neat-python's configuration of this population.
        genome_ids: Counter of genome ids.
        node_ids: Counter of hidden node ids; neat-python starts them after the outputs.
        tracker: Innovation numbers of connections.
        stream: The random stream.
    """

    def __init__(
        self,
        options: GenomeOptions,
        selection: Sections,
        inputs: int,
        outputs: int,
        rng: np.random.Generator,
    ) -> None:
        if inputs < 1:
            raise ConfigurationError(
                f"expected networks with at least 1 input, found {inputs}; use the evolver genetic for "
                "encoders without inputs"
            )
        self.inputs = inputs
        self.outputs = outputs
        self.config = _neat_config(neat_sections(options, selection, inputs, outputs))
        self.genome_ids = Counter(1)
        self.node_ids = Counter(outputs)
        self.tracker = InnovationTracker()
        self.stream = PrivateStream(rng)
        self.config.genome_config.node_indexer = self.node_ids
        self.config.genome_config.innovation_tracker = self.tracker

    def __reduce__(self) -> NoReturn:
        raise TypeError("a population cannot be copied or serialized; use state() and restore()")

    def express(self, genome: Any) -> CppnNetwork:
        """Return the network that *genome* encodes."""
        return express(genome, self.inputs, self.outputs)

    def load(self, saved: Any, path: tuple[str, ...]) -> Any:
        """Return the genome from which :func:`dump_genome` created *saved*.

        Args:
            saved: The genome as JSON values.
            path: The keys that lead to it, for messages.

        Raises:
            ValueError: *saved* is not a genome, or does not fit this population.
        """
        genome = load_genome(saved, path)
        self.express(genome)
        return genome

    def adopt(self, genomes: Collection[Any]) -> list[Any]:
        """Return copies of *genomes*, possibly from other runs, from which this population starts.

        They get the ids from 1 on. Later nodes and connections get numbers that none of them has. In
        different runs, a number can stand for different connections; all but the first are renumbered.
        """
        self.genome_ids.value = 1
        copies = [self._copied(genome) for genome in genomes]
        nodes = [key for genome in copies for key in genome.nodes]
        self.node_ids.value = max([self.outputs - 1, *nodes]) + 1
        self.tracker.reset_generation()
        self.tracker.global_counter = _separated(copies)
        return copies

    def mutant(self, genome: Any, times: int) -> Any:
        """Return a mutated copy of *genome*; call it within ``stream.swapped_in()``."""
        copied = self._copied(genome)
        for _ in range(times):
            copied.mutate(self.config.genome_config)
        return copied

    def _copied(self, genome: Any) -> Any:
        return load_genome({**dump_genome(genome), "id": next(self.genome_ids)})

    def state(self) -> dict[str, Any]:
        """Return everything except the genomes as JSON values."""
        innovations = self.tracker.generation_innovations
        return {
            "inputs": self.inputs,
            "outputs": self.outputs,
            "next_genome": self.genome_ids.value,
            "next_node": self.node_ids.value,
            "innovation": self.tracker.global_counter,
            "innovations": [[*change, number] for change, number in innovations.items()],
            "random": self.stream.state(),
        }

    def restore(self, saved: SavedPool, genomes: Collection[Any]) -> None:
        """Continue from the result of :meth:`state`.

        Args:
            saved: The document.
            genomes: The genomes in use when *saved* was created; their ids must not be assigned again.

        Raises:
            ValueError: *saved* belongs to a different population, or contradicts the genomes; the pool is
                unchanged.
        """
        shape = saved.inputs, saved.outputs
        if shape != (self.inputs, self.outputs):
            raise ValueError(
                f"expected networks of {(self.inputs, self.outputs)} inputs and outputs, found {shape}"
            )
        _check_unused("next_genome", saved.next_genome, [genome.key for genome in genomes])
        nodes = [key for genome in genomes for key in genome.nodes]
        _check_unused("next_node", saved.next_node, [self.outputs - 1, *nodes])
        self.stream.restore(saved.random)
        self.genome_ids.value, self.node_ids.value = saved.next_genome, saved.next_node
        self.tracker.global_counter = saved.innovation
        self.tracker.generation_innovations = {
            (start, end, change): number for start, end, change, number in saved.innovations
        }


def _separated(genomes: Collection[Any]) -> int:
    """Give different connections different innovation numbers; return the largest one."""
    genes = [gene for genome in genomes for gene in genome.connections.values()]
    owners: dict[int, tuple[int, int]] = {}
    renumbered: dict[tuple[int, tuple[int, int]], int] = {}
    largest = max((gene.innovation for gene in genes), default=0)
    for gene in genes:
        if owners.setdefault(gene.innovation, gene.key) != gene.key:
            taken = gene.innovation, gene.key
            largest += taken not in renumbered
            gene.innovation = renumbered.setdefault(taken, largest)
    return largest


def _check_unused(key: str, value: int, used: Collection[int]) -> None:
    """Require that the next id is greater than all ids in use."""
    if value <= max(used):
        raise ValueError(f"state.pool.{key}: must be > {max(used)}, found {value}")


def _neat_config(sections: Sections) -> Any:
    """Return neat-python's configuration; it can only be read from an ini file."""
    parser = ConfigParser()
    parser.read_dict(sections)
    with TemporaryDirectory(prefix="evoframe-neat-") as folder:
        path = Path(folder, "neat.ini")
        with path.open("w", encoding="utf-8") as file:
            parser.write(file)
        return neat.Config(
            neat.DefaultGenome, neat.DefaultReproduction, neat.DefaultSpeciesSet, neat.DefaultStagnation, path
        )


def _number_keys(name: str, options: GeneOptions) -> Mapping[str, Any]:
    return {
        f"{name}_init_type": "gaussian",
        f"{name}_init_mean": options.init_mean,
        f"{name}_init_stdev": options.init_stdev,
        f"{name}_min_value": options.minimum,
        f"{name}_max_value": options.maximum,
        f"{name}_mutate_power": options.mutate_power,
        f"{name}_mutate_rate": options.mutate_rate,
        f"{name}_replace_rate": options.replace_rate,
    }


_ALWAYS_1 = GeneOptions(
    init_mean=1.0,
    init_stdev=0.0,
    minimum=1.0,
    maximum=1.0,
    mutate_power=0.0,
    mutate_rate=0.0,
    replace_rate=0.0,
)

_FIXED: Mapping[str, Any] = {
    "num_hidden": 0,
    "feed_forward": True,
    "initial_connection": "full_direct",
    "single_structural_mutation": False,
    "structural_mutation_surer": False,
    "activation_default": "random",
    "aggregation_default": "sum",
    "aggregation_options": "sum",
    "aggregation_mutate_rate": 0.0,
    "enabled_default": True,
    "enabled_rate_to_true_add": 0.0,
    "enabled_rate_to_false_add": 0.0,
    **_number_keys("response", _ALWAYS_1),
    **_number_keys("time_constant", _ALWAYS_1),
}


def neat_sections(options: GenomeOptions, selection: Sections, inputs: int, outputs: int) -> Sections:
    """Return the complete configuration for neat-python, which ignores unknown keys."""
    return {
        **selection,
        "NEAT": {
            "pop_size": 1,  # not used: the evolver passes the size with each call
            "fitness_criterion": "max",
            "fitness_threshold": 0.0,
            "no_fitness_termination": True,
            "reset_on_extinction": True,
        },
        "DefaultGenome": {
            **selection["DefaultGenome"],
            **_FIXED,
            "num_inputs": inputs,
            "num_outputs": outputs,
            "conn_add_prob": options.connection_add,
            "conn_delete_prob": options.connection_delete,
            "node_add_prob": options.node_add,
            "node_delete_prob": options.node_delete,
            "activation_options": " ".join(options.activations),
            "activation_mutate_rate": options.activation_mutate_rate,
            "enabled_mutate_rate": options.enabled_mutate_rate,
            **_number_keys("bias", options.bias),
            **_number_keys("weight", options.weight),
        },
    }
