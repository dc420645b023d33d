"""Assembly of the loop from the components of a configuration."""

from __future__ import annotations

import itertools
from collections.abc import Mapping, Sequence
from types import MappingProxyType
from typing import Any

from evoframe.contract import RunConfig, blaming, measures_of_simulations, wanted_by
from evoframe.evolution.coevolution import Coevolution
from evoframe.evolution.collaboration import Collaboration
from evoframe.evolution.credit import Judge
from evoframe.evolution.drafts import Drafts
from evoframe.evolution.evaluation import Evaluator
from evoframe.evolution.measures import Measures
from evoframe.evolution.population import Population
from evoframe.evolution.randomness import stream
from evoframe.evolution.roles import roles_of
from evoframe.evolution.timing import timing_of

__all__ = ["assemble", "evaluator_of", "population_of"]

_NO_GENOMES: Mapping[str, Sequence[Any]] = MappingProxyType({})


def assemble(config: RunConfig, genomes: Mapping[str, Sequence[Any]] = _NO_GENOMES) -> Coevolution:
    """Return the loop that a configuration describes, ready for the first turn.

    Args:
        config: The configuration.
        genomes: Genomes with which populations start, as JSON values: name of a population -> genomes. A loop
            whose state is restored needs none.

    Raises:
        ConfigurationError: A component cannot start, or an evolver cannot start with given genomes.
    """
    populations = tuple(population_of(config, name) for name in config.populations)
    drafts = _drafts(config)
    for population in itertools.chain(populations, *drafts.populations):
        if population.name in genomes:
            population.seed(genomes[population.name])
    return Coevolution(
        populations=populations,
        collaborations=tuple(_collaboration(config, own, populations) for own in populations),
        judges=tuple(_judge(config, name) for name in config.populations),
        evaluator=evaluator_of(config),
        timing=timing_of(config),
        measures=Measures(
            {
                f"populations.{name}.encoder": chosen.encoder.component
                for name, chosen in config.populations.items()
            }
        ),
        roles=roles_of(config, config.simulator.component),
        drafts=drafts,
    )


def _drafts(config: RunConfig) -> Drafts:
    """Return random initial populations, of which the fittest individuals are chosen."""
    draws = {name: population.start.draws for name, population in config.populations.items()}
    if max(draws.values()) == 1:
        return Drafts()
    drawn = (
        tuple(
            _population(config, name, _draw(name, min(number, own - 1), own)) for name, own in draws.items()
        )
        for number in range(max(draws.values()))
    )
    return Drafts(tuple(draws.values()), tuple(drawn))


def _draw(name: str, number: int, draws: int) -> str:
    """Return the name of the random stream of a draw; a single one is that of the run itself."""
    return f"population/{name}/draw/{number}" if draws > 1 else f"population/{name}"


def population_of(config: RunConfig, name: str) -> Population:
    """Return a population of a configuration alone, such as to restore its state."""
    return _population(config, name, f"population/{name}")


def _population(config: RunConfig, name: str, random: str) -> Population:
    """Return a population whose evolver uses the random stream called *random*."""
    chosen = config.populations[name]
    encoder, evolver = chosen.encoder.component, chosen.evolver.component
    with blaming(f"populations.{name}.evolver"):
        evolution = evolver.start(
            encoder.inputs, encoder.outputs, chosen.size, stream(config.run.seed, random)
        )
    return Population(
        name=name,
        encoder=encoder,
        evolver=evolution,
        rng=stream(config.run.seed, f"collaboration/{name}"),
        wants=wanted_by(evolver),
        source=chosen.start.run,
    )


def _collaboration(config: RunConfig, own: Population, populations: tuple[Population, ...]) -> Collaboration:
    key, chosen = config.chosen_for(own.name, "collaboration")
    return Collaboration(key, chosen.component, own, tuple(p for p in populations if p is not own))


def _judge(config: RunConfig, name: str) -> Judge:
    key, chosen = config.chosen_for(name, "aggregator")
    return Judge(key, chosen.component, 1.0 if config.populations[name].goal == "maximize" else -1.0)


def evaluator_of(config: RunConfig) -> Evaluator:
    """Return the evaluator that a configuration describes, with its workers started."""
    simulator, objective = config.simulator.component, config.objective.component
    wanted = {name for chosen in config.populations.values() for name in wanted_by(chosen.evolver.component)}
    measures = tuple(n for n in measures_of_simulations(simulator, objective) if n in wanted)
    with blaming("executor"):
        workers = config.executor.component.start()
    return Evaluator(simulator, objective, workers, measures)
