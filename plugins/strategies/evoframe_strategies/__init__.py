"""Collaboration strategies, which choose the members of another population that individuals meet.

A member with a diverged simulation is chosen only if no other member is left. :mod:`.fittest` chooses by
fitness, :mod:`.chance` at random, and :mod:`.pairings` for each individual; :mod:`.archives` and
:mod:`.informative` remember earlier turns; :mod:`.schedules` and :mod:`.sums` combine other strategies.
"""

from __future__ import annotations

from collections.abc import Mapping

from evoframe import CollaborationStrategy, hookimpl
from evoframe_strategies.archives import HallOfFame, Previous
from evoframe_strategies.chance import BestAndRandom, Random, Rank, Roulette, Tournament
from evoframe_strategies.fittest import All, BestAndWorst, Fittest, SpeciesChampions, Worst
from evoframe_strategies.informative import Informative
from evoframe_strategies.pairings import Neighbourhood, Shuffled
from evoframe_strategies.schedules import Scheduled
from evoframe_strategies.sums import Sum

__all__ = [
    "All",
    "BestAndRandom",
    "BestAndWorst",
    "Fittest",
    "HallOfFame",
    "Informative",
    "Neighbourhood",
    "Previous",
    "Random",
    "Rank",
    "Roulette",
    "Scheduled",
    "Shuffled",
    "SpeciesChampions",
    "Sum",
    "Tournament",
    "Worst",
    "evoframe_strategies",
]


@hookimpl
def evoframe_strategies() -> Mapping[str, type[CollaborationStrategy]]:
    """Register the strategies of the paper's authors, and those of the literature."""
    return {
        "all": All,
        "best-and-random": BestAndRandom,
        "best-and-worst": BestAndWorst,
        "fittest": Fittest,
        "hall-of-fame": HallOfFame,
        "informative": Informative,
        "neighbourhood": Neighbourhood,
        "previous": Previous,
        "random": Random,
        "rank": Rank,
        "roulette": Roulette,
        "scheduled": Scheduled,
        "shuffled": Shuffled,
        "species-champions": SpeciesChampions,
        "sum": Sum,
        "tournament": Tournament,
        "worst": Worst,
    }
