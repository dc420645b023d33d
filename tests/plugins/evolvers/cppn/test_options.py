from configparser import ConfigParser
from typing import Any

import numpy as np
import pytest

from evoframe import ConfigurationError
from evoframe_evolvers import Neat, RandomSearch
from evoframe_evolvers.cppn.genomes import NO_SELECTION, neat_sections
from evoframe_evolvers.cppn.options import BiasOptions, WeightOptions
from evoframe_evolvers.neat_evolver import _selection

# The paper's table (docs/experiment.md, "Genomes"), and the settings that neat-python needs to reproduce it.
PAPER = """
[NEAT]
pop_size = 1
fitness_criterion = max
fitness_threshold = 0.0
no_fitness_termination = True
reset_on_extinction = True

[DefaultGenome]
num_inputs = 3
num_outputs = 2
num_hidden = 0
feed_forward = True
initial_connection = full_direct
single_structural_mutation = False
structural_mutation_surer = False
conn_add_prob = 0.3
conn_delete_prob = 0.2
node_add_prob = 0.3
node_delete_prob = 0.2
enabled_default = True
enabled_mutate_rate = 0.5
enabled_rate_to_true_add = 0.0
enabled_rate_to_false_add = 0.0
activation_default = random
activation_mutate_rate = 0.4
activation_options = sigmoid tanh sin softplus gauss relu elu lelu selu identity clamped inv
    log exp abs hat square cube neg_abs neg_square sqrt_abs neg_sqrt_abs neg_sin
aggregation_default = sum
aggregation_mutate_rate = 0.0
aggregation_options = sum
bias_init_type = gaussian
bias_init_mean = 0.0
bias_init_stdev = 1.0
bias_min_value = -30.0
bias_max_value = 30.0
bias_mutate_power = 0.5
bias_mutate_rate = 0.3
bias_replace_rate = 0.3
weight_init_type = gaussian
weight_init_mean = 0.0
weight_init_stdev = 1.0
weight_min_value = -30.0
weight_max_value = 30.0
weight_mutate_power = 0.5
weight_mutate_rate = 0.8
weight_replace_rate = 0.1
response_init_type = gaussian
response_init_mean = 1.0
response_init_stdev = 0.0
response_min_value = 1.0
response_max_value = 1.0
response_mutate_power = 0.0
response_mutate_rate = 0.0
response_replace_rate = 0.0
time_constant_init_type = gaussian
time_constant_init_mean = 1.0
time_constant_init_stdev = 0.0
time_constant_min_value = 1.0
time_constant_max_value = 1.0
time_constant_mutate_power = 0.0
time_constant_mutate_rate = 0.0
time_constant_replace_rate = 0.0
compatibility_disjoint_coefficient = 1.0
compatibility_weight_coefficient = 0.5

[DefaultSpeciesSet]
compatibility_threshold = 3.0

[DefaultStagnation]
species_fitness_func = max
max_stagnation = 25
species_elitism = 2

[DefaultReproduction]
elitism = 2
survival_threshold = 0.6
min_species_size = 1
"""


def test_neat_python_is_configured_by_the_papers_table() -> None:
    paper = ConfigParser()
    paper.read_string(PAPER.replace("\n    ", " "))
    passed = ConfigParser()
    passed.read_dict(neat_sections(Neat(), _selection(Neat()), 3, 2))
    assert {name: dict(passed[name]) for name in passed} == {name: dict(paper[name]) for name in paper}


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"node_add": 1.1}, "node_add"),
        ({"node_delete": -0.1}, "node_delete"),
        ({"connection_add": float("nan")}, "connection_add"),
        ({"survival_threshold": 2.0}, "survival_threshold"),
        ({"compatibility_threshold": -1.0}, "compatibility_threshold"),
        ({"compatibility_weight": float("inf")}, "compatibility_weight"),
        ({"max_stagnation": 0}, "max_stagnation"),
        ({"elitism": -1}, "elitism"),
        ({"min_species_size": 0}, "min_species_size"),
        ({"species_fitness": "best"}, "species_fitness"),
        ({"activations": ()}, "'activations' .*sigmoid, tanh.*none$"),
        ({"activations": ("sin", "sinus", "xyz")}, "'sinus'.* 'sin'.*sigmoid, tanh"),
    ],
)
def test_a_bad_value_is_named(options: dict[str, Any], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        Neat(**options)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"init_stdev": -1.0}, "init_stdev"),
        ({"init_mean": float("inf")}, "'init_mean' .* inf"),
        ({"minimum": 2.0, "maximum": 1.0}, r"minimum = 2\.0 and maximum = 1\.0"),
        ({"mutate_rate": 0.8, "replace_rate": 0.3}, r"mutate_rate = 0\.8 and replace_rate = 0\.3"),
    ],
)
@pytest.mark.parametrize("genes", [BiasOptions, WeightOptions])
def test_a_bad_value_of_genes_is_named(genes: Any, options: dict[str, Any], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        genes(**options)


def test_an_integer_option_does_not_accept_a_fraction() -> None:
    with pytest.raises(TypeError, match="elitism"):
        Neat(elitism=1.5)  # type: ignore[arg-type]  # the mistake under test


@pytest.mark.parametrize(
    ("options", "size", "message"),
    [
        ({}, 0, "found 0"),
        ({}, 2, "elitism = 2 .* 2;"),
        ({"min_species_size": 5}, 4, "min_species_size = 5 .* 4;"),
    ],
)
def test_a_population_that_cannot_evolve_is_refused(options: dict[str, Any], size: int, message: str) -> None:
    with pytest.raises(ConfigurationError, match=message):
        Neat(**options).check(size)


def test_random_search_requires_a_member() -> None:
    RandomSearch().check(1)
    with pytest.raises(ConfigurationError, match="found 0"):
        RandomSearch().check(0)


@pytest.mark.parametrize("options", [Neat(), RandomSearch()])
def test_neat_python_receives_exactly_the_keys_that_it_knows(options: Any) -> None:
    """neat-python ignores unknown keys, and uses its own default for a missing one."""
    selection = _selection(options) if isinstance(options, Neat) else NO_SELECTION
    passed = neat_sections(options, selection, 3, 2)
    config = options.start(3, 2, 5, np.random.default_rng(0))._pool.config
    assert set(passed["DefaultGenome"]) == {parameter.name for parameter in config.genome_config._params}
    if isinstance(options, Neat):
        parts = {
            "DefaultSpeciesSet": config.species_set_config,
            "DefaultStagnation": config.stagnation_config,
            "DefaultReproduction": config.reproduction_config,
        }
        for section, part in parts.items():
            assert set(passed[section]) == {parameter.name for parameter in part._params}


def test_every_option_reaches_neat_python() -> None:
    changed = Neat(
        compatibility_threshold=2.5,
        compatibility_disjoint=0.75,
        compatibility_weight=0.25,
        max_stagnation=7,
        species_elitism=3,
        species_fitness="median",
        elitism=4,
        survival_threshold=0.35,
        min_species_size=2,
        activations=("tanh", "neg_sin"),
        activation_mutate_rate=0.11,
        connection_add=0.12,
        connection_delete=0.13,
        node_add=0.14,
        node_delete=0.15,
        enabled_mutate_rate=0.16,
        bias=BiasOptions(
            init_mean=0.1,
            init_stdev=0.2,
            minimum=-3,
            maximum=4,
            mutate_power=0.6,
            mutate_rate=0.17,
            replace_rate=0.18,
        ),
        weight=WeightOptions(
            init_mean=0.3,
            init_stdev=0.4,
            minimum=-5,
            maximum=6,
            mutate_power=0.7,
            mutate_rate=0.19,
            replace_rate=0.21,
        ),
    )
    config = changed.start(3, 2, 6, np.random.default_rng(0))._pool.config
    genome, reproduction = config.genome_config, config.reproduction_config
    assert config.species_set_config.compatibility_threshold == 2.5
    assert (genome.compatibility_disjoint_coefficient, genome.compatibility_weight_coefficient) == (
        0.75,
        0.25,
    )
    stagnation = config.stagnation_config
    assert (stagnation.max_stagnation, stagnation.species_elitism) == (7, 3)
    assert stagnation.species_fitness_func == "median"
    assert (reproduction.elitism, reproduction.survival_threshold, reproduction.min_species_size) == (
        4,
        0.35,
        2,
    )
    assert genome.activation_options == ["tanh", "neg_sin"]
    assert genome.activation_default == "random"
    assert (genome.activation_mutate_rate, genome.enabled_mutate_rate) == (0.11, 0.16)
    assert (genome.conn_add_prob, genome.conn_delete_prob) == (0.12, 0.13)
    assert (genome.node_add_prob, genome.node_delete_prob) == (0.14, 0.15)
    keys = [
        "init_mean",
        "init_stdev",
        "min_value",
        "max_value",
        "mutate_power",
        "mutate_rate",
        "replace_rate",
    ]
    assert [getattr(genome, f"bias_{key}") for key in keys] == [0.1, 0.2, -3, 4, 0.6, 0.17, 0.18]
    assert [getattr(genome, f"weight_{key}") for key in keys] == [0.3, 0.4, -5, 6, 0.7, 0.19, 0.21]
    assert [getattr(genome, f"response_{key}") for key in keys] == [1, 0, 1, 1, 0, 0, 0]
    assert (genome.num_hidden, genome.initial_connection, genome.feed_forward) == (0, "full_direct", True)
    assert config.no_fitness_termination is True
