"""Results of textbooks on cooperative coevolution, with the preset ``functions``.

Each test states a direction, and compares 30 runs of either side by a one-sided Mann-Whitney test.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.stats import mannwhitneyu

import evoframe
from evoframe import Coevolution, RunConfig

RUNS = 30
SIGNIFICANT = 0.01

# With the published width of the narrow peak (a spread of 1/32), runs end on the broad one with any credit.
WIDER_MTQ = """simulator.mtq.peaks = [
    {height = 50.0, place = [0.75, 0.75], spread = 1.6},
    {height = 150.0, place = [0.25, 0.25], spread = 0.3},
]"""


def configured(seed: int, *settings: str) -> RunConfig:
    """Return the preset with other settings."""
    overrides = [f"run.seed={seed}", "populations.x.size=20", "populations.y.size=20", *settings]
    return evoframe.load_config("functions", overrides=overrides)


def finished(config: RunConfig) -> Coevolution:
    """Return the loop of a configuration after its last turn."""
    with evoframe.assemble(config) as loop:
        for _ in loop:
            pass
        return loop


def genes(loop: Coevolution, population: int) -> NDArray[np.float64]:
    """Return the genes of all members of a population, ``[members, 1]``."""
    chosen = loop.populations[population]
    return np.array([chosen.network(i)(np.empty((1, 0)))[0] for i in range(len(chosen.genomes))])


def distance(place: Sequence[float], loop: Coevolution) -> float:
    """Return the distance of the final pair of the fittest from a *place*."""
    fittest = [genes(loop, i)[population.fittest(), 0] for i, population in enumerate(loop.populations)]
    return math.dist(place, fittest)


def samples(measure: Callable[[Coevolution], float], *settings: str) -> list[float]:
    """Return a measure of the final state of each of the runs."""
    return [measure(finished(configured(seed, *settings))) for seed in range(RUNS)]


def p_value(smaller: Sequence[float], larger: Sequence[float]) -> float:
    """Return the p-value against the hypothesis that *smaller* is not smaller than *larger*."""
    return float(mannwhitneyu(smaller, larger, alternative="less").pvalue)


@pytest.mark.parametrize(
    ("function", "optimum"),
    [
        ("simulator.function=one-ridge", (1.0, 1.0)),
        (WIDER_MTQ, (0.25, 0.25)),
    ],
    ids=["one-ridge", "mtq"],
)
def test_optimistic_credit_comes_closer_to_the_optimum_than_the_mean(
    function: str, optimum: Sequence[float]
) -> None:
    """Panait, Luke and Wiegand 2006: averaging scores leads to robust pairs instead of the best ones."""
    settings = function, "run.generations=10", "collaboration=random", "collaboration.n=10"
    measure = functools.partial(distance, optimum)
    optimistic, mean = (samples(measure, *settings, f"aggregator={name}") for name in ("max", "am"))
    assert p_value(optimistic, mean) < SIGNIFICANT


SEPARABLE = "simulator.function=rastrigin", "simulator.rastrigin.amplitude=0.0", "collaboration=fittest"


def test_on_a_separable_function_one_best_collaborator_is_better_at_equal_cost() -> None:
    """Wiegand, Liles and De Jong 2001: without interaction, more collaborators only cost evaluations."""
    budgets = [(1, 20), (5, 4)]  # collaborators, generations
    one, five = (
        samples(
            lambda loop: -(loop.fittest_pair().score or 0.0),
            *SEPARABLE,
            f"collaboration.n={n}",
            f"run.generations={generations}",
        )
        for n, generations in budgets
    )
    assert p_value(one, five) < SIGNIFICANT


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize(("function", "same"), [("rastrigin", True), ("rosenbrock", False)])
def test_only_on_a_separable_function_more_collaborators_change_nothing(
    seed: int, function: str, same: bool
) -> None:
    """The scores of all individuals change by the same amount, and selection depends on ranks."""
    settings = f"simulator.function={function}", "run.generations=10"
    one, five = (finished(configured(seed, *settings, f"collaboration.n={n}")) for n in (1, 5))
    for population in range(2):
        assert np.array_equal(genes(one, population), genes(five, population)) == same


def test_the_preset_takes_as_many_turns_as_configured(tmp_path: Any) -> None:
    run = evoframe.run("functions", out=tmp_path / "run", run={"generations": 3})
    assert len(run.turns()) in (7, 8)  # the last one is that of the final pair, if it was not simulated
    champion = run.champion()
    assert champion.score == max(row["score"] for row in run.pairs())
    x, y = (champion.design.roles[role][0] for role in ("x", "y"))
    config = evoframe.load_config("functions")
    simulator: Any = config.simulator.component
    assert simulator.value(champion.design) == champion.score
    assert 0.0 <= min(x, y) <= max(x, y) <= 1.0
