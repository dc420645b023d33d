"""Genomes that encode CPPNs, independent of the evolver.

From the bottom up: :mod:`.documents` reads and writes genomes as JSON values and expresses them as networks,
:mod:`.graphs` converts them to graphs for figures, :mod:`.options` defines the options that evolvers share,
:mod:`.randomness` gives each population its own random stream, :mod:`.genomes` is the pool that creates
genomes, and :mod:`.network_run` the base class of evolutions.
"""

from evoframe_evolvers.cppn.genomes import NO_SELECTION, Counter, GenePool, SavedPool, Sections
from evoframe_evolvers.cppn.network_run import NetworkRun
from evoframe_evolvers.cppn.options import (
    BiasOptions,
    GeneOptions,
    GenomeOptions,
    WeightOptions,
    at_least,
    finite,
    probability,
)

__all__ = [
    "NO_SELECTION",
    "BiasOptions",
    "Counter",
    "GeneOptions",
    "GenePool",
    "GenomeOptions",
    "NetworkRun",
    "SavedPool",
    "Sections",
    "WeightOptions",
    "at_least",
    "finite",
    "probability",
]
