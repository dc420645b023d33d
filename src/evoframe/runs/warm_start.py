"""Genomes of other runs, with which populations start."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from evoframe.contract import PopulationConfig, RunConfig
from evoframe.errors import ConfigurationError, EvoframeError
from evoframe.evolution import population_of
from evoframe.record import Run, open_run
from evoframe.registry import Plugins
from evoframe.runs.restoring import configuration_of

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
    key = f"populations.{name}.start"
    try:
        with open_run(Path(population.start.run)) as run:
            return _genomes_of(run, population.start.population or name, population, plugins)
    except ConfigurationError as error:
        raise ConfigurationError(error.problem, source=error.source, key=error.key or key) from error
    except EvoframeError as error:
        problem = f"the run cannot be used: {error}; choose another"
        raise ConfigurationError(problem, key=f"{key}.run") from error


def _genomes_of(run: Run, wanted: str, population: PopulationConfig, plugins: Plugins) -> list[Any]:
    """Return the genomes of one population of a run.

    Raises:
        ConfigurationError: It has no such population, or no turn.
        InputError: It is damaged.
    """
    if wanted not in run.config["populations"]:
        known = ", ".join(run.config["populations"])
        raise ConfigurationError(
            f"the run {run.directory} has no population '{wanted}'; its populations: {known}"
        )
    if run.last_turn() is None or (population.start.take == "champion" and run.champion_document() is None):
        raise ConfigurationError(f"the run {run.directory} has no individuals yet; resume it first")
    if population.start.take == "champion":
        return [run.champion().genomes[wanted]]
    found = population_of(configuration_of(run, (), plugins), wanted)
    found.restore(run.state()[f"population/{wanted}"])
    return [found.dump(position) for position in found.ranked()[: population.size]]
