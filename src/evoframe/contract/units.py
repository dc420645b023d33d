"""Units of what a run reports."""

from __future__ import annotations

from evoframe.contract.config import RunConfig
from evoframe.contract.optional import SupportsFitnessUnit, unit_of

__all__ = ["fitness_unit_of"]


def fitness_unit_of(config: RunConfig, population: str) -> str:
    """Return the unit of fitness in a population: that of scores, unless its credit states another."""
    _, chosen = config.chosen_for(population, "aggregator")
    if isinstance(chosen.component, SupportsFitnessUnit):
        return chosen.component.unit
    return unit_of(config.objective.component)
