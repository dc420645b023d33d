"""The coevolution engine: populations, the loop, and the evaluation of designs; no input or output."""

from evoframe.evolution.assembly import assemble, evaluator_of, population_of
from evoframe.evolution.coevolution import Coevolution
from evoframe.evolution.evaluation import Evaluator, score_designs
from evoframe.evolution.meetings import first_meetings
from evoframe.evolution.population import Population
from evoframe.evolution.randomness import stream
from evoframe.evolution.timing import timing_of

__all__ = [
    "Coevolution",
    "Evaluator",
    "Population",
    "assemble",
    "evaluator_of",
    "first_meetings",
    "population_of",
    "score_designs",
    "stream",
    "timing_of",
]
