"""Assembly of the loop from the components of a configuration."""

from __future__ import annotations

from evoframe.contract import RunConfig, blaming, measures_of_simulations, wanted_by
from evoframe.evolution.coevolution import Coevolution
from evoframe.evolution.collaboration import Collaboration
from evoframe.evolution.credit import Judge
from evoframe.evolution.evaluation import Evaluator
from evoframe.evolution.measures import Measures
from evoframe.evolution.population import Population
from evoframe.evolution.randomness import stream
from evoframe.evolution.roles import roles_of
from evoframe.evolution.timing import timing_of

__all__ = ["assemble", "evaluator_of"]


def assemble(config: RunConfig) -> Coevolution:
    """Return the loop that a configuration describes, ready for the first turn."""
    populations = tuple(_population(config, name) for name in config.populations)
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
    )


def _population(config: RunConfig, name: str) -> Population:
    chosen = config.populations[name]
    encoder, evolver = chosen.encoder.component, chosen.evolver.component
    with blaming(f"populations.{name}.evolver"):
        evolution = evolver.start(
            encoder.inputs, encoder.outputs, chosen.size, stream(config.run.seed, f"population/{name}")
        )
    return Population(
        name=name,
        encoder=encoder,
        evolver=evolution,
        rng=stream(config.run.seed, f"collaboration/{name}"),
        wants=wanted_by(evolver),
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
