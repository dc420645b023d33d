"""Assembly of the loop from the components of a configuration."""

from __future__ import annotations

from evoframe.contract import RunConfig
from evoframe.evolution.coevolution import Coevolution
from evoframe.evolution.evaluation import Evaluator
from evoframe.evolution.population import Population
from evoframe.evolution.randomness import stream

__all__ = ["assemble", "evaluator_of"]


def assemble(config: RunConfig) -> Coevolution:
    """Return the loop that a configuration describes, ready for the first turn."""
    populations = tuple(
        Population(
            name=role,
            encoder=chosen.encoder.component,
            evolver=chosen.evolver.component.start(
                chosen.encoder.component.inputs,
                chosen.encoder.component.outputs,
                chosen.size,
                stream(config.run.seed, f"population/{role}"),
            ),
            rng=stream(config.run.seed, f"collaboration/{role}"),
        )
        for role, chosen in config.populations.items()
    )
    return Coevolution(
        populations=populations,
        strategy=config.collaboration.component,
        aggregator=config.aggregator.component,
        evaluator=evaluator_of(config),
        generations=config.run.generations,
    )


def evaluator_of(config: RunConfig) -> Evaluator:
    """Return the evaluator that a configuration describes, with its workers started."""
    return Evaluator(
        config.simulator.component, config.objective.component, config.executor.component.start()
    )
