"""Strategies and credits by name: no two of them are the same in a run."""

from __future__ import annotations

import itertools
from collections.abc import Mapping, Sequence

import pytest

import evoframe
from evoframe import Turn

PLUGINS = evoframe.discover()

SMALL = ("populations.x.size=10", "populations.y.size=10", "run.generations=6")
# Two populations with several species each, since without species their champions are the fittest.
SPECIES = (
    "run.generations=4",
    "aggregator=am",
    "populations.morphology.evolver.compatibility_threshold=1.0",
    "populations.controller.evolver.compatibility_threshold=1.0",
)

Result = Sequence[object]
"""What a run shows of a component, turn by turn."""


def names(kind: str) -> list[str]:
    """Return the names of the components that evoframe itself offers."""
    offers = (offer for offer in PLUGINS.offers if offer.source.distribution == "evoframe")
    return [offer.name for offer in offers if offer.kind == kind]


def played(preset: str, *settings: str) -> list[Turn]:
    """Run a preset; runs with the same seed and preset have the same initial populations."""
    config = evoframe.load_config(preset, overrides=settings, plugins=PLUGINS)
    with evoframe.assemble(config) as loop:
        return list(loop)


def meetings(strategy: str) -> Result:
    """Return who meets whom with a strategy in two runs, one of them with species."""
    chosen = f"collaboration={strategy}"
    plain, with_species = played("functions", *SMALL, chosen), played("quick", *SPECIES, chosen)
    assert all(len({member.species for member in r.members}) > 2 for r in with_species[0].reports)
    return [{pair.genomes for pair in turn.pairs} for turn in (*plain, *with_species)]


def fitness(credit: str) -> Result:
    """Return the fitness of all members with a credit of three scores: of two, the median is the mean."""
    turns = played("functions", *SMALL, "collaboration.n=3", f"aggregator={credit}")
    return [[member.fitness for report in turn.reports for member in report.members] for turn in turns]


def equal_names(results: Mapping[str, Result]) -> list[tuple[str, str]]:
    """Return all pairs of names with the same result."""
    return [
        (one, other) for one, other in itertools.combinations(results, 2) if results[one] == results[other]
    ]


def test_no_two_strategies_let_the_same_individuals_meet() -> None:
    results = {name: meetings(f'{{name="{name}"}}') for name in names("strategy")}
    assert len(results) >= 17
    assert equal_names(results) == []


def test_no_two_credits_give_the_same_fitness() -> None:
    results = {name: fitness(f'{{name="{name}"}}') for name in names("aggregator")}
    assert len(results) >= 15
    assert equal_names(results) == []


@pytest.mark.parametrize(
    "same",
    [
        '{name="sum", parts=[{name="fittest", n=2}]}',
        '{name="scheduled", strategy="fittest", n=[2], since=[0]}',
    ],
)
def test_the_same_strategy_in_another_form_is_recognized(same: str) -> None:
    assert equal_names({"fittest": meetings("fittest"), same: meetings(same)}) == [("fittest", same)]


def test_the_same_credit_in_another_form_is_recognized() -> None:
    same = '{name="quantile", q=0.5}'
    assert equal_names({"median": fitness("median"), same: fitness(same)}) == [("median", same)]
