"""Genomes of other runs, with which populations start."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from evoframe.contract import PopulationConfig, RunConfig
from evoframe.errors import ConfigurationError
from evoframe.evolution import assemble
from evoframe.record import Run, open_run
from evoframe.registry import Plugins
from evoframe.runs.restoring import configuration_of, restore

__all__ = ["starting_genomes"]


def starting_genomes(config: RunConfig, plugins: Plugins) -> dict[str, list[Any]]:
    """Return the genomes with which populations start: name -> genomes as JSON values, the fittest first.

    Raises:
        ConfigurationError: Another run has no such population, or its components are not installed.
        InputError: Another run cannot be read.
    """
    return {
        name: _genomes(name, population, plugins)
        for name, population in config.populations.items()
        if population.start.run
    }


def _genomes(name: str, population: PopulationConfig, plugins: Plugins) -> list[Any]:
    start = population.start
    wanted = start.population or name
    with open_run(Path(start.run)) as run:
        if wanted not in run.config["populations"]:
            known = ", ".join(run.config["populations"])
            raise ConfigurationError(
                f"the run {start.run} has no population '{wanted}'; its populations: {known}",
                key=f"populations.{name}.start.population",
            )
        if start.take == "champion":
            return [run.champion().genomes[wanted]]
        return _members(run, wanted, plugins)[: population.size]


def _members(run: Run, wanted: str, plugins: Plugins) -> list[Any]:
    """Return the genomes of a population at the end of a run, the fittest first."""
    config = configuration_of(run, (), plugins)
    with assemble(config) as coevolution:
        restore(coevolution, run, config)
        [found] = [population for population in coevolution.populations if population.name == wanted]
        return [found.dump(position) for position in found.ranked()]
