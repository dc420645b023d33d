import math
import re
from typing import Any

import numpy as np
import pytest

from evoframe import ConfigurationError, Member
from evoframe.testing import CollaborationStrategyContract
from evoframe_strategies import BestAndWorst, Fittest, Random, Worst, evoframe_strategies

STRATEGIES = [Fittest(), Worst(), BestAndWorst(), Random()]


class TestFittest(CollaborationStrategyContract):
    component = Fittest()


class TestTenFittest(CollaborationStrategyContract):
    component = Fittest(n=10)


class TestWorst(CollaborationStrategyContract):
    component = Worst(n=3)


class TestBestAndWorst(CollaborationStrategyContract):
    component = BestAndWorst()


class TestFiveBestAndFiveWorst(CollaborationStrategyContract):
    component = BestAndWorst(n=5)


class TestRandom(CollaborationStrategyContract):
    component = Random()


class TestFiveAtRandom(CollaborationStrategyContract):
    component = Random(n=5)


def population(*fitness: float | None, diverged: tuple[int, ...] = ()) -> list[Member]:
    return [Member(id=100 - i, fitness=f, diverged=i in diverged) for i, f in enumerate(fitness)]


def chosen(strategy: Any, members: list[Member], seed: int = 0) -> list[int]:
    indices: list[int] = strategy.select(members, np.random.default_rng(seed)).tolist()
    return indices


def test_the_names_are_those_of_the_configuration() -> None:
    assert dict(evoframe_strategies()) == {
        "fittest": Fittest,
        "worst": Worst,
        "best-and-worst": BestAndWorst,
        "random": Random,
    }


@pytest.mark.parametrize(
    ("strategy", "expected"),
    [
        (Fittest(n=3), [4, 0, 2]),
        (Worst(n=3), [3, 1, 0]),
        (BestAndWorst(n=2), [4, 0, 3, 1]),
        (BestAndWorst(n=3), [4, 0, 2, 3, 1, 5]),
    ],
)
def test_members_are_chosen_by_fitness_and_ties_by_index(strategy: Any, expected: list[int]) -> None:
    assert chosen(strategy, population(0.5, -0.1, 0.5, -0.2, 0.9, 0.5)) == expected


@pytest.mark.parametrize(
    ("strategy", "expected"),
    [
        (Fittest(n=2), [1, 3]),
        (Fittest(n=3), [1, 3, 0]),
        (Fittest(n=4), [1, 3, 0, 2]),
        (Worst(n=2), [3, 1]),
        (Worst(n=3), [3, 1, 2]),
        (BestAndWorst(n=1), [1, 3]),
        (BestAndWorst(n=2), [1, 3, 2, 0]),
    ],
)
def test_diverged_members_are_a_last_resort(strategy: Any, expected: list[int]) -> None:
    assert chosen(strategy, population(0.9, 0.6, -0.9, 0.5, diverged=(0, 2))) == expected


def test_random_draws_everyone_equally_often() -> None:
    members = population(*range(10))
    counts = np.zeros(10)
    rng = np.random.default_rng(1)
    for _ in range(2000):
        counts[Random(n=3).select(members, rng)] += 1
    # 600 expected each; the bound is five standard deviations of a binomial of 2000 draws with p = 0.3.
    assert (abs(counts - 600) < 5 * math.sqrt(2000 * 0.3 * 0.7)).all()


def test_random_keeps_the_order_in_which_it_draws() -> None:
    assert any(chosen(Random(n=3), population(*range(10)), seed) != sorted(range(3)) for seed in range(5))
    orders = [chosen(Random(n=5), population(*range(10)), seed) for seed in range(20)]
    assert any(order != sorted(order) for order in orders)


def test_random_draws_diverged_members_after_the_clean_ones() -> None:
    members = population(*range(6), diverged=(0, 2, 3, 5))
    for seed in range(20):
        drawn = chosen(Random(n=4), members, seed)
        assert set(drawn[:2]) == {1, 4}
        assert set(drawn[2:]) < {0, 2, 3, 5}


def test_random_needs_no_fitness() -> None:
    assert len(chosen(Random(), population(None, None, None))) == 2


@pytest.mark.parametrize("strategy", [Fittest(), Worst(), BestAndWorst(n=1)])
def test_a_ranking_needs_fitness(strategy: Any) -> None:
    with pytest.raises(ValueError, match=r"member 99: .*no fitness"):
        chosen(strategy, population(0.5, None, 0.4))
    with pytest.raises(ValueError, match=r"member 98: .*NaN"):
        chosen(strategy, population(0.5, 0.4, math.nan))


@pytest.mark.parametrize("class_", [Fittest, Worst, Random])
def test_a_population_too_small_is_refused_with_both_numbers(class_: type[Any]) -> None:
    assert class_(n=25).size(25) == 25
    with pytest.raises(ConfigurationError) as refused:
        class_(n=30).size(25)
    assert re.findall(r"\d+ \w+", refused.value.problem)[:2] == ["30 collaborators", "25 members"]
    assert "collaboration.n to 25 " in refused.value.problem


def test_best_and_worst_takes_twice_n() -> None:
    assert BestAndWorst(n=12).size(25) == 24
    with pytest.raises(ConfigurationError) as refused:
        BestAndWorst(n=13).size(25)
    assert "2 x 13 collaborators" in refused.value.problem
    assert "25 members" in refused.value.problem
    assert "collaboration.n to 12 " in refused.value.problem


@pytest.mark.parametrize("strategy", STRATEGIES)
def test_an_empty_population_is_refused_without_a_suggestion(strategy: Any) -> None:
    with pytest.raises(ConfigurationError, match=r"0 members$"):
        chosen(strategy, [])


@pytest.mark.parametrize("class_", [Fittest, Worst, BestAndWorst, Random])
@pytest.mark.parametrize("n", [0, -1])
def test_n_is_at_least_one(class_: type[Any], n: int) -> None:
    with pytest.raises(ValueError, match=f"'n' must be >= 1: {n}"):
        class_(n=n)
