"""Evolvers of networks: NEAT on neat-python, and random search to compare it with.

:mod:`.cppn` has the genomes and what all evolvers of them share, :mod:`.crowding` the reproduction of NEAT.
"""

from __future__ import annotations

from collections.abc import Mapping

from evoframe import Evolver, hookimpl
from evoframe_evolvers.cppn import BiasOptions, WeightOptions
from evoframe_evolvers.neat_evolver import Neat
from evoframe_evolvers.random_search import RandomSearch

__all__ = ["BiasOptions", "Neat", "RandomSearch", "WeightOptions", "evoframe_evolvers"]


@hookimpl
def evoframe_evolvers() -> Mapping[str, type[Evolver]]:
    """Offer the evolvers ``neat`` and ``random``."""
    return {"neat": Neat, "random": RandomSearch}
