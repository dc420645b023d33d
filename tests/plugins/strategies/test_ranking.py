import math
import re
from typing import Any

import pytest
from collaborators import chosen, members_of, population
from hypothesis import given, strategies as st

from evoframe import ConfigurationError, Member
from evoframe_strategies import All, BestAndWorst, Fittest, Random, SpeciesChampions, Worst
from evoframe_strategies.ranking import best_first, clean_first, worst_first


@given(members_of())
def test_orders_of_clean_members_are_opposite_except_for_ties(members: list[Member]) -> None:
    best = [members[i].fitness for i in best_first(members) if not members[i].diverged]
    worst = [members[i].fitness for i in worst_first(members) if not members[i].diverged]
    assert best == worst[::-1] == sorted(best, key=float, reverse=True)  # type: ignore[arg-type]


@given(members_of(), st.data())
def test_diverged_members_are_taken_after_all_clean_ones(members: list[Member], data: st.DataObject) -> None:
    n = data.draw(st.integers(0, len(members)))
    taken = clean_first(members, range(len(members)), n, lambda pool, count: pool[:count])
    assert len(set(taken)) == n
    assert [members[i].diverged for i in taken] == sorted(members[i].diverged for i in taken)
    assert n == 0 or not members[taken[-1]].diverged or all(m.diverged for m in without(taken, members))


def without(taken: list[int], members: list[Member]) -> list[Member]:
    return [member for index, member in enumerate(members) if index not in taken]


@pytest.mark.parametrize("strategy", [Fittest(), Worst(), BestAndWorst(n=1), SpeciesChampions()])
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


@pytest.mark.parametrize("strategy", [Fittest(), Worst(), BestAndWorst(), Random(), All()])
def test_an_empty_population_is_refused_without_a_suggestion(strategy: Any) -> None:
    with pytest.raises(ConfigurationError, match=r"0 members$"):
        chosen(strategy, [])
