"""Evolvers of networks (NEAT, based on neat-python, and random search as its baseline) and of vectors.

:mod:`.cohort` is the current generation of any evolver, :mod:`.cppn` contains the genomes of networks and
what their evolvers share, :mod:`.crowding` NEAT's reproduction.
"""

from __future__ import annotations

from collections.abc import Mapping

from evoframe import Evolver, hookimpl
from evoframe_evolvers.cppn import BiasOptions, WeightOptions
from evoframe_evolvers.genetic import Genetic
from evoframe_evolvers.neat_evolver import Neat
from evoframe_evolvers.random_search import RandomSearch

__all__ = ["BiasOptions", "Genetic", "Neat", "RandomSearch", "WeightOptions", "evoframe_evolvers"]


@hookimpl
def evoframe_evolvers() -> Mapping[str, type[Evolver]]:
    """Register the evolvers ``genetic``, ``neat`` and ``random``."""
    return {"genetic": Genetic, "neat": Neat, "random": RandomSearch}
