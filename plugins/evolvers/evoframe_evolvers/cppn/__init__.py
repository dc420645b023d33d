"""Genomes that encode CPPNs, whatever evolves them.

From the bottom up: :mod:`.documents` reads and writes genomes as JSON values and expresses them as networks,
:mod:`.graphs` draws them, :mod:`.options` has the options that evolvers share, :mod:`.randomness` gives each
population a random stream of its own, :mod:`.genomes` is the pool that genomes come from, :mod:`.cohort` the
present generation, and :mod:`.network_run` has all of an evolver but its selection.
"""

from evoframe_evolvers.cppn.cohort import Cohort, SavedCohort
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
    "Cohort",
    "Counter",
    "GeneOptions",
    "GenePool",
    "GenomeOptions",
    "NetworkRun",
    "SavedCohort",
    "SavedPool",
    "Sections",
    "WeightOptions",
    "at_least",
    "finite",
    "probability",
]
